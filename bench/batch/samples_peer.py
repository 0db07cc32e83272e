"""Samples beside a loop of public pipelines: samples_peer.py DATA COUNT.

COUNT inputs from closed models of DATA, by turns whole and damaged (faces removed, turned round,
both, vertices moved by 0.2 % of the size), sampled by `littoral.samples` and by a loop over libigl:
distance on 64^3 nodes with fast winding numbers, marching cubes, points on that surface, noise, and
distance to it by pseudonormals. A model counts once whatever the number of files that hold it, and
only if its winding numbers are 0 and 1, so that what is inside is beyond doubt. Signs are compared
with libigl's exact winding numbers of the model before its damage, at points farther from it than
0.01 half sides. The two take turns; seconds are of the processor, all threads together.
"""

import importlib.metadata
import sys
import time
from pathlib import Path
from statistics import median

import igl
import numpy as np
from make_inputs import sources

import littoral

SPACE = 8192
KINDS = ("whole", "removed", "turned", "removed and turned", "moved")


def is_closed(F: np.ndarray) -> bool:
    edges = np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]])
    forward = {tuple(e) for e in edges.tolist()}
    return len(forward) == len(edges) and all((b, a) in forward for a, b in forward)


def half_side(V: np.ndarray) -> float:
    return 0.6 * float(np.ptp(V, axis=0).max())


def has_an_inside(V: np.ndarray, F: np.ndarray) -> bool:
    """Winding numbers are 0 and 1, both; lengths neither overflow nor vanish."""
    if not 1e-6 < half_side(V) < 1e6:
        return False
    uniform = np.random.default_rng(0).uniform(-1, 1, (4000, 3))
    x = (V.min(0) + V.max(0)) / 2 + half_side(V) * uniform
    w = igl.winding_number(V, F, x)
    return bool(np.abs(w - (w > 0.5)).max() < 1e-3 and 0 < (w > 0.5).mean() < 1)


def closed_models(data: Path) -> list[tuple[np.ndarray, np.ndarray]]:
    """By the number of vertices and faces: what differs in its place alone is no other model."""
    models: dict[tuple[int, int], tuple[np.ndarray, np.ndarray]] = {}
    for _, _, V, F in sources(data, 20_000):
        F = np.ascontiguousarray(F, dtype=np.int64)
        if (len(V), len(F)) not in models and is_closed(F) and has_an_inside(V, F):
            models[len(V), len(F)] = V, F
    return list(models.values())


def damaged(V: np.ndarray, F: np.ndarray, kind: str, rng: np.random.Generator) -> tuple:
    if "removed" in kind:
        F = F[rng.random(len(F)) > 0.05]
    if "turned" in kind:
        F = np.where((rng.random(len(F)) < 0.05)[:, None], F[:, ::-1], F)
    if kind == "moved":
        V = V + rng.normal(scale=0.002 * np.ptp(V, axis=0).max(), size=V.shape)
    return V, np.ascontiguousarray(F)


def by_littoral(V: np.ndarray, F: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    made = littoral.samples(V, F, space=SPACE, surface=SPACE, threads=1)
    return made.centre + made.half_side * made.points, made.distances * made.half_side


def by_peer(V: np.ndarray, F: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    low, high = V.min(0), V.max(0)
    half = half_side(V)
    axis = np.linspace(-1, 1, 64)
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
    grid = (low + high) / 2 + half * np.stack([x, y, z], -1).reshape(-1, 3)
    fast = igl.SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER
    values = igl.signed_distance(grid, V, F, fast)[0]
    W, G = igl.marching_cubes(values, grid, 64, 64, 64, 0.0)[:2]
    rng = np.random.default_rng(0)
    corners = W[G]
    sides = corners[:, 1:] - corners[:, :1]
    areas = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    f = rng.choice(len(G), size=SPACE, p=areas / areas.sum())
    u = rng.dirichlet([1, 1, 1], size=SPACE)
    on = (u[:, :, None] * corners[f]).sum(1)
    scales = rng.choice([0.005, 0.02, 0.08], size=(SPACE, 1))
    points = on + half * scales * rng.normal(size=on.shape)
    quarter = SPACE // 4
    points[:quarter] = (low + high) / 2 + half * rng.uniform(-1, 1, (quarter, 3))
    return points, igl.signed_distance(points, W, G, igl.SIGNED_DISTANCE_TYPE_PSEUDONORMAL)[0]


def wrong_signs(V: np.ndarray, F: np.ndarray, x: np.ndarray, distance: np.ndarray) -> float:
    """Share of points that are clear of the model and on the wrong side by their distance."""
    away = np.sqrt(igl.point_mesh_squared_distance(x, V, F)[0])
    clear = away > 0.01 * half_side(V)
    inside = igl.winding_number(V, F, x[clear]) > 0.5
    return float(((distance[clear] < 0) != inside).mean())


def main() -> None:
    rng = np.random.default_rng(1)
    models = closed_models(Path(sys.argv[1]))
    programs = {"littoral": by_littoral, "libigl": by_peer}
    seconds: dict[str, list[float]] = {name: [] for name in programs}
    errors: dict[tuple[str, str], list[float]] = {(n, k): [] for n in programs for k in KINDS}
    count, sizes, each = int(sys.argv[2]), [], []
    for number in range(count):
        if number % len(models) == 0:
            each = list(rng.permutation(len(models)))
        V, F = models[each.pop()]
        sizes.append(len(F))
        kind = KINDS[number % len(KINDS)]
        broken = damaged(V, F, kind, rng)
        for name, sampled in programs.items():
            begin = time.process_time()
            try:
                x, distance = sampled(*broken)
            except Exception as error:
                print(f"{name}, {kind}: {type(error).__name__}: {str(error)[:80]}")
                continue
            finally:
                seconds[name].append(time.process_time() - begin)
            errors[name, kind].append(wrong_signs(V, F, x, distance))
    versions = [f"{name} {importlib.metadata.version(name)}" for name in ("libigl", "numpy")]
    print(f"{count} inputs of {len(models)} models, {min(sizes)} to {max(sizes)} faces, "
          f"littoral {littoral.__version__}, {', '.join(versions)}")  # fmt: skip
    print("| program | done | seconds each, median | all | samples a second | wrong signs, mean, % "
          "| largest | without any |\n|---|---|---|---|---|---|---|---|")  # fmt: skip
    for name, took in seconds.items():
        shares = [share for kind in KINDS for share in errors[name, kind]]
        print(f"| {name} | {len(shares)} | {median(took):.3f} | {sum(took):.1f} | "
              f"{len(shares) * 2 * SPACE / sum(took):,.0f} | {100 * np.mean(shares):.3f} | "
              f"{100 * max(shares):.2f} | {sum(share == 0 for share in shares)} |")  # fmt: skip
    print(f"\n| wrong signs, mean, median, % | {' | '.join(KINDS)} |\n|---|{'---|' * len(KINDS)}")
    for name in programs:
        cells = [errors[name, kind] for kind in KINDS]
        texts = [f"{100 * np.mean(c):.3f}, {100 * median(c):.3f}" if c else "" for c in cells]
        print(f"| {name} | {' | '.join(texts)} |")


if __name__ == "__main__":
    main()
