"""Small inputs, and the table of calls that provoke a code each."""

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np

Words = list[object]
MADE: dict[str, Callable[[Path], Words]] = {}
GRID = ("--resolution=12", "-o", "a.npz")


def provokes(code: str) -> Callable[[Callable[[Path], Words]], Callable[[Path], Words]]:
    def keep(make: Callable[[Path], Words]) -> Callable[[Path], Words]:
        MADE[code] = make
        return make

    return keep


def simple(code: str, *words: object) -> None:
    MADE[code] = lambda folder: list(words)


def obj(folder: Path, points: object, faces: list[tuple[int, ...]], more: str = "") -> str:
    """a.obj; faces count from 0."""
    lines = [f"v {x} {y} {z}\n" for x, y, z in np.asarray(points)]
    lines += ["f " + " ".join(str(v + 1) for v in face) + "\n" for face in faces]
    (folder / "a.obj").write_text("".join(lines) + more)
    return "a.obj"


def cube(side: float = 1, at: float = 0) -> tuple[np.ndarray, list[tuple[int, ...]]]:
    points = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]) * side + at
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return points, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


def strip(n: int, turns: int) -> tuple[np.ndarray, list[tuple[int, ...]]]:
    """A band of n quads in a ring, turned over so many times: once is one-sided."""
    points = []
    for i in range(n):
        a = 2 * math.pi * i / n
        for side in (-0.3, 0.3):
            r = 1 + side * math.cos(turns * a / 2)
            points.append((r * math.cos(a), r * math.sin(a), side * math.sin(turns * a / 2)))
    faces: list[tuple[int, ...]] = []
    for i in range(n):
        k, m = 2 * i, 2 * ((i + 1) % n)
        p, q = (m + 1, m) if i + 1 == n and turns % 2 else (m, m + 1)
        faces += [(k, p, k + 1), (k + 1, p, q)]
    return np.array(points), faces


def sphere_cloud(n: int = 400, inward: float = 1) -> np.ndarray:
    i = np.arange(n)
    z = 1 - 2 * (i + 0.5) / n
    a, r = i * 2.399963, np.sqrt(1 - z * z)
    x = np.stack([r * np.cos(a), r * np.sin(a), z], 1)
    return np.hstack([x, inward * x])


def mask(folder: Path) -> None:
    ball = np.linalg.norm(np.indices((9, 9, 9)) - 4, axis=0) < 3
    np.save(folder / "m.npy", ball.astype(np.uint8))
    np.savez(folder / "d.npz", values=0.1 - ball, origin=np.zeros(3), spacing=1)
