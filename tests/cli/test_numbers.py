"""Numbers, lengths, tables and masks as they are given: taken as meant, or refused by name."""

import json
from pathlib import Path

import numpy as np
import pytest
from conftest import Run, results

N = 17
BALL = np.linalg.norm(np.indices((N, N, N)) - (N - 1) / 2, axis=0) < 5


@pytest.fixture
def field(tmp_path: Path) -> Path:
    """sdf.npz: distance to a sphere of radius 5 in a box of side 16; q.csv: its middle."""
    distance = np.linalg.norm(np.indices((N, N, N)) - (N - 1) / 2, axis=0) - 5
    np.savez(tmp_path / "sdf.npz", values=distance, origin=np.zeros(3), spacing=1)
    (tmp_path / "q.csv").write_text("x,y,z\n8,8,8\n")
    return tmp_path


def middle(folder: Path) -> float:
    return results(folder / "v.csv")[0][0]


@pytest.mark.parametrize("kind", ["npy", "vol"])
@pytest.mark.parametrize("reverse", [False, True])
def test_the_side_of_a_mask_is_seen_or_asked_for(
    run: Run, field: Path, kind: str, reverse: bool
) -> None:
    mask = np.where(reverse != BALL, 255, 0).astype(np.uint8)
    if kind == "npy":
        np.save(field / "m.npy", mask)
    else:
        head = f"X: {N}\nY: {N}\nZ: {N}\nVoxel-Size: 1\nVersion: 2\n.\n"
        (field / "m.vol").write_bytes(head.encode() + mask.tobytes(order="F"))
    words = ("query", f"m.{kind}", "--points", "q.csv", "-o", "v.csv")
    refused = run(*words, *([] if reverse else ["--flip"]), status=2).stderr
    assert "fills 100 % of the border" in refused
    assert "--as mask" in refused and "--flip" in refused
    assert "[volume-meaning]" in refused
    run(*words, *(["--flip"] if reverse else []))
    assert middle(field) == pytest.approx(-4.8, abs=0.3)
    run(*words, "--as", "mask", *([] if reverse else ["--flip"]))
    assert middle(field) == pytest.approx(4.8, abs=0.3)  # as said: the middle is outside
    advice = run("info", f"m.{kind}").stdout.splitlines()[-1]
    assert ("take --flip" in advice) == reverse


def test_a_mask_cut_off_by_its_box_is_taken(run: Run, field: Path) -> None:
    np.save(field / "m.npy", (np.indices((N, N, N))[2] < 8).astype(np.uint8))  # the lower half
    run("query", "m.npy", "--points", "q.csv", "-o", "v.csv")
    assert middle(field) == pytest.approx(0.5, abs=0.1)
    np.save(field / "m.npy", 1 + BALL.astype(np.uint8))  # 1 and 2: nothing is outside
    refused = run("query", "m.npy", "--as=mask", "--points=q.csv", "-o=v.csv", status=2).stderr
    assert "no value of the mask is 0" in refused and "--threshold" in refused


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("contour", "sdf.npz", "--level", "0,05"), "'05' begins with 0"),
        (("offset", "sdf.npz", "--distance=-1,-05"), "'-05' begins with 0"),
        (("contour", "sdf.npz", "--level", "1,,2"), "a number is missing in '1,,2'"),
        (("contour", "sdf.npz", "--count=3", "--range", "0,5,1,5"), "two numbers, a,b, found 4"),
        (("contour", "sdf.npz", "--level", "5%"), "% is of the longest side of a shape"),
        (("contour", "sdf.npz", "--count=3", "--range=1%,2"), "takes no per cent"),
        (("offset", "square.obj", "--shell", "1,5"), "one length, found 2"),
        (("offset", "square.obj", "--distance", "1e300"), "reach 1e+300 from an input of size 1"),
        (("sdf", "square.obj", "--bounds", "0,5,1,5"), "six numbers, x0,y0,z0,x1,y1,z1, found 4"),
        (("sdf", "square.obj", "--padding=-1%"), "'-1%' is no number from 0 to 1000"),
        (("distance", "square.obj", "--vertex", "1,,2"), "a number is missing in '1,,2'"),
        (("distance", "square.obj", "--vertex=1,"), "a number is missing in '1,'"),
        (("distance", "square.obj", "--at", "0,5,0,5,0,0"), "three numbers, x,y,z, found 6"),
        (("render", "sdf.npz", "--slice", "101%"), "101% is not on the way"),
        (("offset", "square.obj", "--distance", "5mm"), "no unit but that of the input"),
        (("offset", "square.obj", "--distance", "five"), "'five' is not a finite number ["),
    ],
)
def test_lists_that_are_not_what_was_meant(
    run: Run, mesh: Path, field: Path, words: tuple[str, ...], said: str
) -> None:
    out = {"sdf": "a.vti", "render": "a.png"}.get(words[0], "a.ply")
    refused = run(*words, "-o", out, status=2).stderr
    assert said in refused
    assert refused.endswith(("[option-value]\n", "[options-conflict]\n"))


