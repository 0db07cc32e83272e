"""The table of file formats: what messages, help and the documentation say comes from it."""

import re
from pathlib import Path

import pytest
from conftest import Run

ROOT = Path(__file__).parents[2]
VERBS = ["distance", "pairs", "winding", "sdf", "query", "fit-tori", "info", "convert", "contour"]
VERBS += ["offset", "view", "render"]


@pytest.mark.parametrize("page, verb", [("formats", "formats"), ("verbs", "help")])
def test_pages_are_what_the_program_prints(run: Run, page: str, verb: str) -> None:
    assert (ROOT / "docs/reference" / f"{page}.md").read_text() == run(verb, "--markdown").stdout


def kinds(run: Run, extension: str) -> tuple[set[str], set[str]]:
    """What files with an extension are read and written as."""
    for row in run("formats", "--markdown").stdout.splitlines():
        cells = [cell.strip() for cell in row.strip("|").split("|")]
        if cells[0] == f"`{extension}`":
            return set(cells[1].split(", ")), set(cells[2].split(", "))
    raise AssertionError(extension)


def test_rows_of_the_table(run: Run) -> None:
    assert kinds(run, ".nrrd") == ({"volume", "voxels"}, {"volume"})
    assert kinds(run, ".ply") == (
        {"surface", "cloud", "sources"},
        {"surface", "cloud", "sources", "field"},
    )
    assert kinds(run, ".npy") == (
        {"cloud", "volume", "voxels", "table"},
        {"volume", "field", "table"},
    )
    assert kinds(run, ".html") == ({""}, {"page"})
    assert ".nrrd" in run("formats").stdout


def test_messages_say_what_is_possible(run: Run, mesh: Path, tmp_path: Path) -> None:
    (tmp_path / "a.html").write_text("")
    for arguments, said in (
        (("info", "a.what"), "a.what: cannot be read as a surface, cloud, volume or tets"),
        (("info", "a.html"), "a.html: cannot be read as a surface, cloud, volume or tets"),
        (("distance", "square.obj", "-o", "a.tet"), "cannot write a.tet as a field, page"),
        (("sdf", "square.obj", "-o", "a.pcd"), "cannot write a.pcd as a volume, tets"),
        (("query", "square.obj", "--points", "square.obj", "-o", "a.vti"), "as a table or cloud"),
        (("pairs", "square.obj", "-o", "a.ply"), "as a table: the extension is '.ply'"),
        (("render", "square.obj", "-o", "a.jpg"), "as a picture: the extension is '.jpg'"),
        (("view", "square.obj", "-o", "a.png"), "as a page: the extension is '.png'"),
    ):
        error = run(*arguments, status=2).stderr
        assert said in error
        assert "possible: ." in error
    folder = run("info", str(tmp_path), status=2).stderr
    assert "it is a folder" in folder


@pytest.mark.parametrize("verb", VERBS)
def test_help_lists_extensions(run: Run, verb: str) -> None:
    text = " ".join(run(verb, "--help").stdout.split())
    for name in set(re.findall(r"(?<![\w.])\.[a-z]{2,4}\b", text)):
        assert kinds(run, name)


def test_options_have_hyphens_in_messages(run: Run, mesh: Path) -> None:
    for arguments, said in (
        (("--method", "signed-heat", "--soft", "-1"), "option --soft"),
        (("--vertex", "9999"), "option --vertex"),
        (("--method", "signed-heat", "--constraint", "what"), "option --constraint"),
    ):
        error = run(
            "distance", "square.obj", "-s", "curve.txt", *arguments, "-o", "a.csv", status=2
        ).stderr
        assert said in error
        assert "option ----" not in error


def test_extensions_stand_in_the_table_alone() -> None:
    """A format is its own file and its row: no other source knows the name of one."""
    spelled = re.compile(r'"[^"]*\.(nrrd|vti|pcd|vtu|meshb|xyz)\b')
    found = [
        f"{path.relative_to(ROOT)}: {line.strip()}"
        for path in sorted((ROOT / "src").rglob("*"))
        if path.suffix in {".h", ".cpp"} and path.name != "formats.cpp"
        for line in path.read_text().splitlines()
        if spelled.search(line)
    ]
    assert not found
