"""An input and a call for each code of a warning."""

import itertools
from pathlib import Path

import numpy as np
from conftest import square
from provoking import GRID, MADE, Words, cube, mask, obj, provokes, simple, sphere_cloud, strip

simple("sheets-thickened", "repair", "square.obj", *GRID[:1], "-o", "b.obj")
simple("curve-leaps", "distance", "square.obj", "--curve-vertices=0,1,2,3,4,120", "-o", "a.txt")
simple("source-moved", "distance", "square.obj", "--at=0,0,9", "-o", "a.txt")
simple(
    "sign-ignored", "distance", "square.obj", "--curve-vertices=5,16", "--method=exact", "-o=a.txt"
)
simple("nothing-enclosed", "sdf", "square.obj", *GRID)


@provokes("level-missed")
def _(folder: Path) -> Words:
    mask(folder)
    return ["contour", "d.npz", "--level=0,9.5", "-o", "b.obj"]


@provokes("decimal-comma")
def _(folder: Path) -> Words:
    mask(folder)
    return ["contour", "d.npz", "--level=0,5", "-o", "b.obj"]


@provokes("grid-unplaced")
def _(folder: Path) -> Words:
    mask(folder)
    return ["sdf", "m.npy", *GRID]


@provokes("open-surface")
def _(folder: Path) -> Words:
    values = np.indices((5, 5, 5))[0] - 2.5
    np.savez(folder / "d.npz", values=values, origin=[0] * 3, spacing=1)
    return ["contour", "d.npz", "--level=0", "-o", "b.obj"]


@provokes("wall-thin")
def _(folder: Path) -> Words:
    mask(folder)
    return ["offset", "d.npz", "--as=distance", "--shell=0.01", "-o", "b.obj"]


@provokes("component-unreached")
def _(folder: Path) -> Words:
    return ["distance", MADE["no-path"](folder)[1], "--vertex=0", "-o", "a.txt"]


@provokes("curve-split")
def _(folder: Path) -> Words:
    MADE["no-path"](folder)
    ends = ((0.2, 0.2, 1), (0.8, 0.8, 1), (3.2, 3.2, 3), (3.8, 3.8, 3))
    points = ", ".join(f"[{x}, {y}, {z}]" for x, y, z in ends)
    (folder / "s.json").write_text(f'{{"curves": [{{"points": [{points}]}}]}}')
    return ["distance", "a.obj", "-s", "s.json", "-o", "a.txt"]


@provokes("isolated-vertices")
def _(folder: Path) -> Words:
    points, faces = cube()
    obj(folder, np.vstack([points, [(5, 5, 5)]]), faces)
    return ["distance", "a.obj", "--vertex=0", "-o", "a.txt"]


@provokes("degenerate-faces")
def _(folder: Path) -> Words:
    points, faces = cube()
    obj(folder, points, [*faces, (0, 1, 1)])
    return ["distance", "a.obj", "--vertex=0", "-o", "a.txt"]


@provokes("nonmanifold-edges")
def _(folder: Path) -> Words:
    points, faces = cube()
    obj(folder, np.vstack([points, [(0.5, -1, 0)]]), [*faces, (0, 1, 8)])
    return ["winding", "a.obj", "--curve-vertices=2,3,7,6,2", "-o", "a.csv"]


@provokes("flipped-faces")
def _(folder: Path) -> Words:
    points, faces = cube()
    obj(folder, points, [faces[0][::-1], *faces[1:]])
    return ["distance", "a.obj", "--curve-vertices=0,1", "-o", "a.txt"]


@provokes("not-orientable")
def _(folder: Path) -> Words:
    obj(folder, *strip(24, 1))
    return ["distance", "a.obj", "--curve-vertices=0,2,4,6", "-o", "a.txt"]


@provokes("polygons-cut")
def _(folder: Path) -> Words:
    points, _ = cube()
    obj(folder, points, [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3)])
    words = ("--curve-vertices=0,1", "--method=signed-heat", "--intrinsic-delaunay")
    return ["distance", "a.obj", *words, "-o", "a.txt"]


@provokes("normals-cancel")
def _(folder: Path) -> Words:
    curves = ("--curve-vertices=5,16,27", "--curve-vertices=27,16,5")
    return ["distance", "square.obj", *curves, "--method=signed-heat", "-o", "a.txt"]


@provokes("source-shadowed")
def _(folder: Path) -> Words:
    (folder / "s.json").write_text('{"points": [{"v": 0, "value": 0}, {"v": 1, "value": 9}]}')
    return ["distance", "square.obj", "-s", "s.json", "-o", "a.txt"]