def test_a_decimal_comma_that_may_be_two_numbers_is_told(run: Run, field: Path) -> None:
    words = ("contour", "sdf.npz", "-o", "a.ply", "--level")
    told = run(*words, "0,2").stderr
    assert "0,2 is two numbers, 0 and 2; for one number write 0.2" in told
    assert "[decimal-comma]" in told
    for clear in (("0, 2",), ("0", "2"), ("0.2",), ("0,0.5",), ("-1,2",)):
        assert run(*words, *clear).stderr == ""
    for blank in (("1,", "2"), ("1", ",2"), ("1,2",)):
        run(*words, *blank)
        assert len(run("contour", "sdf.npz", "-o", "b.obj", "--level", *blank).stderr) == 0


def test_per_cent_is_of_the_longest_side(run: Run, mesh: Path, field: Path) -> None:
    for a, b in (("0.25", "25%"), ("0", "0%")):
        for padding in (a, b):
            words = ("sdf", "square.obj", "--resolution=9", "--padding", padding, "--json")
            run(*words, "-o", f"{padding}.npz")
        assert (mesh.parent / f"{a}.npz").read_bytes() == (mesh.parent / f"{b}.npz").read_bytes()
    run("distance", "square.obj", "--vertex=0", "-o", "d.ply")
    run("contour", "d.ply", "--level=25%", "-o", "a.obj")
    run("contour", "d.ply", "--level=0.25", "-o", "b.obj")
    assert (mesh.parent / "a.obj").read_bytes() == (mesh.parent / "b.obj").read_bytes()
    pictures = []
    for place in ("4", "25%", "8"):
        run("render", "sdf.npz", "--slice", place, "--no-surface", "--width=64", "-o", "a.png")
        pictures.append((mesh.parent / "a.png").read_bytes())
    assert pictures[0] == pictures[1] != pictures[2]
    answers = []
    for smoothing in ("0.1", "10%"):
        words = ("winding", "square.obj", "--points=q.csv", "--smoothing", smoothing)
        (mesh.parent / "q.csv").write_text("x,y,z\n0.5,0.5,0.1\n")
        run(*words, "-o", "w.csv")
        answers.append((mesh.parent / "w.csv").read_text())
    assert answers[0] == answers[1]


def test_warnings_name_options_and_rounded_lengths(run: Run, field: Path) -> None:
    done = run("offset", "sdf.npz", "--shell", "0.123456789", "--json", "-o", "a.ply")
    (warning,) = json.loads(done.stdout)["warnings"]
    assert "thickness 0.1235" in warning["message"]
    assert "--resolution 276 has two cells across it" in warning["message"]
    assert f"{warning['message']} [wall-thin]\n" in done.stderr
    told = run("offset", "sdf.npz", "--shell", "1e-6", "-o", "a.ply").stderr
    assert "a thicker wall, or smaller --bounds" in told


