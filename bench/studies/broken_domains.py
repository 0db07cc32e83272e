"""How far the distance moves when its surface breaks (signed heat paper, figure 23).

usage: broken_domains.py PROGRAM MESH.obj SOURCES.txt    needs numpy; prints a Markdown table

Holes: all faces near random vertices are cut out. Fins: triangles are glued to random edges, which
then have three faces. Tunnels: a face and the one below it are replaced by a tube through the
solid. Nothing within two mean edge lengths of the curve is touched. Distances are compared at the
vertices that are left, with those on the whole mesh.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def read_obj(path: Path) -> tuple[Floats, Ints]:
    rows = [line.split() for line in path.read_text().splitlines()]
    points = np.array([row[1:4] for row in rows if row[:1] == ["v"]], dtype=float)
    faces = [[int(c.split("/")[0]) - 1 for c in row[1:]] for row in rows if row[:1] == ["f"]]
    return points, np.array(faces)


def solve(program: str, points: Floats, faces: Ints, sources: Path, *more: str) -> Floats:
    with tempfile.TemporaryDirectory() as folder:
        mesh, out = Path(folder) / "mesh.obj", Path(folder) / "out.txt"
        with mesh.open("w") as file:
            file.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in points.tolist())
            file.writelines(f"f {a} {b} {c}\n" for a, b, c in (faces + 1).tolist())
        command = [program, "distance", str(mesh), "--sources", str(sources), "--quiet", *more]
        command += ["--method", "signed-heat"]
        subprocess.run([*command, "-o", str(out)], check=True)
        return np.loadtxt(out)


def holes(
    points: Floats, faces: Ints, far: Ints, share: float, random: np.random.Generator
) -> Ints:
    kept, size = faces, np.linalg.norm(np.ptp(points, axis=0))
    while len(kept) > (1 - share) * len(faces):
        centre = points[random.choice(far)]
        near = np.linalg.norm(points - centre, axis=1) < 0.02 * size
        kept = kept[~(near[kept].any(1) & np.isin(kept, far).all(1))]
    return kept


def fins(
    points: Floats, faces: Ints, far: Ints, count: int, random: np.random.Generator
) -> tuple[Floats, Ints]:
    inside = faces[np.isin(faces, far).all(1)]
    at = inside[random.choice(len(inside), count)]
    a, b, c = (points[at[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(b - a, axis=1, keepdims=True)
    tips = (a + b) / 2 + 3 * length * normal / np.linalg.norm(normal, axis=1, keepdims=True)
    new = np.stack([at[:, 0], at[:, 1], len(points) + np.arange(count)], 1)
    return np.vstack([points, tips]), np.vstack([faces, new])


def face_below(points: Floats, faces: Ints, f: int) -> int:
    """The first face that the line from the middle of a face into the solid hits, or -1."""
    a, u, v = points[faces[:, 0]], *(points[faces[:, k]] - points[faces[:, 0]] for k in (1, 2))
    d = -np.cross(u[f], v[f])
    p = np.cross(d, v)
    determinant = (u * p).sum(1)
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (points[faces[f]].mean(0) - a) / determinant[:, None]
        s, q = (t * p).sum(1), np.cross(t, u)
        r, along = q @ d, (q * v).sum(1)
    hit = (s > 0) & (r > 0) & (s + r < 1) & (along > 1e-9)
    return int(np.argmin(np.where(hit, along, np.inf))) if hit.any() else -1


def tunnels(
    points: Floats, faces: Ints, far: Ints, count: int, random: np.random.Generator
) -> Ints:
    used: set[int] = set()
    gone, tubes = [], []
    candidates = np.flatnonzero(np.isin(faces, far).all(1))
    for f in random.permutation(candidates):
        g = face_below(points, faces, int(f))
        if g < 0 or not np.isin(faces[g], far).all():
            continue
        if used & set(faces[[f, g]].ravel().tolist()) or set(faces[f]) & set(faces[g]):
            continue
        used |= set(faces[[f, g]].ravel().tolist())
        gone += [int(f), g]
        top, bottom = faces[f], faces[g][::-1]
        turn = min(range(3), key=lambda k: np.linalg.norm(points[top] - points[np.roll(bottom, k)]))
        bottom = np.roll(bottom, turn)
        for k in range(3):
            a, b = top[k], top[(k + 1) % 3]
            c, d = bottom[k], bottom[(k + 1) % 3]
            tubes += [[a, b, d], [a, d, c]]
        if len(gone) == 2 * count:
            break
    return np.vstack([np.delete(faces, gone, axis=0), tubes])


def main(program: str, mesh: Path, sources: Path) -> None:
    points, faces = read_obj(mesh)
    whole = solve(program, points, faces, sources)
    h = np.linalg.norm(points[faces[:, 0]] - points[faces[:, 1]], axis=1).mean()
    exact = solve(program, points, faces, sources, "--method", "exact")
    far = np.flatnonzero(exact > 2 * h)
    area = np.zeros(len(points))
    cross = np.cross(
        points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]]
    )
    np.add.at(area, faces.ravel(), np.repeat(np.linalg.norm(cross, axis=1) / 6, 3))
    print("| mesh | damage | mean difference, % of range | wrong sign, % of area |")
    print("|---|---|---|---|")

    def row(name: str, make: str, amount: float) -> None:
        moved, wrong = [], []
        for seed in range(3):
            random = np.random.default_rng(seed)
            p, f = points, faces
            if make == "holes":
                f = holes(points, faces, far, amount, random)
            elif make == "fins":
                p, f = fins(points, faces, far, int(amount), random)
            else:
                f = tunnels(points, faces, far, int(amount), random)
            phi = solve(program, p, f, sources)[: len(points)]
            ok = np.isfinite(phi)
            weight = area[ok] / area[ok].sum()
            moved.append(100 * (weight * abs(phi - whole)[ok]).sum() / np.ptp(whole))
            wrong.append(100 * weight[(phi * whole)[ok] < 0].sum())
        print(f"| {mesh.stem} | {name} | {np.mean(moved):.2f} | {np.mean(wrong):.2f} |", flush=True)

    for share in (0.05, 0.15, 0.3):
        row(f"holes, {100 * share:.0f} % of the faces gone", "holes", share)
    for count in (20, 200):
        row(f"{count} fins (edges of three faces)", "fins", count)
    for count in (1, 5, 20):
        row(f"{count} tunnels", "tunnels", count)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]))
