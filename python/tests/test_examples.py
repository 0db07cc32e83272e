"""The programs in examples/python run."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np

EXAMPLES = Path(__file__).parents[2] / "examples"


def run(name: str, *arguments: str | Path) -> str:
    command = [sys.executable, EXAMPLES / "python" / name, *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def test_curve_offsets():
    data = EXAMPLES / "data"
    said = run("curve_offsets.py", data / "spot.obj", data / "spot-jersey.txt", "-0.1", "0.1")
    assert "at distance -0.1: " in said and "sure at" in said


def test_samples(tmp_path):
    out = tmp_path / "samples.npz"
    run("samples.py", EXAMPLES / "data/spot.obj", "1000", out)
    samples = np.load(out)
    assert samples["sdf"].shape == (1000,) and samples["sdf"].dtype == np.float32
    assert 0.2 < (samples["sdf"] < 0).mean() < 0.8
