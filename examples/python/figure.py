"""A standing figure of rounded limbs, for examples that need a body: no scan can be shipped freely.

usage: figure.py OUTPUT.ply

Each limb is a capsule [metres]; where two meet, the corner is filled by a fillet of 3 cm.
"""

import sys

import numpy as np
from numpy.typing import NDArray

import littoral

Array = NDArray[np.float64]

LIMBS = [  # ends and radius; those with x > 0 have a mirror image
    ((0, 0, 1.62), (0, 0, 1.68), 0.1),  # head
    ((0, 0, 1.4), (0, 0, 1.6), 0.055),
    ((0, 0, 1.0), (0, 0, 1.33), 0.14),  # trunk
    ((0.1, 0, 1.38), (0.2, 0, 1.38), 0.06),
    ((0.2, 0, 1.38), (0.45, 0, 1.18), 0.045),
    ((0.45, 0, 1.18), (0.66, -0.06, 1.0), 0.038),
    ((0.66, -0.06, 1.0), (0.74, -0.08, 0.93), 0.045),  # hand
    ((0.09, 0, 0.95), (0.13, 0, 0.5), 0.075),
    ((0.13, 0, 0.5), (0.15, 0.02, 0.08), 0.055),
    ((0.15, 0.02, 0.06), (0.17, -0.14, 0.05), 0.05),  # foot
]
FILLET = 0.03


def to_capsule(x: Array, a: Array, b: Array, radius: float) -> Array:
    along = np.clip((x - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
    nearest = a + along[..., None] * (b - a)
    return np.asarray(np.linalg.norm(x - nearest, axis=-1) - radius)


def blended(p: Array, q: Array) -> Array:
    """The smaller of two distances, rounded where they are about the same."""
    meet = np.maximum(FILLET - np.abs(p - q), 0) / FILLET
    return np.asarray(np.minimum(p, q) - meet**2 * FILLET / 4)


def main() -> None:
    spacing, origin, shape = 0.015, (-0.84, -0.3, -0.06), (113, 40, 128)
    x = np.array(origin) + spacing * np.moveaxis(np.indices(shape), 0, -1)
    body: Array = np.full(shape, np.inf)
    for a, b, radius in LIMBS:
        for side in (1, -1) if a[0] > 0 else (1,):
            mirror = np.array([side, 1, 1])
            body = blended(body, to_capsule(x, mirror * a, mirror * b, radius))
    mesh = littoral.Volume(body, spacing=spacing, origin=origin).isosurface()
    mesh.save(sys.argv[1])
    print(mesh)


if __name__ == "__main__":
    main()