def test_what_no_grid_holds_is_not_recommended(run: Run, tmp_path: Path) -> None:
    plate = [(x, y, z) for z in (0, 0.0005) for y in (0, 1) for x in (0, 1)]
    faces = ("1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6")
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in plate) + "".join(f"f {f}\n" for f in faces)
    (tmp_path / "plate.obj").write_text(text)
    box = "--bounds=-.1,-.1,-.13,1.1,1.1,1.07"  # without a node in the plate
    words = ("sdf", "plate.obj", "--resolution=16", box, "-o", "a.npz")
    told = run(*words).stderr
    assert "too thin for a grid of this box" in told
    assert "[thin-parts]" in told and "--resolution" not in told
    (tmp_path / "plate.obj").write_text(text.replace("0.0005", "0.02"))
    assert "; --resolution " in run(*words).stderr


POINTS = np.array([[8.0, 8, 8], [8, 8, 2]])


def tables() -> dict[str, np.ndarray]:
    rows = [(*p, 7) for p in POINTS]
    return {
        "records": np.array(rows, [("x", "<f4"), ("Y", ">f8"), ("z", "<f8"), ("id", "<i4")]),
        "aligned": np.array(
            [(p, "ab") for p in POINTS],
            np.dtype([("points", "<f4", (3,)), ("tag", "<U4")], align=True),
        ),
        "mixed": np.array([(1, *p) for p in POINTS], [("i", "u1"), *((a, "<f8") for a in "zyx")]),
    }


@pytest.mark.parametrize("kind", ["records", "aligned", "mixed"])
def test_records_of_numpy_are_points(run: Run, field: Path, kind: str) -> None:
    table = tables()[kind]
    np.save(field / "p.npy", table)
    np.savez(field / "p.npz", points=table)
    first = [-5, -3] if kind == "mixed" else [-5, 1]
    for name in ("p.npy", "p.npz"):
        run("query", "sdf.npz", "--points", name, "-o", "v.npy")
        found = np.load(field / "v.npy")
        if kind == "mixed":  # z, y, x
            first[1] = 1
        assert found == pytest.approx(first, abs=0.1)


def test_arrays_that_are_no_points_say_why(run: Run, field: Path) -> None:
    words = ("query", "sdf.npz", "--points", "p.npy", "-o", "v.csv")
    np.save(field / "p.npy", np.zeros((3, 5)))
    assert "this one is 3 x 5: transpose it" in run(*words, status=2).stderr
    np.save(field / "p.npy", np.array([(1, 2)], [("a", "<f4"), ("b", "<f4")]))
    assert "records with the fields a, b;" in run(*words, status=2).stderr
    np.save(field / "p.npy", tables()["records"])
    whole = (field / "p.npy").read_bytes()
    (field / "p.npy").write_bytes(whole[:-1])
    assert "more numbers than the file holds" in run(*words, status=2).stderr
    for wrong in (b"(3,)", b"(3", b"['x', "):
        (field / "p.npy").write_bytes(whole.replace(b"('Y', '>f8')", wrong.ljust(12)))
        assert "[bad-file]" in run(*words, status=2).stderr


@pytest.mark.parametrize(
    "head",
    [
        "id\tx\ty\tz",
        "id\tPx\tPy\tPz",
        "id\tPoints_0\tPoints_1\tPoints_2",
        "id\tpos_x\tpos_y\tpos_z",
    ],
)
def test_tables_between_tabs(run: Run, field: Path, head: str) -> None:
    (field / "p.tsv").write_text(f"{head}\na, b\t8\t8\t8\nc\t8\t8\t2\n")
    run("query", "sdf.npz", "--points", "p.tsv", "-o", "v.tsv")
    rows = [line.split("\t") for line in (field / "v.tsv").read_text().splitlines()]
    assert rows[0] == [*head.split("\t"), "distance"]
    assert [float(row[4]) for row in rows[1:]] == pytest.approx([-5, 1], abs=0.1)
