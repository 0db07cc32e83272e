"""Every class of bad input in the shared collection: message and exit status."""

import json
import os
from pathlib import Path
from typing import Any

import pytest
from conftest import Run

SHARED = Path(os.environ.get("LITTORAL_SHARED", Path(__file__).parents[3] / "shared"))
DATA = SHARED / "data" / "generated"
pytestmark = pytest.mark.skipif(not DATA.is_dir(), reason=f"needs {DATA}")

# What the message must say after the name of the file, by file.
FILES = {
    "bad_magic.ply": ":1: expected the word 'ply'",
    "binary_junk.obj": ":1: NUL byte in a text file",
    "comma_decimal.obj": ":1: expected a coordinate, found '-0,525731112'",
    "comment_only.obj": ": no vertices",
    "count_lie.off": ":2: the header promises 42000000000 vertices, the file has 1922 bytes",
    "count_lie.ply": ": the header promises 4294967295 of element 'vertex', 1544 bytes follow it",
    "count_lie.stl": ": byte 80: the header says 4294967295 triangles, the data hold 80",
    "count_negative.ply": ":3: expected a count, found '-1'",
    "empty.obj": ": no vertices",
    "empty.off": ":1: the file is empty",
    "empty.stl": ": byte 0: the file ends inside the header of a binary STL",
    "faces_only.obj": ": no vertices",
    "garbage_token.obj": ":4: expected a coordinate, found 'x'",
    "header_only.stl": ": byte 80: the file ends inside the header of a binary STL",
    "index0.obj": ":123: face refers to vertex 0, but OBJ counts from 1",
    "index_big.obj": ":123: face refers to vertex 43, the file has 42",
    "index_float.obj": ":123: expected a vertex index, found '3.5'",
    "index_huge.obj": ":123: expected a vertex index, found '99999999999999999999'",
    "index_neg_big.obj": ":123: face refers to vertex -43, only 42 come before it",
    "oob.off": ":45: face refers to vertex 990, the file has 42 (counted from 0)",
    "oob.ply": ": byte 1728: face 80 refers to vertex 42, the file has 42 (counted from 0)",
    "truncated.off": ":39: expected a coordinate, found the end of the line",
    "truncated.ply": ": byte 1412: the file ends after 56 of 80 of element 'face'",
    "truncated.stl": ": byte 80: the header says 80 triangles, the data hold 78",
    "truncated_ascii.ply": ":113: the file ends after 62 of 80 of element 'face'",
    "truncated_header.ply": ":4: the file ends inside the header",
    "unknown.xyz9": ": cannot be read as a surface",
    "unknown_type.ply": ":4: unknown type 'half'",
    "wrong_extension_ply.obj": ": no vertices",
    # may be accepted or not; these are not
    "count_small.stl": ": byte 80: the header says 40 triangles, the data hold 80",
    "face1.obj": ":123: face has 1 corner, at least 3 are needed",
    "face2.obj": ":123: face has 2 corners, at least 3 are needed",
    "nul_bytes.obj": ":7: NUL byte in a text file",
    "number_forms.obj": ":4: expected a coordinate, found '0x1p-1'",
    "truncated_ascii.stl": ":75: the file ends inside a vertex",
    "truncated_mid.obj": ":60: face has 0 corners, at least 3 are needed",
    "vertex2.obj": ":4: expected a coordinate, found the end of the line",
    "zero_faces_vertices.ply": ": no vertices",
}

CURVES = {
    "bad_bary.txt": ":2: a point on face 0 has the barycentric coordinate -0.800000, outside",
    "bad_keyword.txt": ":1: unknown record 'signed_curv'",
    "bad_noheader.txt": ":1: nodes with neither a keyword line",
    "bad_onenode.txt": ":1: signed_curve has 1 node, at least 2 are needed",
    "bad_oob.txt": ":3: node refers to vertex 99999, the mesh has 642 (counted from 0)",
    "empty.txt": ": no sources",
}

GEOMETRY = {
    "allcoincident.obj": "the mesh has no extent: all its vertices are at one point",
    "inf_vertex.obj": "vertex 7, used by face 5, has a coordinate that is not finite",
    "nan_vertex.obj": "vertex 7, used by face 5, has a coordinate that is not finite",
}


def expected(folder: str, verdict: str) -> set[str]:
    table: dict[str, Any] = json.loads((DATA / "expected.json").read_text())
    names = [n for n, entry in table.items() if entry["expect"] == verdict]
    return {n.split("/", 1)[1] for n in names if n.startswith(folder + "/")}


def test_no_class_is_left_out() -> None:
    assert expected("files", "reject") <= set(FILES)
    # docs/reference/curves.md: such curves are traced across the mesh instead
    assert expected("curves", "reject") - set(CURVES) == {"bad_nonadjacent.txt"}
    assert not expected("files", "load") & set(FILES)
    assert not expected("geometry", "load") & set(GEOMETRY)


@pytest.mark.parametrize("name", FILES)
def test_bad_mesh_file(run: Run, name: str) -> None:
    for verb in (
        ("info", DATA / "files" / name),
        ("convert", DATA / "files" / name, "-o", "a.ply"),
    ):
        assert f"error: {DATA / 'files' / name}{FILES[name]}" in run(*verb, status=2).stderr


@pytest.mark.parametrize("name", CURVES)
def test_bad_curve_file(run: Run, tmp_path: Path, name: str) -> None:
    folder = DATA / "curves"
    result = run(
        "distance", folder / "sphere_cap.obj", "--sources", folder / name, "-o", "a.txt", status=2
    )
    assert f"error: {folder / name}{CURVES[name]}" in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_nodes_that_share_no_face_are_traced(run: Run, tmp_path: Path) -> None:
    folder = DATA / "curves"
    curve = folder / "bad_nonadjacent.txt"
    words = ("distance", folder / "sphere_cap.obj", "--sources", curve, "-o", "a.txt", "--json")
    assert json.loads(run(*words).stdout)["sizes"]["traced segments"] == 2
    assert len((tmp_path / "a.txt").read_text().split()) == 642


@pytest.mark.parametrize("name", GEOMETRY)
def test_bad_geometry(run: Run, name: str) -> None:
    mesh = DATA / "geometry" / name
    assert GEOMETRY[name] in run("distance", mesh, "--vertex", 0, "-o", "a.txt", status=2).stderr


def test_acceptable_meshes_and_curves_load(run: Run) -> None:
    for name in sorted(expected("files", "load")):
        run("info", DATA / "files" / name)
    for name in ("sphere_cap.txt", "mixed.txt", "facecurve2.txt", "crlf.txt", "points.txt"):
        mesh, curve = DATA / "curves" / "sphere_cap.obj", DATA / "curves" / name
        run("distance", mesh, "--sources", curve, "-o", "a.txt")
