"""Geodesic clusters of a mesh: each vertex goes to the nearest of K centres along the surface.

usage: clusters.py MESH K OUTPUT.npy

Centres are chosen one after the other, each where all others are farthest, and then moved to the
middle of their cluster.
"""

import sys

import numpy as np

import littoral


def main() -> None:
    mesh = littoral.read(sys.argv[1])
    solver = littoral.DistanceSolver(mesh, method="unsigned-heat")

    rows = [solver.solve(points=0).values]
    centres = [0]
    while len(centres) < int(sys.argv[2]):
        centres.append(int(np.min(rows, axis=0).argmax()))
        rows.append(solver.solve(points=centres[-1]).values)
    labels = np.argmin(rows, axis=0)

    for k in range(len(centres)):
        members = np.flatnonzero(labels == k)
        some = members[:: max(1, len(members) // 20)]
        D = littoral.distance_matrix(mesh, some, members, method="unsigned-heat")
        centres[k] = int(some[D.sum(axis=1).argmin()])
    rows = [solver.solve(points=centre).values for centre in centres]
    labels = np.argmin(rows, axis=0)
    np.save(sys.argv[3], labels)
    print("centres", centres, "sizes", np.bincount(labels).tolist())
    print(f"farthest from its centre: {np.min(rows, axis=0).max():.4f}")


if __name__ == "__main__":
    main()
