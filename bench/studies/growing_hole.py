"""A hole that grows in a sphere: signed distance in space (thesis, figure 7.5).

usage: growing_hole.py    needs littoral; prints a Markdown table

All faces of a sphere of radius 1 (20,480 triangles) within an angle of the pole are cut out. Mean
error in % of the radius, and the share of wrong signs in %, on 32^3 nodes over [-1.5, 1.5]^3.
"""

import numpy as np

import littoral

ANGLES = (0, 10, 20, 30, 45, 60, 75, 90)
METHODS = ("auto", "winding", "signed-heat")


def main() -> None:
    sphere = littoral.examples.sphere(5)
    middle = sphere.points[sphere.faces].mean(axis=1)
    angle = np.degrees(np.arccos(middle[:, 2] / np.linalg.norm(middle, axis=1)))
    a = np.linspace(-1.5, 1.5, 32)
    nodes = np.stack(np.meshgrid(a, a, a, indexing="ij"), -1).reshape(-1, 3)
    truth = np.linalg.norm(nodes, axis=1) - 1
    print("| hole: half angle [°] | area missing [%] | " + " | ".join(METHODS) + " |")
    print("|---" * (2 + len(METHODS)) + "|")
    for limit in ANGLES:
        open_sphere = littoral.Mesh(sphere.points, sphere.faces[angle >= limit])
        cells = []
        for method in METHODS:
            if method == "signed-heat":
                volume = littoral.signed_heat_grid(
                    open_sphere, bounds=[-1.5] * 3 + [1.5] * 3, spacing=3 / 31
                )
                values = np.asarray(volume.values)
                at = volume.origin[0] + volume.spacing[0] * np.arange(values.shape[0])
                assert np.allclose(at, a)
                values = values.reshape(-1)
            else:
                values = littoral.SDF(open_sphere, method=method)(nodes)
            wrong = 100 * (values * truth < 0).mean()
            cells.append(f"{100 * abs(values - truth).mean():.2f} / {wrong:.2f}")
        missing = 100 * (1 - np.cos(np.radians(limit))) / 2
        print(f"| {limit} | {missing:.1f} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
