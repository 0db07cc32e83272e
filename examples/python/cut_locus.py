"""Points of the cut locus: where shortest paths from a source meet, and distance has a ridge.

usage: cut_locus.py MESH SOURCE_VERTEX OUTPUT.ply

The gradient of exact distance has length 1. Averaged over the faces of a vertex it gets shorter
where neighbouring faces disagree.
"""

import sys

import numpy as np

import littoral


def main() -> None:
    mesh = littoral.read(sys.argv[1])
    source = int(sys.argv[2])
    distance = littoral.distance(mesh, points=source, method="exact").values
    ops = littoral.operators(mesh)
    gradient = (ops.G @ distance).reshape(-1, 3)

    mean = np.zeros((mesh.n_vertices, 3))
    area = np.zeros(mesh.n_vertices)
    for corner in np.asarray(mesh.faces).T:
        np.add.at(mean, corner, ops.A[:, None] * gradient)
        np.add.at(area, corner, ops.A)
    length = np.linalg.norm(mean, axis=1) / area
    ridge = (length < 0.8) & (distance > 0.1 * distance.max())
    littoral.PointCloud(mesh.points[ridge]).save(sys.argv[3])
    print(f"{ridge.sum()} of {mesh.n_vertices} vertices, {distance[ridge].min():.3f} and more away")


if __name__ == "__main__":
    main()
