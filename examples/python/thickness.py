"""A map of the thickness of a solid of tets: at each vertex the diameter of the largest ball that
lies inside the solid and holds the vertex.

usage: thickness.py TETS.mesh|.vtk|.tet OUTPUT.npy

Balls are centred at vertices; the distance from the boundary is their radius.
"""

import sys

import numpy as np

import littoral


def main() -> None:
    tets = littoral.read_tets(sys.argv[1])
    depth = littoral.tet_distance(tets, boundary=True, method="belyaev-fayolle").values
    radius = np.zeros(len(depth))
    for centre in np.argsort(depth):  # larger balls later: they win where balls overlap
        away = np.linalg.norm(tets.points - tets.points[centre], axis=1)
        radius[away <= depth[centre]] = depth[centre]
    np.save(sys.argv[2], 2 * radius)
    thin, half = np.quantile(2 * radius, [0.05, 0.5])
    print(f"thickest {2 * radius.max():.4f}, median {half:.4f}")
    print(f"one vertex in twenty lies where it is below {thin:.4f}")


if __name__ == "__main__":
    main()
