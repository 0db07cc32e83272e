"""Samples for learning: formats, cards, and what is refused."""

import json
import tarfile
from pathlib import Path

import numpy as np
import pytest
from conftest import Run, square

FEW = ("--surface", "50", "--space", "80", "--resolution", "12")


@pytest.fixture
def block(tmp_path: Path) -> Path:
    """The cube from 0 to 1."""
    corners = "".join(f"v {v & 1} {v >> 1 & 1} {v >> 2}\n" for v in range(8))
    faces = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
    (tmp_path / "block.obj").write_text(corners + faces)
    return tmp_path


def arrays(path: Path) -> dict[str, np.ndarray]:
    with np.load(path) as data:
        return {name: data[name] for name in data}


def test_arrays_and_card_belong_together(run: Run, block: Path) -> None:
    report = json.loads(run("samples", "block.obj", *FEW, "--json", "-o", "s.npz").stdout)
    data = arrays(block / "s.npz")
    card = json.loads((block / "s.json").read_text())
    assert data["points"].shape == (80, 3) and data["points"].dtype == np.float32
    assert data["surface_normals"].shape == (50, 3)
    *centre, half = data["normalisation"]
    assert centre == [0.5] * 3 and half == pytest.approx(0.6)
    assert card["normalisation"]["half_side"] == half
    assert card["options"]["space"] == 80 and card["input"] == "block.obj"
    assert report["method"] == card["report"]["method"] == "auto"
    assert card["report"]["sizes"]["surface open edges"] == 0
    x = data["points"] * half + centre
    q = np.abs(x - 0.5) - 0.5
    exact = np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(axis=1), 0)
    assert np.abs(data["distances"] * half - exact).max() < 1e-6
    assert ((data["occupancy"] == 1) == (data["distances"] <= 0)).all()
    assert data["faces"].max() < len(data["vertices"])


def test_formats_hold_the_same(run: Run, block: Path) -> None:
    for name in ("s.npz", "s.zarr", "a.b.tar", "s.zarr"):  # a folder is replaced
        run("samples", "block.obj", *FEW, "--numbers", "float16", "-o", name)
    data = arrays(block / "s.npz")
    for name, array in data.items():
        head = json.loads((block / "s.zarr" / name / ".zarray").read_text())
        [chunk] = [p for p in (block / "s.zarr" / name).iterdir() if p.name != ".zarray"]
        values = np.frombuffer(chunk.read_bytes(), head["dtype"]).reshape(head["shape"])
        assert (values == array).all() and head["compressor"] is None
    assert json.loads((block / "s.zarr/.zattrs").read_text()) == json.loads(
        (block / "s.json").read_text()
    )
    with tarfile.open(block / "a.b.tar") as tar:
        names = tar.getnames()
        assert {n.split(".", 1)[0] for n in names} == {"a_b"}
        for name, array in data.items():
            member = tar.extractfile(f"a_b.{name}.npy")
            assert member is not None
            (block / "member.npy").write_bytes(member.read())
            assert (np.load(block / "member.npy") == array).all()
    assert not list(block.glob(".*"))


def test_seeds(run: Run, block: Path) -> None:
    for name, seed, threads in (("a", 1, 1), ("b", 1, 2), ("c", 2, 1)):
        options = ("--seed", seed, "--threads", threads)
        run("samples", "block.obj", *FEW, *options, "-o", f"{name}.npz")
    a, b, c = ((block / f"{name}.npz").read_bytes() for name in "abc")
    assert a == b != c


def test_holes_are_closed_and_what_has_no_inside_is_refused(run: Run, block: Path) -> None:
    lid_off = "".join(
        line for line in (block / "block.obj").read_text().splitlines(True) if "8 6" not in line
    )
    (block / "open.obj").write_text(lid_off)
    run("samples", "open.obj", *FEW, "-o", "open.npz")
    card = json.loads((block / "open.json").read_text())
    assert card["report"]["sizes"]["surface open edges"] == 0
    assert arrays(block / "open.npz")["confidence"].min() < 0.9
    (block / "square.obj").write_text(square(4))
    failed = run("samples", "square.obj", *FEW, "-o", "s.npz", status=2)
    assert "encloses no node of the grid" in failed.stderr
    assert not (block / "s.npz").exists()


@pytest.mark.parametrize(
    "arguments, said",
    [
        (("-o", "s.txt"), "they are written to .npz .zarr .tar"),
        (("-o", "nowhere/s.npz"), "there is no folder nowhere"),
        (
            ("--uniform", "0.8", "--curvature", "0.8", "-o", "s.npz"),
            "at most 1 for uniform and curvature together",
        ),
        (("--scales", "0", "-o", "s.npz"), "--scales"),
        (("--numbers", "float8", "-o", "s.npz"), "'float8' is none of"),
        (("--method", "signed-heat", "-o", "s.npz"), "signed-heat"),
    ],
)
def test_what_is_refused(run: Run, block: Path, arguments: tuple[str, ...], said: str) -> None:
    status = 1 if "nowhere/s.npz" in arguments else 2
    assert said in run("samples", "block.obj", *arguments, status=status).stderr
    assert [p.name for p in block.iterdir()] == ["block.obj"]
