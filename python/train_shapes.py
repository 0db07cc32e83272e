"""Random solids with exact normals and distances: what train_torus_fit.py learns from.

Solids are unions and differences of primitives, sampled on the primitives' own surfaces, so that
normals are exact up to edges.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

Array = np.ndarray
Implicit = Callable[[Array], Array]  # negative inside
DENSE = 24000  # samples of a solid that stand for its surface


@dataclass
class Primitive:
    inside: Implicit
    points: Array
    normals: Array


@dataclass
class Cloud:
    """An oriented cloud (points, normals), places around it (queries) and their distances."""

    points: Array
    normals: Array
    queries: Array
    distance: Array


def length(x: Array) -> Array:
    return np.sqrt((x * x).sum(-1))


def unit(x: Array) -> Array:
    return x / np.maximum(length(x), 1e-30)[..., None]


def box(r: np.random.Generator, b: Array) -> Primitive:
    areas = np.array([b[1] * b[2], b[0] * b[2], b[0] * b[1]])
    axis = r.choice(3, DENSE, p=areas / areas.sum())
    side = r.choice([-1.0, 1.0], DENSE)
    x, n = r.uniform(-1, 1, (DENSE, 3)) * b, np.zeros((DENSE, 3))
    rows = np.arange(DENSE)
    x[rows, axis], n[rows, axis] = side * b[axis], side
    return Primitive(lambda y: (np.abs(y) - b).max(-1), x, n)


def ellipsoid(r: np.random.Generator, e: Array) -> Primitive:
    x = unit(r.normal(size=(4 * DENSE, 3)))
    stretch = length(x / e)  # of areas, up to a factor
    x = x[r.random(len(x)) * stretch.max() < stretch][:DENSE]
    return Primitive(lambda y: length(y / e) - 1, x * e, unit(x / e))


def torus(r: np.random.Generator, major: float, minor: float) -> Primitive:
    u, v = r.uniform(0, 2 * np.pi, (2, 3 * DENSE))
    keep = r.random(len(u)) * (major + minor) < major + minor * np.cos(v)
    u, v = u[keep][:DENSE], v[keep][:DENSE]
    n = np.stack([np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)], -1)
    x = major * np.stack([np.cos(u), np.sin(u), 0 * u], -1) + minor * n
    return Primitive(lambda y: np.hypot(length(y[..., :2]) - major, y[..., 2]) - minor, x, n)


def cone(r: np.random.Generator, bottom: float, top: float, h: float) -> Primitive:
    """A cylinder of half height h whose radius changes from bottom to top; closed by disks."""
    slant = np.hypot(2 * h, bottom - top)
    areas = np.array([(bottom + top) * slant, bottom**2, top**2])
    part = r.choice(3, DENSE, p=areas / areas.sum())
    a = r.uniform(0, 2 * np.pi, DENSE)
    # Along the side, evenly by area: radii are as likely as they are large.
    radius = np.sqrt(r.uniform(0, 1, DENSE) * (top**2 - bottom**2) + bottom**2)
    even = r.uniform(-h, h, DENSE)
    along = (radius - bottom) / (top - bottom) * 2 * h - h if abs(top - bottom) > 1e-9 else even
    disk = np.sqrt(r.uniform(0, 1, DENSE))
    radius = np.where(part == 0, radius, disk * np.where(part == 1, bottom, top))
    z = np.where(part == 0, along, np.where(part == 1, -h, h))
    x = np.stack([radius * np.cos(a), radius * np.sin(a), z], -1)
    rise = (bottom - top) / slant
    flat = np.where(part == 0, 2 * h / slant, 0.0)
    up = np.where(part == 0, rise, np.where(part == 1, -1.0, 1.0))
    n = np.stack([flat * np.cos(a), flat * np.sin(a), up], -1)

    def inside(y: Array) -> Array:
        limit = bottom + (top - bottom) * (y[..., 2] + h) / (2 * h)
        return np.maximum(length(y[..., :2]) - limit, np.abs(y[..., 2]) - h)

    return Primitive(inside, x, n)


def primitive(r: np.random.Generator) -> Primitive:
    s = r.uniform(0.25, 0.7)
    kind = r.choice(["box", "plate", "ellipsoid", "sphere", "torus", "cylinder", "cone"])
    if kind == "box":
        p = box(r, s * r.uniform(0.4, 1, 3))
    elif kind == "plate":
        p = box(r, np.array([s, s * r.uniform(0.5, 1), r.uniform(0.03, 0.1)]))
    elif kind == "ellipsoid":
        p = ellipsoid(r, s * r.uniform(0.35, 1, 3))
    elif kind == "sphere":
        p = ellipsoid(r, np.full(3, s))
    elif kind == "torus":
        p = torus(r, s, s * r.uniform(0.2, 0.5))
    elif kind == "cylinder":
        radius = s * r.uniform(0.15, 1)
        p = cone(r, radius, radius, s * r.uniform(0.3, 1.2))
    else:
        p = cone(r, s * r.uniform(0.5, 1), s * r.uniform(0.05, 0.5), s * r.uniform(0.3, 1.2))
    turn = np.linalg.qr(r.normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    move = r.uniform(-0.3, 0.3, 3)
    return Primitive(
        lambda y: p.inside((y - move) @ turn.T), p.points @ turn + move, p.normals @ turn
    )


def solid(r: np.random.Generator) -> Primitive:
    out = primitive(r)
    for _ in range(r.choice([0, 1, 2, 3], p=[0.3, 0.3, 0.25, 0.15])):
        a, b = out, primitive(r)
        keep_a = b.inside(a.points) > 0
        if r.random() < 0.55:  # a and b
            keep_b, sign = a.inside(b.points) > 0, 1.0
            inside = _union(a.inside, b.inside)
        else:  # a without b
            keep_b, sign = a.inside(b.points) < 0, -1.0
            inside = _difference(a.inside, b.inside)
        out = Primitive(
            inside,
            np.concatenate([a.points[keep_a], b.points[keep_b]]),
            np.concatenate([a.normals[keep_a], sign * b.normals[keep_b]]),
        )
    return out


def _union(f: Implicit, g: Implicit) -> Implicit:
    return lambda y: np.minimum(f(y), g(y))


def _difference(f: Implicit, g: Implicit) -> Implicit:
    return lambda y: np.maximum(f(y), -g(y))


def spread(points: Array, n: int, r: np.random.Generator) -> Array:
    """Rows of n points far from each other."""
    chosen = np.empty(n, int)
    chosen[0] = r.integers(len(points))
    nearest = np.full(len(points), np.inf)
    for i in range(1, n):
        nearest = np.minimum(nearest, ((points - points[chosen[i - 1]]) ** 2).sum(1))
        chosen[i] = nearest.argmax()
    return chosen


def make_cloud(seed: int, n_queries: int = 1500) -> Cloud | None:
    """A solid seen through a cloud that may be uneven, noisy, with outliers and flipped normals."""
    r = np.random.default_rng(seed)
    s = solid(r)
    if len(s.points) < 6000:
        return None
    x, normals = s.points, s.normals
    n = int(r.choice([256, 512, 768, 1024]))
    order = r.permutation(len(x))[: 8 * n]
    way = r.random()
    if way < 0.4:
        rows = order[spread(x[order], n, r)]
    elif way < 0.8:
        rows = order[:n]
    else:  # denser on one side
        density = np.exp(1.5 * (x @ unit(r.normal(size=3))))
        rows = r.choice(len(x), n, False, p=density / density.sum())
    points, found = x[rows].copy(), normals[rows].copy()
    if r.random() < 0.35:
        amount = 10 ** r.uniform(-3, -1.7)
        points += amount * r.normal(size=points.shape)
        found = unit(found + 5 * amount * r.normal(size=found.shape))
    if r.random() < 0.2:
        flips = r.random(n) < 0.03
        found[flips] *= -1
    if r.random() < 0.2:
        extra = max(1, int(n * r.uniform(0, 0.02)))  # in place of others
        points[:extra] = r.uniform(-0.9, 0.9, (extra, 3))
        found[:extra] = unit(r.normal(size=(extra, 3)))
    spacing = np.median(cKDTree(points).query(points, 7)[0][:, 6])
    near = x[r.choice(len(x), 2 * n_queries // 3)]
    queries = np.concatenate(
        [
            near + spacing * r.normal(size=near.shape) * 0.6,
            r.uniform(-1, 1, (n_queries - len(near), 3)),
        ]
    )
    # Distance to the tangent disks of the nearest samples.
    _, rows = cKDTree(x).query(queries, 6)
    away = queries[:, None] - x[rows]
    height = (away * normals[rows]).sum(-1)
    tangent = away - height[..., None] * normals[rows]
    flat = length(tangent)
    beyond = np.maximum(flat - 0.015, 0)
    size = np.hypot(height, beyond).min(1)
    return Cloud(points, found, queries, np.where(s.inside(queries) < 0, -size, size))
