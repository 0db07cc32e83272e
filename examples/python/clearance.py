"""The clearance between two parts: how near they come, where, and whether they overlap.

usage: clearance.py PART PART
"""

import sys

import littoral


def main() -> None:
    parts = [littoral.read(path) for path in sys.argv[1:3]]
    best = None
    for one, other in (parts, parts[::-1]):
        sdf = littoral.SDF(other)
        distance = sdf(one.points)
        nearest = int(distance.argmin())
        if best is None or distance[nearest] < best[0]:
            here = one.points[nearest]
            best = float(distance[nearest]), here, sdf.closest(here).point
    assert best is not None
    least, here, there = best
    print(f"{'clearance' if least > 0 else 'overlap'} {abs(least):.4f}, from {here} to {there}")


if __name__ == "__main__":
    main()
