"""Files that are not what their names say, and soups that are put together."""

import gzip
import json
import struct
from pathlib import Path

import pytest
from conftest import Run

OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
STL = (
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    "endloop\nendfacet\nendsolid a\n"
)
PLY = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n"
PAGE = "<!DOCTYPE html>\n<html><body>Not found</body></html>\n"
POINTER = "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 9\n"


@pytest.mark.parametrize(
    ("name", "contents", "says"),
    [
        ("a.ply", OBJ, "its contents look like .obj or .pc: name it so"),
        ("a.obj", STL, "its contents look like .stl"),
        ("a.stl", PLY + 99 * "0\n", "its contents look like .ply"),
        ("a.mesh", "$MeshFormat\n4.1 0 8\n", "its contents look like .msh"),
        ("a.nrrd", "\x93NUMPY\x01\x00", "its contents look like .npy"),
        ("a.msh", "# vtk DataFile Version 3.0\n", "its contents look like .vtk"),
        ("a.off", PAGE, "it is a web page"),
        ("a.stl", PAGE, "it is a web page"),
        ("a.vtu", POINTER, "'git lfs pull' fetches the file"),
        ("a.obj", "\n \n", "the file is empty"),
        ("a.stl", "\x1f\x8b\x08" + 90 * "\x00", "name it .stl.gz"),
        ("a.ply", "PK\x03\x04", "its contents look like .3mf or .npz"),
        ("a.obj", OBJ.replace("v 1 0 0", "v 1,5 0 0"), "write a point, not a comma"),
        ("a", OBJ, "it has no extension, which says the format"),
        ("a.vti", '<VTKFile type="RectilinearGrid">', "save it as ImageData"),
        ("a.csv", "1,2,3\n", "Name rows of points .xyz"),
        ("a.xyz", "a b c\n0 0 0\n", "names no columns x, y and z"),
        ("a.xyz", "0,5 0,25 0\n", "write a point, not a comma"),
    ],
)
def test_what_a_file_looks_like_is_said(
    run: Run, tmp_path: Path, name: str, contents: str, says: str
) -> None:
    (tmp_path / name).write_bytes(contents.encode("latin-1"))
    assert says in run("info", name, status=2).stderr


def test_contents_tell_what_names_do_not(run: Run, tmp_path: Path) -> None:
    """VTK's files under each other's names, and files whose names say nothing."""
    (tmp_path / "a.stl").write_text(STL)
    run("distance", "a.stl", "--vertex", 0, "-o", "a.vtp", "--quiet")
    run("sdf", "a.stl", "--resolution", 8, "--quiet", "-o", "v.vti")
    for source, names in {
        "a.vtp": ("b.vtk", "b.vtu", "b.vti", "b", "b.dat", "b.vtk.gz", "B.VTK"),
        "a.stl": ("c", "c.dat", "c.tmp.gz"),
    }.items():
        contents = (tmp_path / source).read_bytes()
        facts = run("info", source).stdout
        for name in names:
            packed = gzip.compress(contents) if name.endswith(".gz") else contents
            (tmp_path / name).write_bytes(packed)
            assert run("info", name).stdout == facts
    (tmp_path / "v.vtk").write_bytes((tmp_path / "v.vti").read_bytes())
    assert run("info", "v.vtk").stdout == run("info", "v.vti").stdout
    run("offset", "v.vtk", "--as", "distance", "--distance", 0.3, "-o", "o.ply", "--quiet")
    # What is there is named where it is of no use.
    said = run("query", "a.stl", "--points", "v.vtk", "-o", "d.csv", status=2).stderr
    assert "cannot be read as a table, surface or cloud: it holds '.vti'" in said
    # In a folder names alone count: it may hold anything.
    folder = tmp_path / "in"
    folder.mkdir()
    (folder / "a.stl").write_text(STL)
    (folder / "README").write_text(STL)
    run("batch", "in", "--verb", "info", "-o", "out", "--quiet")
    assert len((tmp_path / "out/status.jsonl").read_text().splitlines()) == 1


