"""Damaged inputs for batches: make_inputs.py DATA COUNT OUT [SEED [FACES]].

COUNT files from the surfaces of DATA that have at most FACES (4000) faces: each is copied with
random damage of its mesh (faces removed, turned round, doubled, vertices moved) or, every tenth, of
its bytes (cut short, overwritten, numbers replaced). Every tenth again is a file of DATA as it is,
among them the corrupted ones. The same seed makes the same files.
"""

import sys
from pathlib import Path

import numpy as np

import littoral


def files(data: Path) -> list[Path]:
    """All that a surface may be in, whole or not."""
    return [
        path
        for path in sorted(data.rglob("*"))
        if path.suffix in (".obj", ".off", ".ply", ".stl") and path.stat().st_size <= 400_000
    ]


def sources(data: Path, most: int = 4000) -> list[tuple[bytes, str, np.ndarray, np.ndarray]]:
    found = []
    for path in files(data):
        try:
            mesh = littoral.read(path)
            V, F = np.array(mesh.points), np.array(mesh.faces)
        except Exception:
            continue
        if F.ndim == 2 and F.shape[1] == 3 and 4 <= len(F) <= most and np.isfinite(V).all():
            found.append((path.read_bytes(), path.suffix, V, F))
    return found


def damaged_mesh(V: np.ndarray, F: np.ndarray, rng: np.random.Generator) -> str:
    kind = rng.integers(5)
    size = np.ptp(V, axis=0).max()
    if kind == 0:
        F = F[rng.random(len(F)) > rng.choice([0.01, 0.1, 0.3])]
    elif kind == 1:
        turned = rng.random(len(F)) < 0.05
        F = np.where(turned[:, None], F[:, ::-1], F)
    elif kind == 2:
        V = V + rng.normal(scale=0.01 * size, size=V.shape)
    elif kind == 3:
        F = np.concatenate([F, F[rng.integers(len(F), size=len(F) // 20 + 1)]])
    if rng.random() < 0.02:
        V = V.copy()
        V[rng.integers(len(V))] = np.nan
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in V]
    lines += [f"f {a} {b} {c}" for a, b, c in F + 1]
    return "\n".join(lines) + "\n"


def damaged_bytes(data: bytes, rng: np.random.Generator) -> bytes:
    kind = rng.integers(4)
    out = bytearray(data)
    if kind == 0:
        return bytes(out[: rng.integers(len(out))])
    for _ in range(rng.integers(1, 40)):
        at = int(rng.integers(len(out)))
        if kind == 1:
            out[at] = int(rng.integers(256))
        elif kind == 2:
            out[at : at + 4] = b" 9e9"
        else:
            out[at : at + 3] = b"-1 "
    return bytes(out)


def main() -> None:
    data, count, out = Path(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3])
    rng = np.random.default_rng(int(sys.argv[4]) if len(sys.argv) > 4 else 0)
    meshes = sources(data, int(sys.argv[5]) if len(sys.argv) > 5 else 4000)
    whole = files(data)
    for k in range(count):
        original, suffix, V, F = meshes[int(rng.integers(len(meshes)))]
        folder = out / f"{k // 500:03d}"
        folder.mkdir(parents=True, exist_ok=True)
        if k % 10 == 9:
            (folder / f"{k:06d}{suffix}").write_bytes(damaged_bytes(original, rng))
        elif k % 10 == 4:
            path = whole[int(rng.integers(len(whole)))]
            (folder / f"{k:06d}{path.suffix}").write_bytes(path.read_bytes())
        else:
            (folder / f"{k:06d}.obj").write_text(damaged_mesh(V, F, rng))
    print(f"{count} inputs from {len(meshes)} meshes and {len(whole)} files")


if __name__ == "__main__":
    main()
