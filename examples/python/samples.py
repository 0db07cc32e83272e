"""Signed distance samples near a shape, as those who train networks on them want them.

usage: samples.py SHAPE COUNT OUTPUT.npz
"""

import sys

import numpy as np

import littoral


def main() -> None:
    shape = littoral.read(sys.argv[1])
    count = int(sys.argv[2])
    sdf = littoral.SDF(shape)
    low, high = sdf.bounds
    rng = np.random.default_rng(0)
    near = shape.points[rng.integers(shape.n_vertices, size=count // 2)]
    near = near + rng.normal(scale=0.01 * np.linalg.norm(high - low), size=near.shape)
    anywhere = rng.uniform(low, high, (count - len(near), 3))
    x = np.concatenate([near, anywhere]).astype(np.float32)
    values, sure = sdf(x), sdf.confidence(x)
    np.savez(sys.argv[3], points=x, sdf=values, confidence=sure)
    inside = 100 * (values < 0).mean()
    print(f"{count} samples, {inside:.0f} % inside, sure of {100 * sure.mean():.0f} %")


if __name__ == "__main__":
    main()
