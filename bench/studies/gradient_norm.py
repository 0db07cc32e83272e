"""The norm of the gradient of regularized distance (its paper, figures 2 to 10).

usage: gradient_norm.py MESH VERTEX    needs littoral and scipy; prints Markdown

Where the constraint |grad u| <= 1 holds with equality the answer is a distance; elsewhere
smoothness has won. One gradient a face, shares by area.
"""

import sys

import numpy as np

import littoral


def main(path: str, vertex: int) -> None:
    mesh = littoral.read(path)
    ops = littoral.operators(mesh)
    print("| alpha | mean norm | below 0.95 [% of the area] | below 0.5 | largest |")
    print("|---" * 5 + "|")
    for alpha in (0, 0.02, 0.05, 0.1, 0.2):
        field = littoral.distance(
            mesh, points=vertex, method="regularized", alpha=alpha, tolerance=1e-4
        )
        norm = np.linalg.norm((ops.G @ field.values).reshape(-1, 3), axis=1)
        share = [100 * ops.A[norm < limit].sum() / ops.A.sum() for limit in (0.95, 0.5)]
        mean = ops.A @ norm / ops.A.sum()
        print(
            f"| {alpha} | {mean:.3f} | {share[0]:.1f} | {share[1]:.1f} | {norm.max():.3f} |",
            flush=True,
        )


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