@provokes("completion-guessed")
def _(folder: Path) -> Words:
    return ["distance", "square.obj", "--curve-vertices=60,61", "-o", "a.txt"]


@provokes("pieces-left-out")
def _(folder: Path) -> Words:
    words = (
        "--curve-vertices=5,16,27",
        "--vertex=0",
        "--method=signed-heat",
        "--constraint=zero-set",
    )
    (folder / "s.txt").write_text("signed_curve\nv 5\nv 5\nv 16\n")
    return ["distance", "square.obj", "-s", "s.txt", *words[:1], "-o", "a.txt"]


@provokes("orientation-reversed")
def _(folder: Path) -> Words:
    points, faces = cube()
    obj(folder, points, [face[::-1] for face in faces])
    return ["sdf", "a.obj", *GRID]


@provokes("orientation-mixed")
def _(folder: Path) -> Words:
    points, faces = cube()
    obj(folder, points, [f[::-1] if i % 3 == 0 else f for i, f in enumerate(faces)])
    return ["sdf", "a.obj", *GRID]


@provokes("sheets")
def _(folder: Path) -> Words:
    (p, f), extra = cube(), np.array([(2, 0, 0), (3, 0, 0), (3, 1, 0), (2, 1, 0)])
    obj(folder, np.vstack([p, extra]), [*f, (8, 9, 10), (8, 10, 11)])
    return ["sdf", "a.obj", *GRID]


@provokes("walls-inside")
def _(folder: Path) -> Words:
    (p, f), (q, g) = cube(), cube(0.5, 0.25)
    obj(folder, np.vstack([p, q]), f + [tuple(v + 8 for v in face) for face in g])
    return ["sdf", "a.obj", *GRID]


@provokes("thin-parts")
def _(folder: Path) -> Words:
    points, faces = cube()
    obj(folder, points * np.array([1, 1, 0.02]), faces)
    return ["sdf", "a.obj", "--bounds=-.1,-.1,-.13,1.1,1.1,1.07", *GRID]


@provokes("accuracy-missed")
def _(folder: Path) -> Words:
    obj(folder, *cube())
    return [
        "offset",
        "a.obj",
        "--distance=0.2",
        "--method=signed-heat",
        "--resolution=8",
        "-o=b.obj",
    ]


@provokes("parts-lost")
def _(folder: Path) -> Words:
    MADE["sheets"](folder)
    return ["repair", "a.obj", *GRID[:1], "-o", "b.obj"]


@provokes("points-coincide")
def _(folder: Path) -> Words:
    np.savetxt(folder / "c.xyz", np.vstack([sphere_cloud(), sphere_cloud()[:9]]))
    return ["sdf", "c.xyz", *GRID]


@provokes("normals-unusable")
def _(folder: Path) -> Words:
    cloud = sphere_cloud()
    cloud[7, 3:] = 0
    np.savetxt(folder / "c.xyz", cloud)
    return ["sdf", "c.xyz", *GRID]


@provokes("normals-estimated")
def _(folder: Path) -> Words:
    np.savetxt(folder / "c.xyz", sphere_cloud()[:, :3])
    return ["distance", "c.xyz", "--vertex=0", "-o", "a.txt"]


@provokes("points-not-enclosing")
def _(folder: Path) -> Words:
    cloud = sphere_cloud(1000)
    np.savetxt(folder / "c.xyz", cloud[cloud[:, 2] > 0.2])
    return ["sdf", "c.xyz", *GRID]


@provokes("outliers")
def _(folder: Path) -> Words:
    rng = np.random.default_rng(1)
    far = np.hstack([rng.uniform(-3, 3, (40, 3)), np.tile([0, 0, 1.0], (40, 1))])
    np.savetxt(folder / "c.xyz", np.vstack([sphere_cloud(1000), far]))
    return ["sdf", "c.xyz", "--method=tori", "--drop-outliers", *GRID]


@provokes("box-misses-input")
def _(folder: Path) -> Words:
    obj(folder, *cube())
    return ["sdf", "a.obj", "--method=signed-heat", "--bounds=.4,.4,.4,.6,.6,.6", *GRID]


@provokes("samples-outside")
def _(folder: Path) -> Words:
    obj(folder, *cube())
    words = ("--domain=tets", "--method=signed-heat", "--bounds=.5,.5,.5,2,2,2")
    return ["sdf", "a.obj", *words, *GRID]


@provokes("nonbounding-kept")
def _(folder: Path) -> Words:
    obj(folder, *strip(24, 0))
    ring = ",".join(str(2 * i % 48) for i in range(25))
    words = ("--formulation=nonconforming", "--curve-vertices", ring)
    return ["winding", "a.obj", *words, "-o", "a.csv"]


