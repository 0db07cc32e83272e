"""Makes the pictures of docs/gallery again: gallery.py PROGRAM [SHARED].

Those of docs/gallery/spot.md are made by the commands on that page, which need the Python package.
Without the shared data collection (SHARED, or ../shared beside the checkout) only those that need
none are made.
"""

import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from page_code import run_page

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


def band(nu: int, nw: int) -> str:
    """A Moebius band and its core, as OBJ."""

    def vertex(i: int, j: int) -> int:
        return 1 + (i * (nw + 1) + j if i < nu else nw - j)

    rows = []
    for i in range(nu):
        u = 2 * math.pi * i / nu
        for j in range(nw + 1):
            t = 0.35 * (2 * j / nw - 1)
            s = 1 + t * math.cos(u / 2)
            rows.append(f"v {s * math.cos(u)} {t * math.sin(u / 2)} {s * math.sin(u)}")
    for i in range(nu):
        for j in range(nw):
            a, b, c = vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)
            rows += [f"f {a} {b} {c}", f"f {a} {c} {vertex(i, j + 1)}"]
    core = " ".join(str(vertex(i, nw // 2)) for i in range(nu + 1))
    return "\n".join([*rows, f"l {core}"]) + "\n"


def torus(nu: int, nv: int) -> str:
    """A torus and a loop round its tube, as OBJ."""
    rows = []
    for i in range(nu):
        for j in range(nv):
            u, v = 2 * math.pi * i / nu, 2 * math.pi * j / nv
            s = 1 + 0.35 * math.cos(v)
            rows.append(f"v {s * math.cos(u)} {0.35 * math.sin(v)} {s * math.sin(u)}")
    for i in range(nu):
        for j in range(nv):
            k, m = (i + 1) % nu, (j + 1) % nv
            a, b, c, d = (1 + p * nv + q for p, q in ((i, j), (k, j), (k, m), (i, m)))
            rows += [f"f {a} {c} {b}", f"f {a} {d} {c}"]
    loop = " ".join(str(1 + nu // 4 * nv + j % nv) for j in range(nv + 1))
    return "\n".join([*rows, f"l {loop}"]) + "\n"


def joined(sources: Path) -> str:
    """All lines of a file of sources as one signed curve."""
    words = [line.split() for line in sources.read_text().splitlines()]
    return "signed_curve\nl " + " ".join(v for row in words if row[:1] == ["l"] for v in row[1:])


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


def cloud_of(points: list[list[float]], normals: list[list[float]]) -> str:
    """Points and normals as XYZ."""
    rows = zip(points, normals, strict=True)
    return "".join(" ".join(f"{x:.9g}" for x in (*p, *n)) + "\n" for p, n in rows)


def ball_cloud(centre: tuple[float, float, float], radius: float, n: int) -> str:
    """n points spread evenly over a sphere."""
    normals = []
    for i in range(n):
        z = 1 - (2 * i + 1) / n
        r, a = math.sqrt(1 - z * z), 2.399963 * i
        normals.append([r * math.cos(a), r * math.sin(a), z])
    return cloud_of(
        [[c + radius * x for c, x in zip(centre, m, strict=True)] for m in normals], normals
    )


def ring_cloud(centre: tuple[float, float, float], radii: tuple[float, float], n: int) -> str:
    """n points spread evenly over a torus about the y axis."""
    big, small = radii
    points, normals = [], []
    for i in range(n):
        u, wound = 2 * math.pi * (i + 0.5) / n, 2 * math.pi * (i * 0.6180339887498949 % 1)
        v = wound
        for _ in range(20):
            v -= (big * (v - wound) + small * math.sin(v)) / (big + small * math.cos(v))
        m = [math.cos(v) * math.cos(u), math.sin(v), math.cos(v) * math.sin(u)]
        ring = [big * math.cos(u), 0.0, big * math.sin(u)]
        points.append([c + a + small * b for c, a, b in zip(centre, ring, m, strict=True)])
        normals.append(m)
    return cloud_of(points, normals)


def thinned(cloud: Path, least: float) -> str:
    """A .pc cloud with ever fewer points towards large x: a share `least` of them at the end."""
    rows = [line.split() for line in cloud.read_text().splitlines()]
    points = [[float(x) for x in r[1:4]] for r in rows if r[:1] == ["v"]]
    normals = [[float(x) for x in r[1:4]] for r in rows if r[:1] == ["vn"]]
    low, high = min(p[0] for p in points), max(p[0] for p in points)
    due, kept = 0.0, []
    for i, p in enumerate(points):
        due += least ** ((p[0] - low) / (high - low))
        if due >= 1:
            due -= 1
            kept.append(i)
    return cloud_of([points[i] for i in kept], [normals[i] for i in kept])


def cloud_pictures(program: str, clouds: Path, work: Path, out: Path) -> None:
    """Booleans and offsets of clouds, traced."""

    def trace(name: str, cloud: Path, *options: str) -> None:
        command = [program, "render", str(cloud), "--trace", *options, *SIZE, "--quiet"]
        subprocess.run([*command, "-o", str(out / f"{name}.png")], check=True)

    ball, ring, uneven = work / "ball.xyz", work / "ring.xyz", work / "uneven.xyz"
    ball.write_text(ball_cloud((0.45, 0.05, 0.35), 0.42, 1500))
    ring.write_text(ring_cloud((-0.35, 0.0, -0.05), (0.75, 0.09), 1500))
    uneven.write_text(thinned(clouds / "knot.pc", 0.15))
    pieces = "--unite", str(ring), "--subtract", str(ball), "--blend", "0.06"
    trace("cloud-boolean", clouds / "bunny.pc", *pieces)
    trace("cloud-offset", uneven, "--level", "3", "--slice", "0", "--resolution", "64")


def spot_pictures(program: str, out: Path) -> None:
    """Runs the code of a page and keeps the pictures that it made."""
    program, before = str(Path(program).resolve()), Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            run_page(out / "spot.md", Path(folder), program)
        finally:
            os.chdir(before)
        for picture in sorted((Path(folder) / "out").glob("spot-*.png")):
            shutil.copy(picture, out)


def main(program: str, shared: Path) -> None:
    out = ROOT / "docs" / "gallery"
    spot_pictures(program, out)
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
            name: str,
            shape: Path,
            verb: str,
            *options: str,
            look: tuple[str, ...] = (),
            resolution: int = 96,
        ) -> None:
            made = work / ("shape" + {"sdf": ".nrrd", "repair": ".ply"}.get(verb, ".off"))
            fine = ["--resolution", str(resolution)]
            solve = [program, verb, str(shape), *options, *fine, "--quiet", "-o", str(made)]
            draw = [program, "render", str(made), *look, *SIZE, "-o", str(out / f"{name}.png")]
            for command in (solve, draw):
                subprocess.run(command, check=True)

        (work / "square.obj").write_text(square(60))
        (work / "mixed.json").write_text(mixed(60))
        picture("mixed", work / "square.obj", work / "mixed.json")
        data = ROOT / "examples" / "data"
        picture("spot-jersey", data / "spot.obj", data / "spot-jersey.txt")
        heat = "--method", "signed-heat"
        for name, text in ("moebius-core", band(120, 14)), ("torus-loop", torus(90, 32)):
            (work / "shape.obj").write_text(text)
            jumps = [program, "distance", str(work / "shape.obj"), *heat, "--discontinuous"]
            subprocess.run([*jumps, "--quiet", "-o", str(out / f"{name}.png")], check=True)
        sharp = *heat, "--time-scale", "400", "--sharpen"
        picture("sharpened", data / "spot.obj", data / "spot-jersey.txt", *sharp)
        sure = str(work / "sure.ply")
        jersey = ["--sources", str(data / "spot-jersey.txt"), "--quiet"]
        solve = [program, "distance", str(data / "spot.obj"), *jersey, "--confidence", "-o", sure]
        subprocess.run(solve, check=True)
        draw = [program, "render", sure, *jersey, "--field", "confidence", "--isolines", "0", *SIZE]
        subprocess.run([*draw, "-o", str(out / "confidence.png")], check=True)
        volume = str(work / "sharpened.nrrd")
        around = [program, "sdf", str(data / "spot.obj"), *heat, "--sharpen", "--resolution", "28"]
        subprocess.run([*around, "--quiet", "-o", volume], check=True)
        draw = [program, "render", volume, "--axis", "x", *SIZE]
        subprocess.run([*draw, "-o", str(out / "sharpened-grid.png")], check=True)
        quadratic = *heat, "--sharpen", "quadratic"
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
        solid("chair-slice", data / "soups" / "shm3d-chair.obj", "sdf", resolution=160)
        solid("chair-offset", data / "soups" / "shm3d-chair.obj", "offset", "--dilate", "0.25")
        plain = "--isolines", "0"
        solid("repaired", data / "soups" / "beetle.obj", "repair", look=plain, resolution=256)
        bottle = data / "clouds" / "SprayBottle.pc"
        solid("spray-bottle", bottle, "sdf", "--method", "tori", look=("--axis", "x"))
        cloud_pictures(program, data / "clouds", work, out)
        bumpy = curves / "bumpy-sphere.obj"
        levels = *heat, "--constraint", "level-sets"
        picture("bumpy-sphere", bumpy, bumpy.with_suffix(".txt"), *levels)
        moebius = curves / "mobius-orientable-curve.obj"
        once = work / "moebius.txt"  # the file has parts, one of them reversed by hand
        once.write_text(joined(moebius.with_suffix(".txt")))
        picture("moebius", moebius, once)
        loops = str(curves / "DoubleTorusWithBrokenLoops.obj")
        regions = out / "regions.png"
        subprocess.run([program, "winding", loops, "--quiet", "-o", str(regions)], check=True)
        bear = curves / "polygon-bear.obj"
        picture("polygon-bear", bear, bear.with_suffix(".txt"))
        for name, mesh, axis, height, turn in (
            ("holes", data / "soups" / "shm3d-chair.obj", 1, 0.5, 1.0),
            ("tunnels", data / "surfaces" / "3holes.off", 0, 0.5, 0.8),
        ):
            cut = work / "cut.obj"
            convert = [program, "convert", str(mesh), "-o", str(cut), "--quiet"]
            subprocess.run(convert, check=True)
            rows = [line.split() for line in cut.read_text().splitlines()]
            points = [[float(x) for x in row[1:4]] for row in rows if row[:1] == ["v"]]
            (work / "ring.obj").write_text(ring_around(points, axis, height, turn))
            picture(name, mesh, work / "ring.obj")
        (work / "door.txt").write_text("unsigned_point\nv 500\n")
        picture("nonmanifold", data / "soups" / "beetle.obj", work / "door.txt")
        duck = curves / "ducky-star.pc"
        picture("ducky-star", duck, duck.with_suffix(".txt"))
        hand, tets = data / "tets" / "hand.mesh", str(work / "tets.vtk")
        for name, source in (
            ("tets-point", ["--vertex", "2726", "--alpha", "0.02"]),
            ("tets-boundary", ["--boundary", "--alpha", "0.02"]),
            ("tets-smooth", ["--boundary", "--alpha", "0.15"]),
        ):
            solve = [program, "distance", str(hand), "--method", "regularized", *source]
            subprocess.run([*solve, "--quiet", "-o", tets], check=True)
            lines = "20" if "--vertex" in source else "7"
            shown = [program, "render", tets, "--axis", "z", "--slice", "0", "--isolines", lines]
            subprocess.run([*shown, *SIZE, "-o", str(out / f"{name}.png")], check=True)
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
