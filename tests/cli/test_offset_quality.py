"""littoral offset: how far its surfaces are from what they were made around."""

import json
from pathlib import Path

import pytest
from conftest import CUBE, Run


def test_offset_of_an_open_box_is_closed_and_measured(run: Run, tmp_path: Path) -> None:
    lines = CUBE.splitlines()
    (tmp_path / "cube.obj").write_text(CUBE)
    (tmp_path / "open.obj").write_text("\n".join(lines[:-1]) + "\n")
    arguments = ("--distance", "0.3", "--resolution", 32, "--json", "-o", "a.ply")
    report = json.loads(run("offset", "open.obj", *arguments).stdout)
    assert report["status"] == "converged"
    sizes = report["sizes"]
    assert sizes["offset 0.3: open edges"] == 0
    assert sizes["offset 0.3: median distance"] == pytest.approx(0.3, abs=0.003)
    assert 0.08 < sizes["offset 0.3: share over holes"] < 0.2
    for part in ("", "over holes, "):
        for which in ("least", "median", "greatest"):
            assert sizes[f"offset 0.3: {part}{which} over asked"] == pytest.approx(1, abs=0.02)
    info = json.loads(run("info", "a.ply", "--json").stdout)
    assert (info["components"], info["boundary_edges"], info["nonmanifold_edges"]) == (1, 0, 0)
    result = run("offset", "open.obj", "--method", "signed-heat", *arguments)
    assert "more than a tenth off" in result.stderr or "is open" in result.stderr
    # A hundredth of the size is less than half a cell: without the distance itself along the edges
    # of the grid, vertices beside creases would be up to twice as far as asked.
    for distance in ("2%", "-2%"):
        thin = run("offset", "open.obj", f"--distance={distance}", "--json", "-o", "a.ply")
        found = json.loads(thin.stdout)["sizes"]
        for key, ratio in found.items():
            if key.endswith("over asked"):
                assert ratio == pytest.approx(1, abs=0.05), key
    volume = run("offset", "cube.obj", "--method", "signed-heat", "--distance=2%", "--json",
                 "-o", "a.ply")  # fmt: skip
    assert "as asked at (" in volume.stderr
