"""The cells of the tutorial run, in order."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]


def test_the_tutorial_runs(monkeypatch, tmp_path, capsys):
    matplotlib = pytest.importorskip("matplotlib")
    pytest.importorskip("scipy")
    matplotlib.use("Agg")
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.chdir(ROOT)
    notebook = json.loads(Path("docs/tutorials/tutorial.ipynb").read_text(encoding="utf-8"))
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in cells)
    names: dict = {}
    for number, cell in enumerate(cells):
        exec(compile("".join(cell["source"]), f"cell {number} of the tutorial", "exec"), names)
    matplotlib.pyplot.close("all")
    assert len(opened) == 1 and opened[0].startswith("file:")
    assert names["signed"].values.min() < 0 < names["signed"].values.max()
    assert set(names["regions"].region) == {0, 1}
    assert names["sdf"](names["x"])[0] < 0 < names["sdf"](names["x"])[1]
    top = names["mesh"].points[:, 1].argmax()  # of the head, there without the hindquarters
    assert top in names["mesh"].faces[names["kept"]]
    sure = names["cut"].confidence(names["along"])
    assert sure[2] < 0.1 < 0.5 < min(sure[0], sure[1], sure[3])
    assert np.ptp(names["thin"].points, axis=0).max() < np.ptp(names["thick"].points, axis=0).max()
    assert "normals" in capsys.readouterr().out  # the cloud's warning
