"""Makes the pictures of docs/gallery.md again: gallery.py PROGRAM [SHARED].

Without the shared data collection (SHARED, or ../shared beside the checkout) only those that need
none are made.
"""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SIZE = ["--width", "600", "--height", "450"]


def square(n: int) -> str:
    """The unit square in n x n cells, diagonals alternating, as OBJ."""
    rows = [f"v {i / n} {j / n} 0" for j in range(n + 1) for i in range(n + 1)]
    for j in range(n):
        for i in range(n):
            a = i + j * (n + 1) + 1
            b, c, d = a + 1, a + n + 1, a + n + 2
            two = (a, b, c), (b, d, c)
            if (i + j) % 2 == 0:
                two = (a, b, d), (a, d, c)
            rows += [f"f {p} {q} {r}" for p, q, r in two]
    return "\n".join(rows) + "\n"


def mixed(n: int) -> str:
    """Three quarters of a circle (signed), a segment (unsigned) and a point, as JSON."""
    angles = [math.pi * (0.02 + 1.36 * k / 60) for k in range(61)]
    arc = [[0.35 + 0.2 * math.cos(a), 0.6 + 0.2 * math.sin(a), 0] for a in angles]
    segment = [[0.55, 0.12, 0], [0.88, 0.3, 0]]
    corner = round(0.82 * n) + round(0.82 * n) * (n + 1)
    curves = [{"signed": True, "points": arc}, {"signed": False, "points": segment}]
    return json.dumps({"curves": curves, "points": [{"v": corner}]})


def rows_for_knitting(obj: Path) -> str:
    """Directions for rows of knitting: round the legs of the cow, as `f I x y z`."""
    points: list[list[float]] = []
    faces: list[list[int]] = []
    for line in obj.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(x) for x in words[1:4]])
        elif words[:1] == ["f"]:
            faces.append([int(w.split("/")[0]) - 1 for w in words[1:]])
    lines = []
    for f, (a, b, c) in enumerate(faces):
        height = (points[a][1] + points[b][1] + points[c][1]) / 3
        if not -0.55 < height < -0.35:
            continue
        u = [points[b][k] - points[a][k] for k in range(3)]
        v = [points[c][k] - points[a][k] for k in range(3)]
        normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        if math.hypot(normal[0], normal[2]) > 0.5 * math.hypot(*normal):
            lines.append(f"f {f} {-normal[2]:.9g} 0 {normal[0]:.9g}\n")
    return "".join(lines)


def ring_around(points: list[list[float]], axis: int, height: float, turn: float) -> str:
    """A circle around the middle of a shape, in space, as OBJ: across `axis` at a share of it."""
    low, high = (
        [min(column) for column in zip(*points, strict=True)],
        [max(c) for c in zip(*points, strict=True)],
    )
    centre = [0.5 * (a + b) for a, b in zip(low, high, strict=True)]
    centre[axis] = low[axis] + height * (high[axis] - low[axis])
    i, j = (k for k in range(3) if k != axis)
    rows = []
    for k in range(201):
        angle = 2 * math.pi * turn * k / 200
        x = centre[:]
        x[i] += 0.6 * (high[i] - low[i]) * math.cos(angle)
        x[j] += 0.6 * (high[j] - low[j]) * math.sin(angle)
        rows.append(f"v {x[0]} {x[1]} {x[2]}\n")
    return "".join(rows) + "l " + " ".join(str(k + 1) for k in range(201)) + "\n"


