"""Signed distance samples of a shape for training a network, and what to leave out.

usage: samples.py SHAPE COUNT OUTPUT.npz

The shape may have holes. Samples whose side is in doubt are left out: a network that learns wrong
signs learns wrong surfaces.
"""

import sys

import numpy as np

import littoral


def main() -> None:
    shape = littoral.read(sys.argv[1])
    made = littoral.samples(shape, surface=0, space=int(sys.argv[2]), seed=0)
    sure = made.confidence > 0.5
    np.savez(
        sys.argv[3],
        points=made.points[sure],  # in the cube from -1 to 1
        sdf=made.distances[sure],
        centre=made.centre,
        half_side=made.half_side,
    )
    inside = 100 * (made.distances[sure] < 0).mean()
    print(f"{sure.sum()} of {len(sure)} samples are sure, {inside:.0f} % of them inside")


if __name__ == "__main__":
    main()