def binary_stl(head: bytes = b"", n: int = 2) -> bytes:
    """n triangles, each after an 80-byte header and their number."""
    triangles = [struct.pack("<12fH", 0, 0, 1, 0, 0, i, 1, 0, i, 0, 1, i, 0) for i in range(n)]
    return head.ljust(80, b" ") + struct.pack("<I", n) + b"".join(triangles)


@pytest.mark.parametrize("head", [b"", b"solid part", b"ply or what", b"\0" * 80, b"v 1 2 3\n"])
def test_binary_stl_is_told_by_its_size(run: Run, tmp_path: Path, head: bytes) -> None:
    """It begins anyhow, and holds 50 bytes for each triangle that it counts."""
    (tmp_path / "a.stl").write_bytes(binary_stl(head))
    facts = run("info", "a.stl").stdout
    for name in ("a", "a.dat", "a.dat.gz"):
        contents = binary_stl(head)
        (tmp_path / name).write_bytes(gzip.compress(contents) if name[-2:] == "gz" else contents)
        assert run("info", name).stdout == facts
    (tmp_path / "a.ply").write_bytes(binary_stl(head))
    assert "look like .stl: name it so" in run("info", "a.ply", status=2).stderr


def test_what_is_nearly_binary_stl_is_not_taken_for_it(run: Run, tmp_path: Path) -> None:
    whole = binary_stl()
    one_more = whole[:80] + struct.pack("<I", 3) + whole[84:]
    none = binary_stl(n=0)
    for contents in (whole[:-1], whole + b"\0", whole[:83], whole[:84], one_more, none, 184 * b" "):
        (tmp_path / "a.dat").write_bytes(contents)
        said = run("info", "a.dat", status=2).stderr
        assert "the extension is '.dat'" in said


def test_what_is_damaged_alone_is_not_called_another_format(run: Run, tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text(OBJ.replace("f 1 2 3", "f 1 2 9"))
    assert "look like" not in run("info", "a.obj", status=2).stderr


def test_a_soup_is_welded(run: Run, tmp_path: Path) -> None:
    """The faces of a tetrahedron, each with corners of its own, off by a millionth."""
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
    rows = [
        tuple(x + 1e-6 * ((3 * f + k) % 2) for x in corners[v])
        for f, face in enumerate(faces)
        for k, v in enumerate(face)
    ]
    triangles = [struct.pack("<12fH", 0, 0, 0, *sum(rows[i : i + 3], ()), 0) for i in (0, 3, 6, 9)]
    (tmp_path / "a.stl").write_bytes(80 * b" " + struct.pack("<I", 4) + b"".join(triangles))

    def info(name: str) -> dict[str, object]:
        facts: dict[str, object] = json.loads(run("info", name, "--json").stdout)
        return facts

    assert not info("a.stl")["closed"]
    for distance in ("0.001%", "1e-5"):
        run("convert", "a.stl", "--weld", distance, "-o", "b.ply")
        facts = info("b.ply")
        assert (facts["vertices"], facts["faces"], facts["watertight"]) == (4, 4, True)
    run("convert", "a.stl", "--weld", 0, "-o", "b.ply")
    assert not info("b.ply")["closed"]
    said = run("convert", "a.stl", "--weld", 2, "-o", "b.xyz.ply").stderr
    assert "4 faces shrank" in said
    assert "[degenerate-faces]" in said
    said = run("convert", "a.stl", "--weld=-1", "-o", "b.ply", status=2).stderr
    assert "--weld takes no negative number" in said
    run("sdf", "a.stl", "--resolution", 8, "-o", "v.vti")
    said = run("convert", "v.vti", "--weld", 0, "-o", "v.nrrd", status=2).stderr
    assert "option --weld is for surfaces" in said
