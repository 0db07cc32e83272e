"""The file check finds long sources and machine paths among the tracked files."""

import subprocess
from pathlib import Path

import check_files


def repository(root: Path, files: dict[str, str]) -> Path:
    subprocess.run(["git", "init", "-q", str(root)], check=True)
    for name, content in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content)
    subprocess.run(["git", "-C", str(root), "add", "-A"], check=True)
    return root


def test_long_sources_are_found_but_not_long_data(tmp_path: Path) -> None:
    long = "x\n" * (check_files.LONGEST + 1)
    root = repository(tmp_path, {"a.cpp": long, "b.h": long[2:], "tests/fixtures/c.py": long})
    (found,) = check_files.findings(root)
    assert found.startswith("a.cpp: 401 lines")


def test_machine_paths_are_found_with_their_line(tmp_path: Path) -> None:
    path = "/" + "home/somebody/mesh.obj"
    root = repository(tmp_path, {"a.md": f"see\n{path}\n", "b.md": "src/home/page is relative\n"})
    (found,) = check_files.findings(root)
    assert found.startswith("a.md:2: ")
    assert check_files.main([str(root)]) == 1


def test_untracked_files_do_not_count(tmp_path: Path) -> None:
    root = repository(tmp_path, {"a.md": "fine\n"})
    (root / "notes.md").write_text("/" + "root/secret\n")
    assert check_files.findings(root) == []
    assert check_files.main([str(root)]) == 0


def test_a_long_line_that_stands_twice_in_a_page_is_found(tmp_path: Path) -> None:
    line = "A sentence that says something that is so long that nobody writes it twice.\n"
    row = f"| {line.strip()} |\n"
    pages = {
        "a.md": f"{line}short\nshort\n{line}",
        "b.md": line,
        "c.md": row + row,
        "e.md": f"```sh\n{line}{line}```\n",
        "d.py": line * 2,
    }
    (found,) = check_files.findings(repository(tmp_path, pages))
    assert found == "a.md:4: the same as line 1"


def test_prose_over_a_hundred_characters_is_found_in_pages() -> None:
    wide = "word " * 21
    pages = ["fine", wide, f"| {wide} |", "```", wide, "```", f"# {wide}", f"![{wide}](a.png)"]
    assert check_files.wide_lines(pages) == [2]
