"""The code on the pages of the documentation runs."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import page_code
import pytest

ROOT = Path(__file__).resolve().parents[2]
PRINTED = {"verbs.md", "formats.md", "support.md"}
SLOW = {
    "docs/gallery/index.md",
    "docs/gallery/spot.md",
    "docs/guides/command_line.md",
    "docs/tutorials/9-ten-jobs.md",
}


def pages() -> list[object]:
    files = [page for page in sorted((ROOT / "docs").rglob("*.md")) if page.name not in PRINTED]
    names = [page.relative_to(ROOT).as_posix() for page in [ROOT / "README.md", *files]]
    assert set(names) >= SLOW
    return [pytest.param(name, marks=[pytest.mark.slow] if name in SLOW else []) for name in names]


@pytest.mark.parametrize("page", pages())
def test_the_code_of_a_page_runs(
    page: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("webbrowser.open", lambda address: True)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr(sys, "argv", ["page"])
    data = page_code.data_collection()
    page_code.run_page(ROOT / page, tmp_path, os.environ["LITTORAL"], data)


def test_blocks_are_found_with_their_language_and_reason() -> None:
    text = "a\n```sh\nls\n```\n<!-- not run: slow -->\n```python\nx\n```\n"
    text += "=== A\n\n    <!-- needs data -->\n    ```cpp\n    y\n    ```\n"
    assert page_code.blocks(text) == [
        page_code.Block("sh", "ls\n", 2, False),
        page_code.Block("python", "x\n", 6, True),
        page_code.Block("cpp", "y\n", 12, False, True),
    ]


def test_what_needs_data_waits_for_it(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    page = "# Page\n\n<!-- needs data -->\n```python\nopen('out/here', 'w').close()\n```\n"
    (tmp_path / "page.md").write_text(page + "<!-- needs data -->\n```sh\ntouch out/drawn\n```\n")
    (tmp_path / "data").mkdir()
    for folder, data, draw, left in (
        ("none", None, None, set()),
        ("some", tmp_path / "data", None, {"here"}),
        ("all", tmp_path / "data", tmp_path, {"here", "drawn"}),
    ):
        (tmp_path / folder).mkdir()
        monkeypatch.chdir(tmp_path / folder)
        program = os.environ["LITTORAL"]
        page_code.run_page(tmp_path / "page.md", tmp_path / folder, program, data, draw)
        assert {found.name for found in Path("out").iterdir()} == left


def test_pictures_are_those_of_commands(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "page.md").write_text(
        "```sh\nprintf command > out/a.png\n```\n"
        "```python\nopen('out/a.png', 'w').write('Python')\n```\n```sh\ntrue\n```\n"
    )
    for folder in ("run", "kept"):
        (tmp_path / folder).mkdir()
    (tmp_path / "kept" / "a.png").touch()
    monkeypatch.chdir(tmp_path / "run")
    page_code.run_page(
        tmp_path / "page.md", tmp_path / "run", os.environ["LITTORAL"], None, tmp_path / "kept"
    )
    assert (tmp_path / "kept" / "a.png").read_text() == "command"


@pytest.mark.parametrize(
    "code, said",
    [
        ("```sh\nlittoral info nowhere.obj\n```", "nowhere.obj"),
        ("```cpp\nint nowhere_in_the_sources;\n```", "in no file"),
        ("```\nno language\n```", "what is ''"),
    ],
)
def test_what_does_not_run_is_named_with_its_line(
    code: str, said: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "page.md").write_text(f"# Page\n\n{code}\n")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(RuntimeError, match=r"page\.md:3: ") as error:
        page_code.run_page(tmp_path / "page.md", tmp_path, os.environ["LITTORAL"])
    assert said in str(error.value)
