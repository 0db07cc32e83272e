"""Several shapes as one, distances of implicit functions, traced pictures."""

import json
import math
import struct
import zlib
from pathlib import Path

import pytest
from conftest import Run, results


def spiral(n: int) -> list[tuple[float, float, float]]:
    """Points spread evenly over the unit sphere."""
    points = []
    for i in range(n):
        z = 1 - 2 * (i + 0.5) / n
        r, a = math.sqrt(1 - z * z), i * 2.399963
        points.append((r * math.cos(a), r * math.sin(a), z))
    return points


def ball(x: float, n: int = 1200) -> str:
    """A cloud with normals: the unit ball about (x, 0, 0)."""
    return "".join(f"{p[0] + x} {p[1]} {p[2]} {p[0]} {p[1]} {p[2]}\n" for p in spiral(n))


def npy(n: int) -> bytes:
    """x^4 + y^4 + z^4 - 1 at n^3 nodes of [-2, 2]^3, as .npy, where spacing is 1 and origin 0."""
    half = (n - 1) / 2
    powers = [(2 * (t - half) / half) ** 4 for t in range(n)]
    values = [x + y + z - 1 for x in powers for y in powers for z in powers]
    head = f"{{'descr': '<f8', 'fortran_order': False, 'shape': ({n}, {n}, {n}), }}"
    head += " " * (-(len(head) + 11) % 64) + "\n"
    start = b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode()
    return start + struct.pack(f"<{n**3}d", *values)


@pytest.fixture
def balls(tmp_path: Path) -> Path:
    """a.xyz about the origin, b.xyz about (1, 0, 0), q.csv: five places."""
    (tmp_path / "a.xyz").write_text(ball(0))
    (tmp_path / "b.xyz").write_text(ball(1))
    (tmp_path / "q.csv").write_text("x,y,z\n-3,0,0\n3,0,0\n-0.5,0,0\n0.5,0,0\n1.5,0,0\n")
    return tmp_path


def values(path: Path) -> list[float]:
    return [row[0] for row in results(path)]


@pytest.mark.parametrize(
    ("how", "expected"),
    [
        ("--unite", [2, 1, -0.5, -0.5, -0.5]),
        ("--intersect", [3, 2, 0.5, -0.5, 0.5]),
        ("--subtract", [2, 2, -0.5, 0.5, 0.5]),
    ],
)
def test_two_clouds_are_one_field(run: Run, balls: Path, how: str, expected: list[float]) -> None:
    run("query", "a.xyz", how, "b.xyz", "--points", "q.csv", "-o", "v.csv")
    assert values(balls / "v.csv") == pytest.approx(expected, abs=5e-3)
    arguments = ("--method", "winding", "--operand-method", "planar", "--offset", "0.25")
    run("query", "a.xyz", how, "b.xyz", *arguments, "--points", "q.csv", "-o", "w.csv")
    assert values(balls / "w.csv") == pytest.approx([x - 0.25 for x in expected], abs=0.3)


def test_booleans_are_meshed_offset_and_go_on_as_volumes(run: Run, balls: Path) -> None:
    for name, how in (("u", "--unite"), ("i", "--intersect"), ("d", "--subtract")):
        run("sdf", "a.xyz", how, "b.xyz", "--resolution", 32, "-o", name + ".ply")
        info = json.loads(run("info", name + ".ply", "--json").stdout)
        assert info["components"] == 1
        assert info["boundary_edges"] == 0
    low = json.loads(run("info", "d.ply", "--json").stdout)["bounding_box"]
    assert min(low) == pytest.approx(-1, abs=0.05)
    run("offset", "a.xyz", "--subtract", "b.xyz", "--dilate", "0.2", "-o", "o.ply")
    assert min(json.loads(run("info", "o.ply", "--json").stdout)["bounding_box"]) == pytest.approx(
        -1.2, abs=0.05
    )
    # a volume is a shape too: what was subtracted comes back
    run("sdf", "a.xyz", "--subtract", "b.xyz", "--padding", "1.1", "-o", "d.vti")
    run("query", "d.vti", "--unite", "b.xyz", "--points", "q.csv", "-o", "v.csv")
    assert values(balls / "v.csv") == pytest.approx([2, 1, -0.5, -0.5, -0.5], abs=0.06)
    report = json.loads(
        run(
            "query", "d.vti", "--unite", "b.xyz", "--points", "q.csv", "--json", "-o", "v.csv"
        ).stdout
    )
    assert report["sizes"]["shapes"] == 2


