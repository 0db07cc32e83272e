"""Inputs of the gallery that are made up: gallery_inputs.py OUT.

Writes meshes, curves and clouds into the folder OUT; those that are made of files of the data
collection only where that is the folder `data`.
"""

import json
import math
import sys
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[1]


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


def line_in_square(n: int) -> str:
    """A square with a line that ends inside, n / 8 cells from its right side, as OBJ."""
    line = (1 + n - n // 8 + j * (n + 1) for j in range(n // 3, n - n // 3 + 1))
    return square(n) + "l " + " ".join(map(str, line)) + "\n"


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


def points_of(mesh: Path) -> list[list[float]]:
    """The vertices of an OBJ or OFF file."""
    rows = [line.split() for line in mesh.read_text().splitlines() if line.strip()]
    if mesh.suffix == ".off":
        return [[float(x) for x in row[:3]] for row in rows[2 : 2 + int(rows[1][0])]]
    return [[float(x) for x in row[1:4]] for row in rows if row[0] == "v"]


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


def main(out: Path, data: Path) -> None:
    spot = EXAMPLES / "data" / "spot.obj"
    files = {
        "square.obj": square(60),
        "mixed.json": mixed(60),
        "line.obj": line_in_square(60),
        "band.obj": band(120, 14),
        "torus.obj": torus(90, 32),
        "hoof.txt": "unsigned_point\nv 306\n",
        "door.txt": "unsigned_point\nv 500\n",
        "rows.txt": rows_for_knitting(spot),
        "ball.xyz": ball_cloud((0.45, 0.05, 0.35), 0.42, 1500),
        "ring.xyz": ring_cloud((-0.35, 0.0, -0.05), (0.75, 0.09), 1500),
    }
    if data.is_dir():
        chair = points_of(data / "soups" / "shm3d-chair.obj")
        holes = points_of(data / "surfaces" / "3holes.off")
        files |= {
            "moebius.txt": joined(data / "curves" / "mobius-orientable-curve.txt"),
            "chair-ring.obj": ring_around(chair, 1, 0.5, 1.0),
            "holes-ring.obj": ring_around(holes, 0, 0.5, 0.8),
            "uneven.xyz": thinned(data / "clouds" / "knot.pc", 0.15),
        }
    out.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        (out / name).write_text(text)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path("data"))
