"""Samples beside a loop of public pipelines: samples_peer.py DATA COUNT.

COUNT damaged copies of closed models of DATA (faces removed, turned round, both, vertices moved by
0.2 % of the size), sampled by `littoral.samples` and by a loop over libigl: distance on 64^3 nodes
with fast winding numbers, marching cubes, points on that surface, noise, and distance to it by
pseudonormals. Signs are compared with those of the model before its damage, at points farther from
it than 0.01 half sides.
"""

import sys
import time
from pathlib import Path

import igl
import numpy as np
from make_inputs import sources

import littoral

SPACE = 8192


def is_closed(F: np.ndarray) -> bool:
    edges = np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]])
    forward = {tuple(e) for e in edges.tolist()}
    return len(forward) == len(edges) and all((b, a) in forward for a, b in forward)


def damaged(V: np.ndarray, F: np.ndarray, rng: np.random.Generator) -> tuple:
    kind = rng.integers(4)
    if kind in (0, 2):
        F = F[rng.random(len(F)) > 0.05]
    if kind in (1, 2):
        F = np.where((rng.random(len(F)) < 0.05)[:, None], F[:, ::-1], F)
    if kind == 3:
        V = V + rng.normal(scale=0.002 * np.ptp(V, axis=0).max(), size=V.shape)
    return V, F


def by_littoral(V: np.ndarray, F: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    made = littoral.samples(V, F, space=SPACE, surface=SPACE, threads=1)
    return made.centre + made.half_side * made.points, made.distances * made.half_side


def by_peer(V: np.ndarray, F: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    low, high = V.min(0), V.max(0)
    half = 0.6 * (high - low).max()
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


def main() -> None:
    rng = np.random.default_rng(1)
    models = [(V, F) for _, _, V, F in sources(Path(sys.argv[1])) if is_closed(F)]
    cases = []
    for _ in range(int(sys.argv[2])):
        V, F = models[int(rng.integers(len(models)))]
        cases.append((V, F, *damaged(V, F, rng)))
    print(f"{len(cases)} inputs of {len(models)} closed models")
    for name, sampled in (("littoral", by_littoral), ("libigl", by_peer)):
        seconds, done, wrong, compared, clean = 0.0, 0, 0, 0, 0
        for V, F, broken_V, broken_F in cases:
            begin = time.process_time()
            try:
                x, distance = sampled(broken_V, np.ascontiguousarray(broken_F))
            except Exception as error:
                print(f"  {name}: {type(error).__name__}: {str(error)[:80]}")
                seconds += time.process_time() - begin
                continue
            seconds += time.process_time() - begin
            exact = littoral.SDF(V, F)(x)
            clear = np.abs(exact) > 0.01 * 0.6 * np.ptp(V, axis=0).max()
            errors = int(((distance < 0) != (exact < 0))[clear].sum())
            done += 1
            wrong += errors
            clean += errors == 0
            compared += int(clear.sum())
        print(f"{name}: {done} of {len(cases)} done, {done * 2 * SPACE / seconds:.0f} samples a "
              f"second of processor time, {100 * wrong / compared:.3f} % wrong signs, "
              f"{clean} inputs without any")  # fmt: skip


if __name__ == "__main__":
    main()
