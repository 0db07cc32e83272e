"""The clearance between two parts: how near they come, where, and whether they overlap.

usage: clearance.py PART PART [SPACING]    parts are triangle meshes

Distances are taken at points of each part at most SPACING apart (one part in 100 of the larger
part's size if left out): the answer is at most that much too large.
"""

import sys
from typing import Any

import numpy as np

import littoral


def spread(part: littoral.Surface, spacing: float) -> Any:
    """Points on all triangles of a part, its vertices among them, at most `spacing` apart."""
    corners = part.points[part.faces]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    pieces = np.maximum(1, np.ceil(longest / spacing)).astype(int)
    points = []
    for n in np.unique(pieces):
        i, j = (a.ravel() for a in np.meshgrid(np.arange(n + 1), np.arange(n + 1)))
        weights = np.stack([i, j, n - i - j], 1)[i + j <= n] / n
        points.append(np.einsum("pk,fkd->fpd", weights, corners[pieces == n]).reshape(-1, 3))
    return np.unique(np.concatenate(points), axis=0)


def main() -> None:
    parts = [littoral.read(path) for path in sys.argv[1:3]]
    size = max(float(np.ptp(part.points, axis=0).max()) for part in parts)
    spacing = float(sys.argv[3]) if len(sys.argv) > 3 else size / 100
    best = None
    for one, other in (parts, parts[::-1]):
        sdf = littoral.SDF(other)
        points = spread(one, spacing)
        distance = sdf(points)
        nearest = int(distance.argmin())
        if best is None or distance[nearest] < best[0]:
            here = points[nearest]
            best = float(distance[nearest]), here, sdf.closest(here).point
    assert best is not None
    least, here, there = best
    print(f"{'clearance' if least > 0 else 'overlap'} {abs(least):.4f}, from {here} to {there}")


if __name__ == "__main__":
    main()
