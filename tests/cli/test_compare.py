"""littoral compare: closed forms."""

import json
from pathlib import Path

import pytest
from conftest import Run, square


def test_two_squares(run: Run, mesh: Path) -> None:
    """The unit square, and a part of it: x < 0.5, lifted by 0.1."""
    rows = [
        " ".join(["v", str(float(r.split()[1]) / 2), r.split()[2], "0.1"]) if r[:2] == "v " else r
        for r in square(10).splitlines()
    ]
    (mesh.parent / "half.obj").write_text("\n".join(rows) + "\n")
    words = ("compare", "square.obj", "half.obj", "--samples", 20000)
    report = json.loads(run(*words, "--json", "-o", "d.ply").stdout)
    sizes = report["sizes"]
    far = (0.5**2 + 0.1**2) ** 0.5
    assert sizes["hausdorff"] == pytest.approx(far)
    assert sizes["A to B: largest"] == pytest.approx(far)
    assert sizes["B to A: largest"] == pytest.approx(0.1)
    assert sizes["B to A: mean"] == pytest.approx(0.1)
    # half of the area at 0.1, the rest at sqrt(t^2 + 0.01), t even in [0, 0.5]
    assert sizes["A to B: rms"] == pytest.approx((0.01 + 0.5 * 0.25 / 3) ** 0.5, rel=1e-3)
    assert sizes["A to B: median"] == pytest.approx(0.1, abs=1e-3)
    assert report["values"]["distance"]["max"] == pytest.approx(far)
    assert f"hausdorff: {sizes['hausdorff']:.3f}"[:14] in run(*words).stdout


def test_nothing_to_compare(run: Run, mesh: Path) -> None:
    (mesh.parent / "flat.obj").write_text("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
    assert "no area" in run("compare", "flat.obj", "square.obj", status=2).stderr
    run("compare", "square.obj", status=2)
