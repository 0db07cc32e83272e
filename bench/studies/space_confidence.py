"""What confidence in space is worth: how often is the sign right, by confidence?

usage: space_confidence.py PROGRAM MESH...    closed meshes; needs numpy; prints Markdown tables

Faces within balls about random places of the surface are cut out or reversed, until so much of the
area is. At 20,000 random places in the box, a tenth wider, signs of the damaged mesh's distance are
compared with those of the whole one's.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

# Name; shares of the area cut out and reversed; radius of the balls, of the longest side.
DAMAGE = (
    ("5 % cut out, small holes", 0.05, 0, 0.05),
    ("15 % cut out, small holes", 0.15, 0, 0.05),
    ("15 % cut out, large holes", 0.15, 0, 0.12),
    ("30 % cut out, large holes", 0.3, 0, 0.12),
    ("50 % cut out, larger holes", 0.5, 0, 0.2),
    ("20 % reversed", 0, 0.2, 0.1),
    ("35 % reversed", 0, 0.35, 0.1),
    ("15 % cut out, 20 % reversed", 0.15, 0.2, 0.1),
)


def triangles(program: str, mesh: str, folder: Path) -> tuple[Floats, Ints]:
    out = folder / "whole.obj"
    command = [program, "convert", mesh, "--triangulate", "-o", str(out)]
    subprocess.run(command, check=True, capture_output=True)
    rows = [line.split() for line in out.read_text().splitlines()]
    points = np.array([row[1:4] for row in rows if row[:1] == ["v"]], dtype=float)
    faces = [[int(c.split("/")[0]) - 1 for c in row[1:]] for row in rows if row[:1] == ["f"]]
    return points, np.array(faces)


def ask(program: str, points: Floats, faces: Ints, places: Path) -> tuple[Floats, Floats]:
    """Distance and confidence."""
    mesh, out = places.parent / "mesh.obj", places.parent / "out.csv"
    with mesh.open("w") as file:
        file.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in points.tolist())
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in (faces + 1).tolist())
    command = [program, "query", str(mesh), "--points", str(places), "--confidence", "--quiet"]
    subprocess.run([*command, "-o", str(out)], check=True)
    table = np.loadtxt(out, delimiter=",", skiprows=1)
    return table[:, 0], table[:, 1]


def chosen(
    points: Floats, faces: Ints, share: float, radius: float, random: np.random.Generator
) -> NDArray[np.bool_]:
    a, b, c = (points[faces[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    middles, side = (a + b + c) / 3, np.ptp(points, axis=0).max()
    hit = np.zeros(len(faces), bool)
    while area[hit].sum() < share * area.sum():
        centre = middles[random.choice(len(faces), p=area / area.sum())]
        near = np.linalg.norm(middles - centre, axis=1)
        hit |= near < radius * side * random.uniform(0.5, 1.5)
    return hit


def row(name: str, confidence: Floats, right: NDArray[np.bool_]) -> str:
    cells = [f"{100 * np.mean(~right):.2f}"]
    for least in (0, 0.5, 0.9):
        sure = confidence >= least
        cells += [f"{100 * sure.mean():.1f} / {100 * right[sure].mean():.2f}"]
    return f"| {name} | " + " | ".join(cells[:1] + cells[2:]) + " |"


def main(program: str, meshes: list[str]) -> None:
    asked: dict[str, list[tuple[Floats, NDArray[np.bool_]]]] = {name: [] for name, *_ in DAMAGE}
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        places = folder / "places.csv"
        for mesh in meshes:
            points, faces = triangles(program, mesh, folder)
            random = np.random.default_rng(5)
            low, high = points.min(0), points.max(0)
            room = 0.1 * (high - low).max()
            np.savetxt(places, random.uniform(low - room, high + room, (20000, 3)), delimiter=",")
            truth, _ = ask(program, points, faces, places)
            for name, cut, reverse, radius in DAMAGE:
                turned = faces.copy()
                back = chosen(points, faces, reverse, radius, random)
                turned[back] = turned[back][:, ::-1]
                left = turned[~chosen(points, faces, cut, radius, random)]
                distance, confidence = ask(program, points, left, places)
                asked[name].append((confidence, (distance < 0) == (truth < 0)))
    print("| damage | wrong signs [%] | confidence >= 0.5: places / right signs [%] | >= 0.9 |")
    print("|---|---|---|---|")
    joined = {n: [np.concatenate(x) for x in zip(*all_, strict=True)] for n, all_ in asked.items()}
    for name, (confidence, right) in joined.items():
        print(row(name, confidence, right))
    confidence, right = (np.concatenate(x) for x in zip(*joined.values(), strict=True))
    print("\n| confidence | share of the places [%] | right signs [%] | least of all damages [%] |")
    print("|---|---|---|---|")
    for tenth in range(10):
        bins = [np.minimum(9, (10 * c).astype(int)) == tenth for c, _ in joined.values()]
        # Shares of fewer than 100 places say little.
        each = [
            r[b].mean() for b, (_, r) in zip(bins, joined.values(), strict=True) if b.sum() > 99
        ]
        b = np.concatenate(bins)
        shares = [b.mean(), right[b].mean(), min(each)]
        cells = " | ".join(f"{100 * share:.2f}" for share in shares)
        print(f"| {tenth / 10:.1f} to {tenth / 10 + 0.1:.1f} | {cells} |")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
