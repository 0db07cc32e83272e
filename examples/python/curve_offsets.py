"""Offset curves of a broken curve on a mesh.

usage: curve_offsets.py MESH CURVES DISTANCE...
"""

import sys

import numpy as np

import littoral


def main() -> None:
    mesh = littoral.read(sys.argv[1])
    curves = littoral.read_sources(sys.argv[2], mesh)
    field = littoral.distance(mesh, curves, confidence=True)
    for warning in field.warnings:
        print("warning:", warning)
    for level in map(float, sys.argv[3:]):
        lines = field.isolines(level)
        length = sum(np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in lines)
        print(f"at distance {level:g}: {len(lines)} lines, {length:.4f} long")
    print(f"the sign is sure at {100 * (field.confidence > 0.5).mean():.0f} % of the vertices")


if __name__ == "__main__":
    main()