def main(program: str, shared: Path) -> None:
    out = ROOT / "docs" / "gallery"
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)

        def picture(name: str, mesh: Path, sources: Path, *options: str) -> None:
            field = work / "field.ply"
            about = ["--sources", str(sources), "--quiet"]
            solve = [program, "distance", str(mesh), *about, *options, "-o", str(field)]
            draw = [program, "render", str(field), *about, *SIZE, "-o", str(out / f"{name}.png")]
            for command in (solve, draw):
                subprocess.run(command, check=True)

        def solid(
            name: str, shape: Path, verb: str, *options: str, look: tuple[str, ...] = ()
        ) -> None:
            made = work / ("shape.nrrd" if verb == "sdf" else "shape.off")
            fine = ["--resolution", "96"]
            solve = [program, verb, str(shape), *options, *fine, "--quiet", "-o", str(made)]
            draw = [program, "render", str(made), *look, *SIZE, "-o", str(out / f"{name}.png")]
            for command in (solve, draw):
                subprocess.run(command, check=True)

        (work / "square.obj").write_text(square(60))
        (work / "mixed.json").write_text(mixed(60))
        picture("mixed", work / "square.obj", work / "mixed.json")
        data = ROOT / "examples" / "data"
        picture("spot-jersey", data / "spot.obj", data / "spot-jersey.txt")
        sharp = "--time-scale", "400", "--sharpen"
        picture("sharpened", data / "spot.obj", data / "spot-jersey.txt", *sharp)
        quadratic = "--sharpen", "quadratic"
        picture("quadratic-signed", data / "spot.obj", data / "spot-jersey.txt", *quadratic)
        (work / "snout.txt").write_text("unsigned_point\nv 306\n")
        (work / "rows.txt").write_text(rows_for_knitting(data / "spot.obj"))
        smooth = "--method", "regularized", "--alpha", "0.1"
        along = "--regularizer", "align", "--field", str(work / "rows.txt"), "--field-width", "0.15"
        picture("regularized", data / "spot.obj", work / "snout.txt", *smooth)
        picture("knitting", data / "spot.obj", work / "snout.txt", *smooth, *along)
        curves = shared / "data" / "curves"
        if not curves.is_dir():
            print(f"{curves} is not there: the other pictures are left as they are")
            return
        data = shared / "data"
        solid("chair-slice", data / "soups" / "shm3d-chair.obj", "sdf")
        solid("chair-offset", data / "soups" / "shm3d-chair.obj", "offset", "--dilate", "0.25")
        bottle = data / "clouds" / "SprayBottle.pc"
        solid("spray-bottle", bottle, "sdf", "--method", "tori", look=("--axis", "x"))
        bumpy = curves / "bumpy-sphere.obj"
        levels = "--constraint", "level-sets"
        picture("bumpy-sphere", bumpy, bumpy.with_suffix(".txt"), *levels)
        moebius = curves / "mobius-orientable-curve.obj"
        picture("moebius", moebius, moebius.with_suffix(".txt"))
        loops = str(curves / "DoubleTorusWithBrokenLoops.obj")
        regions = out / "regions.png"
        subprocess.run([program, "winding", loops, "--quiet", "-o", str(regions)], check=True)
        bear = curves / "polygon-bear.obj"
        picture("polygon-bear", bear, bear.with_suffix(".txt"))
        intrinsic = "--intrinsic-delaunay"
        for name, mesh, axis, height, turn, more in (
            ("holes", data / "soups" / "shm3d-chair.obj", 1, 0.5, 1.0, [intrinsic]),
            ("tunnels", data / "surfaces" / "3holes.off", 0, 0.5, 0.8, []),
        ):
            cut = work / "cut.obj"
            convert = [program, "convert", str(mesh), "-o", str(cut), "--quiet"]
            subprocess.run(convert, check=True)
            rows = [line.split() for line in cut.read_text().splitlines()]
            points = [[float(x) for x in row[1:4]] for row in rows if row[:1] == ["v"]]
            (work / "ring.obj").write_text(ring_around(points, axis, height, turn))
            picture(name, mesh, work / "ring.obj", *more)
        (work / "door.txt").write_text("unsigned_point\nv 500\n")
        picture("nonmanifold", data / "soups" / "beetle.obj", work / "door.txt", intrinsic)
        duck = curves / "ducky-star.pc"
        picture("ducky-star", duck, duck.with_suffix(".txt"))
        bunny, field, ring = shared / "data" / "volumes" / "bunny-64.vol", "field.ply", "ring.obj"
        for command in (
            ["distance", bunny, "--vertex", "0", "-o", work / field],
            ["contour", work / field, "--level", "42", "-o", work / ring],
            ["distance", bunny, "--sources", work / ring, "-o", work / field],
            ["render", work / field, *SIZE, "-o", out / "bunny-voxels.png"],
        ):
            subprocess.run([program, *map(str, command), "--quiet"], check=True)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]) if len(sys.argv) > 2 else ROOT.parent / "shared")
