"""A closed shell around a broken scan, for a 3D printer, without repairing the scan.

usage: print_shell.py SCAN DISTANCE OUTPUT.stl
"""

import sys

import numpy as np

import littoral


def main() -> None:
    scan = littoral.read(sys.argv[1])
    distance = float(sys.argv[2])
    sdf = littoral.SDF(scan)
    for warning in sdf.warnings:
        print("warning:", warning)
    (shell,) = littoral.offset(sdf, distance, resolution=64)
    shell.save(sys.argv[3])

    corners = np.asarray(shell.faces)
    sides = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    faces_at = np.unique(np.sort(sides, axis=1), axis=0, return_counts=True)[1]
    away = np.median(sdf.closest(shell.points).distance)
    sizes = sdf.report.sizes
    print(
        f"{sizes['free edges']:.0f} free edges of the scan, {sizes['patch triangles']:.0f} patched"
    )
    print(f"{shell.n_faces} triangles, closed: {bool((faces_at == 2).all())}, {away:.4f} away")


if __name__ == "__main__":
    main()
