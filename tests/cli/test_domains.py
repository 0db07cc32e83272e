"""Polygon meshes, point clouds and voxels: distance, pictures, pages, errors."""

import json
from pathlib import Path

import pytest
from conftest import Run


def quads(n: int) -> str:
    lines = [f"v {i / n} {j / n} 0" for j in range(n + 1) for i in range(n + 1)]
    for j in range(n):
        for i in range(n):
            a = j * (n + 1) + i + 1
            lines.append(f"f {a} {a + 1} {a + n + 2} {a + n + 1}")
    return "\n".join(lines) + "\n"


def cloud(n: int) -> str:
    rows = (f"{i / n} {(j + 0.3 * (i % 2)) / n} 0" for j in range(n + 1) for i in range(n + 1))
    return "\n".join(rows) + "\n"


def voxels(inside: str) -> bytes:
    """A cube of 6^3 voxels, those set for which the expression of i, j, k holds."""
    data = bytes(
        int(bool(eval(inside, {"i": i, "j": j, "k": k})))
        for k in range(6)
        for j in range(6)
        for i in range(6)
    )
    return b"X: 6\nY: 6\nZ: 6\nVoxel-Size: 1\n.\n" + data


@pytest.fixture
def surfaces(tmp_path: Path) -> dict[str, str]:
    (tmp_path / "quads.obj").write_text(quads(10))
    (tmp_path / "cloud.xyz").write_text(cloud(10))
    (tmp_path / "block.vol").write_bytes(voxels("1 <= i < 5 and 1 <= j < 5 and 1 <= k < 5"))
    nodes = "".join(f"v {5 + 11 * j}\n" for j in range(11))
    (tmp_path / "curve.txt").write_text("signed_curve\n" + nodes)
    return {"polygon mesh": "quads.obj", "point cloud": "cloud.xyz", "voxel surface": "block.vol"}


def test_every_domain_gives_values_pictures_and_pages(
    run: Run, surfaces: dict[str, str], tmp_path: Path
) -> None:
    for domain, file in surfaces.items():
        for method in ("signed-heat", "unsigned-heat"):
            out = ("-o", "a.csv", "-o", "a.png", "-o", "a.html", "-o", "a.ply")
            done = run("distance", file, "--vertex", 0, "--method", method, "--json", *out)
            report = json.loads(done.stdout)
            assert report["domain"] == domain
            rows = (tmp_path / "a.csv").read_text().splitlines()
            assert len(rows) == 1 + report["sizes"]["vertices"]
            assert (tmp_path / "a.png").stat().st_size > 1000
            assert (tmp_path / "a.html").read_text().startswith("<!doctype html>")
        run("render", "a.ply", "-o", "b.png")
        run("view", "a.ply", "-o", "b.html")
        assert (tmp_path / "b.png").stat().st_size > 1000


def test_signs_are_those_of_triangles(run: Run, surfaces: dict[str, str], tmp_path: Path) -> None:
    for file in ("quads.obj", "cloud.xyz"):
        run("distance", file, "--sources", "curve.txt", "--flip", "-o", "b.txt")
        run("distance", file, "--sources", "curve.txt", "-o", "a.txt")
        a = [float(x) for x in (tmp_path / "a.txt").read_text().split()]
        b = [float(x) for x in (tmp_path / "b.txt").read_text().split()]
        assert a[0] == pytest.approx(0.5, abs=0.05)
        assert a[10] == pytest.approx(-0.5, abs=0.05)
        assert b == pytest.approx([-x for x in a], abs=1e-9)


def test_normals_turn_the_sign_of_clouds(
    run: Run, surfaces: dict[str, str], tmp_path: Path
) -> None:
    down = [row + " 0 0 -1" for row in cloud(10).splitlines()]
    (tmp_path / "down.xyz").write_text("\n".join(down) + "\n")
    run("distance", "down.xyz", "--sources", "curve.txt", "-o", "a.txt")
    assert float((tmp_path / "a.txt").read_text().split()[0]) < -0.4


def test_masks_are_voxels(run: Run, surfaces: dict[str, str], tmp_path: Path) -> None:
    data = (tmp_path / "block.vol").read_bytes().split(b".\n", 1)[1]
    head = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 6 6 6\nencoding: raw\n\n"
    (tmp_path / "mask.nrrd").write_bytes(head.encode() + data)
    run("distance", "block.vol", "--vertex", 3, "-o", "a.txt")
    run("distance", "mask.nrrd", "--vertex", 3, "-o", "b.txt")
    assert (tmp_path / "a.txt").read_text() == (tmp_path / "b.txt").read_text()


def test_bad_voxels(run: Run, tmp_path: Path) -> None:
    (tmp_path / "none.vol").write_bytes(voxels("False"))
    (tmp_path / "short.vol").write_bytes(voxels("True")[:-1])
    (tmp_path / "text.vol").write_text("hello\n")
    head = "NRRD0004\ntype: int8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n"
    (tmp_path / "signs.nrrd").write_bytes(head.encode() + b"\1\1\1\1\xff\xff\xff\xff")
    for file, words in (
        ("none.vol", "no voxel that is set"),
        ("short.vol", "do not fit"),
        ("text.vol", "text.vol:1"),
        ("signs.nrrd", "both signs"),
    ):
        assert words in run("distance", file, "--vertex", 0, "-o", "a.txt", status=2).stderr


def test_bad_clouds(run: Run, tmp_path: Path) -> None:
    (tmp_path / "line.xyz").write_text("".join(f"{i} 0 0\n" for i in range(30)))
    (tmp_path / "same.xyz").write_text("1 2 3\n" * 30)
    (tmp_path / "two.xyz").write_text("0 0 0\n1 0 0\n")
    for file in ("line.xyz", "same.xyz", "two.xyz"):
        run("distance", file, "--vertex", 0, "-o", "a.txt", status=2)
    (tmp_path / "nan.xyz").write_text(cloud(10) + "nan 0 0\n")
    run("distance", "nan.xyz", "--vertex", 0, "-o", "a.txt")
    assert (tmp_path / "a.txt").read_text().split()[-1] == "inf"
    run("distance", "nan.xyz", "--vertex", 121, "-o", "a.txt", status=2)


def test_what_does_not_go_together(run: Run, surfaces: dict[str, str], mesh: Path) -> None:
    for domain, file in surfaces.items():
        for option in ("--intrinsic-delaunay", "--discontinuous", "--bounding-only"):
            if domain == "polygon mesh":
                continue  # cut into triangles
            heat = ("--method", "signed-heat", option)
            done = run("distance", file, "--vertex", 0, *heat, "-o", "a.txt", status=2)
            assert f"works on triangle and polygon meshes, not on a {domain}" in done.stderr
        done = run("distance", file, "--vertex", 0, "--method", "exact", "-o", "a.txt", status=2)
        assert "signed-heat" in done.stderr
    both = ("--method", "signed-heat", "--intrinsic-delaunay", "--discontinuous")
    run("distance", mesh, "--sources", "curve.txt", *both, "-o", "a.txt", status=2)