@provokes("gradient-off-unit")
def _(folder: Path) -> Words:
    return [
        "distance",
        "square.obj",
        "--vertex=0",
        "--method=unsigned-heat",
        "--time-scale=1e-4",
        "-o=a.txt",
    ]


@provokes("far-from-marching")
def _(folder: Path) -> Words:
    n = 30
    x = [(i, 0.01 * i * i * (k - 0.5), 0) for i in range(n) for k in (0, 1)]
    faces = [
        f
        for i in range(n - 1)
        for f in ((2 * i, 2 * i + 2, 2 * i + 1), (2 * i + 1, 2 * i + 2, 2 * i + 3))
    ]
    obj(folder, np.array(x) * (1, 20, 1), faces)
    return ["distance", "a.obj", "--vertex=2", "--method=unsigned-heat", "-o", "a.txt"]


@provokes("not-converged")
def _(folder: Path) -> Words:
    words = ("--method=regularized", "--max-iterations=1")
    return ["distance", "square.obj", "--vertex=0", *words, "-o", "a.txt"]


@provokes("option-without-effect")
def _(folder: Path) -> Words:
    (folder / "s.obj").write_text(square(10) + "l 1 2 3\n")
    return ["distance", "square.obj", "-s", "s.obj", "--index-base=1", "-o", "a.txt"]


@provokes("far-from-exact")
def _(folder: Path) -> Words:
    return ["pairs", "square.obj", "--method=symmetric", "--alpha=1", "-o", "a.npy"]


@provokes("curvature-raised")
def _(folder: Path) -> Words:
    side = range(15)
    places = [(i / 7 - 1, j / 7 - 1) for j in side for i in side]
    lines = [f"v {x} {y} {1.5 * (x * x - y * y)}" for x, y in places]
    for a in (15 * j + i + 1 for j in side[:-1] for i in side[:-1]):
        lines += [f"f {a} {a + 1} {a + 16}", f"f {a} {a + 16} {a + 15}"]
    (folder / "saddle.obj").write_text("\n".join(lines))
    method = ["--method", "regularized", "--regularizer", "hessian", "--alpha", 1]
    return ["distance", folder / "saddle.obj", "--vertex", 0, *method, "-o", folder / "out.csv"]


@provokes("direction-missing")
def _(folder: Path) -> Words:
    rows = ["1 0 0\n"] * 200
    rows[7] = "0 0 0\n"
    (folder / "f.txt").write_text("".join(rows))
    words = ("--method=regularized", "--regularizer=align", "--field=f.txt")
    return ["distance", "square.obj", "--vertex=0", *words, "-o", "a.txt"]


@provokes("sources-outside")
def _(folder: Path) -> Words:
    head = "MeshVersionFormatted 1\nDimension 3\nVertices\n5\n"
    points = "0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n5 5 5 0\n"
    (folder / "t.mesh").write_text(head + points + "Tetrahedra\n1\n1 2 3 4 0\nEnd\n")
    return ["distance", "t.mesh", "--vertex=0,4", "-o", "a.txt"]


@provokes("tets-folded")
def _(folder: Path) -> Words:
    # An L of cubes in six tets each; one vertex inside is moved through a neighbouring cube.
    n = 4
    at = np.array(list(itertools.product(range(n + 1), repeat=3)), float)
    tets = []
    for corner in itertools.product(range(n), repeat=3):
        if min(corner[:2]) < n // 2:
            for order in itertools.permutations(range(3)):
                ways = np.cumsum([corner, *np.eye(3, dtype=int)[list(order)]], axis=0)
                tets.append(ways @ ((n + 1) ** 2, n + 1, 1) + 1)
    at[31] += (1.4, 0, 0)  # 1, 1, 1
    rows = [f"{x} {y} {z} 0" for x, y, z in at] + ["Tetrahedra", str(len(tets))]
    rows += [" ".join(map(str, tet)) + " 0" for tet in tets]
    head = f"MeshVersionFormatted 1\nDimension 3\nVertices\n{len(at)}\n"
    (folder / "t.mesh").write_text(head + "\n".join([*rows, "End\n"]))
    return ["distance", "t.mesh", f"--vertex={n * (n + 1) ** 2}", "-o", "a.txt"]


@provokes("sign-uncertain")
def _(folder: Path) -> Words:
    rng = np.random.default_rng(1)
    corners = rng.uniform(-1, 1, (300, 1, 3))
    corners = corners / np.linalg.norm(corners, axis=2, keepdims=True)
    points = (corners + rng.uniform(-0.04, 0.04, (300, 3, 3))).reshape(-1, 3)
    obj(folder, points, [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(300)])
    return ["sdf", "a.obj", *GRID]
