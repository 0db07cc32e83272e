"""The thickness of a solid of tets: twice the distance from the boundary, where that is greatest.

usage: thickness.py TETS.mesh|.vtk|.tet OUTPUT.npy
"""

import sys

import numpy as np

import littoral


def main() -> None:
    tets = littoral.read_tets(sys.argv[1])
    depth = littoral.tet_distance(tets, boundary=True).values
    neighbours = np.concatenate(
        [tets.tets[:, [i, j]] for i in range(4) for j in range(4) if i != j]
    )
    highest = depth.copy()
    np.maximum.at(highest, neighbours[:, 0], depth[neighbours[:, 1]])
    middle = (depth >= highest) & (depth > 0)  # no neighbour is deeper
    np.save(sys.argv[2], 2 * depth)
    print(f"thickest {2 * depth.max():.4f}; {middle.sum()} vertices of the medial axis,")
    print(f"where it is between {2 * depth[middle].min():.4f} and {2 * depth[middle].max():.4f}")


if __name__ == "__main__":
    main()
