"""Curves for studies from Python: nodal lines of low eigenfunctions, whole and damaged.

As bench/studies/curves.h makes them. Needs the package littoral and scipy.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import diags
from scipy.sparse.linalg import eigsh

import littoral

Floats = NDArray[np.float64]
Lines = list[Floats]


def nodal_lines(mesh: littoral.Surface, count: int) -> list[Lines]:
    """Where the first `count` eigenfunctions after the constant vanish: closed lines in space."""
    ops = littoral.operators(mesh)
    start = np.random.default_rng(7).normal(size=mesh.n_vertices)
    _, functions = eigsh(ops.L, count + 1, diags(ops.M), sigma=-1e-3 / ops.M.sum(), v0=start)
    return [littoral.isolines(mesh, functions[:, k]) for k in range(1, count + 1)]


def is_closed(line: Floats) -> bool:
    return len(line) > 3 and bool((line[0] == line[-1]).all())


def damaged(lines: Lines, drop: float, reverse: float, seed: int) -> Lines:
    """Cut into runs of 4 to 12 segments, a share of them dropped, another reversed."""
    random = np.random.default_rng(seed)
    runs = []
    for line in lines:
        i = 0
        while i + 1 < len(line):
            end = min(len(line) - 1, i + int(random.integers(4, 13)))
            dropped, turned = random.random() < drop, random.random() < reverse
            if not dropped:
                run = line[i : end + 1]
                runs.append(run[::-1] if turned else run)
            i = end
    return runs or [lines[0]]


def mean_error(values: Floats, truth: Floats, mass: Floats) -> float:
    """Mean over the area of |difference|, in % of the range of the truth."""
    return float(100 * mass @ abs(values - truth) / mass.sum() / np.ptp(truth))


def wrong_side(values: Floats, truth: Floats, mass: Floats) -> float:
    """The share of the area whose sign is wrong [%]."""
    return float(100 * mass[values * truth < 0].sum() / mass.sum())