def test_blending_fills_the_notch(run: Run, balls: Path) -> None:
    (balls / "n.csv").write_text("x,y,z\n0.5,0.9,0\n")
    common = ("query", "a.xyz", "--unite", "b.xyz", "--points", "n.csv", "-o")
    run(*common, "sharp.csv")
    run(*common, "round.csv", "--blend", "0.4")
    sharp, rounded = values(balls / "sharp.csv")[0], values(balls / "round.csv")[0]
    assert sharp == pytest.approx(math.hypot(0.5, 0.9) - 1, abs=2e-3)
    assert rounded == pytest.approx(sharp - 0.1, abs=5e-3)


def test_implicit_functions_become_distances(run: Run, tmp_path: Path) -> None:
    n = 33
    (tmp_path / "f.npy").write_bytes(npy(n))
    unit = (n - 1) / 4  # nodes along one unit of the function's space
    middle = (n - 1) / 2
    (tmp_path / "q.csv").write_text(
        f"x,y,z\n{middle + 1.5 * unit},{middle},{middle}\n{middle},{middle - 0.7 * unit},{middle}\n"
    )
    run("query", "f.npy", "--redistance", "--points", "q.csv", "-o", "v.csv")
    # along an axis the surface is at 1, and flat
    assert values(tmp_path / "v.csv") == pytest.approx([0.5 * unit, -0.3 * unit], abs=0.02 * unit)
    run("query", "f.npy", "--as", "distance", "--points", "q.csv", "-o", "w.csv")  # far from one
    assert values(tmp_path / "w.csv")[0] == pytest.approx(1.5**4 - 1, rel=0.02)
    for method in ("tori", "planar", "winding", "signed-heat"):
        run("sdf", "f.npy", "--redistance", "--method", method, "--resolution", 24, "-o", "s.ply")
        info = json.loads(run("info", "s.ply", "--json").stdout)
        assert info["boundary_edges"] == 0
        box = info["bounding_box"]
        assert max(box) == pytest.approx(middle + unit, abs=0.1 * unit)


def pixels(path: Path) -> list[bytes]:
    """The rows of a PNG of 8-bit RGB whose rows are not filtered, or any: undone here."""
    data, at, packed = path.read_bytes(), 8, b""
    width = height = 0
    while at < len(data):
        (size,), kind = struct.unpack(">I", data[at : at + 4]), data[at + 4 : at + 8]
        if kind == b"IHDR":
            width, height = struct.unpack(">II", data[at + 8 : at + 16])
        if kind == b"IDAT":
            packed += data[at + 8 : at + 8 + size]
        at += 12 + size
    raw, rows, before = zlib.decompress(packed), [], bytes(3 * width)
    for y in range(height):
        kind_of_filter, row = raw[y * (3 * width + 1)], bytearray()
        line = raw[y * (3 * width + 1) + 1 : (y + 1) * (3 * width + 1)]
        for i, byte in enumerate(line):
            a, b, c = row[i - 3] if i > 2 else 0, before[i], before[i - 3] if i > 2 else 0
            p = a + b - c
            nearest = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            row.append((byte + [0, a, b, (a + b) // 2, nearest][kind_of_filter]) % 256)
        rows.append(bytes(row))
        before = bytes(row)
    return rows


def test_traced_pictures_show_the_shape(run: Run, balls: Path) -> None:
    size = ("--width", 60, "--height", 60)
    run("render", "a.xyz", "--trace", *size, "-o", "a.png")
    rows = pixels(balls / "a.png")
    ink = sum(row[3 * x] < 240 for row in rows for x in range(60))
    across = sum(rows[30][3 * x] < 240 for x in range(60))
    assert ink == pytest.approx(math.pi / 4 * across**2, rel=0.06)  # a disc
    run("render", "a.xyz", "--subtract", "b.xyz", "--trace", *size, "-o", "d.png")
    assert (balls / "d.png").read_bytes() != (balls / "a.png").read_bytes()
    run("render", "a.xyz", "--trace", "--slice", "0", "--level", "0.2", *size, "-o", "s.png")
    run("view", "a.xyz", "--trace", "-o", "a.html")
    assert '"trace"' in (balls / "a.html").read_text()


def test_united_clouds_are_traced_in_one_picture(run: Run, balls: Path) -> None:
    how = ("--trace", "--view", "z", "--up", "y", "--width", 120, "--height", 90)
    run("render", "a.xyz", "--unite", "b.xyz", *how, "-o", "u.png")
    rows = pixels(balls / "u.png")
    ink = sum(row[3 * x] < 240 for row in rows for x in range(120))
    across = sum(rows[45][3 * x] < 240 for x in range(120))
    area = 2 * math.pi - (2 * math.pi / 3 - math.sqrt(3) / 2)  # of two discs, three across
    assert ink == pytest.approx(area / 9 * across**2, rel=0.06)

    # The groove where they meet sees less of the sky than what bulges out.
    run("render", "a.xyz", "--unite", "b.xyz", *how, "--shading", "occluded", "-o", "o.png")
    dark = pixels(balls / "o.png")
    shade = [d / s for d, s in zip(dark[45], rows[45], strict=True)][::3]
    first = next(x for x in range(120) if rows[45][3 * x] < 240)
    groove, bulge = first + across // 2, first + across // 3
    assert min(shade[groove - 2 : groove + 3]) < 0.95
    assert shade[bulge - 8] > 0.97
    run("view", "a.xyz", "--trace", "--shading", "occluded", "-o", "o.html")
    assert '"shading":"occluded"' in (balls / "o.html").read_text().replace(" ", "")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("query", "a.xyz", "--points", "q.csv", "--operand-method", "tori"), "--operand-method"),
        (("query", "a.xyz", "--points", "q.csv", "--blend", "-1"), "--blend"),
        (("query", "a.xyz", "--points", "q.csv", "--blend", "nan"), "--blend"),
        (("query", "a.xyz", "--points", "q.csv", "--offset", "inf"), "offset"),
        (("query", "a.xyz", "--points", "q.csv", "--redistance"), "--redistance"),
        (("query", "a.xyz", "--points", "q.csv", "--unite", "missing.ply"), "missing.ply"),
        (("query", "a.xyz", "--points", "q.csv", "--unite", "empty.xyz"), "empty.xyz"),
        (("query", "a.xyz", "--points", "q.csv", "--subtract", "nan.xyz"), "finite"),
        (
            ("query", "a.xyz", "--points", "q.csv", "--unite", "b.xyz", "--method", "signed-heat"),
            "set of points",
        ),
    ],
)
def test_bad_combinations_are_named(
    run: Run, balls: Path, arguments: tuple[str, ...], words: str
) -> None:
    (balls / "empty.xyz").write_text("")
    (balls / "nan.xyz").write_text(ball(0, 20) + "nan 0 0 1 0 0\n")
    assert words in run(*arguments, "-o", "v.csv", status=2).stderr
    assert not (balls / "v.csv").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("a.xyz", "--unite", "b.xyz"), "--trace"),
        (("a.xyz", "--method", "tori"), "--trace"),
        (("a.xyz", "--trace", "--sources", "x.txt"), "--sources"),
        (("a.xyz", "--trace", "--width", "100000"), "16384"),
        (("a.xyz", "--trace", "--width", "16384", "--height", "16384"), "million"),
        (("a.xyz", "--trace", "--width", "0"), "16"),
        (("a.xyz", "--trace", "--level=-50"), "level"),
        (("a.xyz", "--trace", "--level", "nan"), "--level"),
        (("a.xyz", "--trace", "--slice", "9"), "slice"),
        (("a.xyz", "--trace", "--method", "signed-heat"), "set of points"),
        (("empty.xyz", "--trace"), "empty.xyz"),
        (("point.xyz", "--trace"), "one place"),
        (("nan.xyz", "--trace"), "finite"),
    ],
)
def test_bad_requests_to_trace_are_named(
    run: Run, balls: Path, arguments: tuple[str, ...], words: str
) -> None:
    (balls / "empty.xyz").write_text("")
    (balls / "point.xyz").write_text("0 0 0 1 0 0\n" * 5)
    (balls / "nan.xyz").write_text(ball(0, 20) + "nan 0 0 1 0 0\n")
    assert words in run("render", *arguments, "-o", "x.png", status=2).stderr
    assert not (balls / "x.png").exists()


def test_pages_trace_clouds_by_tori(run: Run, balls: Path) -> None:
    run("view", "a.xyz", "--trace", "--unite", "b.xyz", "-o", "x.html")
    assert (balls / "x.html").read_text().count('"operation":"unite"') == 2
    for arguments in (("--unite", "b.xyz", "--operand-method", "planar"), ("--method", "planar")):
        error = run("view", "a.xyz", "--trace", *arguments, "-o", "y.html", status=2).stderr
        assert "pictures trace all shapes" in error
    many = ["--unite", "b.xyz"] * 8
    assert "at most 8" in run("view", "a.xyz", "--trace", *many, "-o", "y.html", status=2).stderr
