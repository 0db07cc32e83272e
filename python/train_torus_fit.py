"""Trains the learned fit of tori: how much each neighbour of a point counts.

usage: train_torus_fit.py OUT.txt [--minutes 5] [--clouds 150] [--seed 1]
needs numpy, scipy and jax (PyPI; the processor alone will do), six minutes of one core

The fit stays the least squares of methods/tori/torus_fit.cpp. A small network that sees what does
not change under rotation (distances, heights, angles of normals) multiplies the weights of its
equations; untrained it multiplies by one. Minimised is the error of the blended field, relative to
that of the closed form on the same cloud.
"""

import argparse
import time
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
from scipy.spatial import cKDTree

from train_shapes import Cloud, make_cloud

NEIGHBOURS, CLOSED = 16, 8  # seen by the network; of the closed form
FEATURES, HIDDEN = 8, 24
BLENDED, SHARPNESS = 12, 8.0
LIMIT = 6.0  # of logarithms of weights

Array = jax.Array
Net = list[tuple[Array, Array]]  # layers: matrix (outputs x inputs), offset
Tori = dict[str, Array]


def untrained(seed: int) -> Net:
    random = np.random.default_rng(seed)

    def layer(inputs: int, outputs: int, size: float = 1) -> tuple[Array, Array]:
        matrix = size * random.normal(size=(outputs, inputs)) * np.sqrt(2 / inputs)
        return jnp.array(matrix, jnp.float32), jnp.zeros(outputs, jnp.float32)

    return [
        layer(FEATURES, HIDDEN),  # of a neighbour
        layer(2 * HIDDEN, HIDDEN),  # of their means and largest ones: the context
        layer(2 * HIDDEN, HIDDEN),  # of a neighbour in its context
        layer(HIDDEN, 2, 0),  # log weights of a neighbour's height and normal
        layer(HIDDEN, 2, 0),  # log weights of the point itself and of its torus
    ]


def apply(layer: tuple[Array, Array], x: Array) -> Array:
    return x @ layer[0].T + layer[1]


def predict(net: Net, features: Array) -> tuple[Array, Array]:
    h = jax.nn.relu(apply(net[0], features))
    c = jax.nn.relu(apply(net[1], jnp.concatenate([h.mean(-2), h.max(-2)], -1)))
    both = jnp.concatenate([h, jnp.broadcast_to(c[..., None, :], h.shape)], -1)
    out = apply(net[3], jax.nn.relu(apply(net[2], both)))
    return jnp.clip(out, -LIMIT, LIMIT), jnp.clip(apply(net[4], c), -LIMIT, LIMIT)


def dot(a: Array, b: Array) -> Array:
    return (a * b).sum(-1)


def unit(a: Array) -> Array:
    return a / jnp.sqrt(dot(a, a) + 1e-20)[..., None]


def fit(net: Net, p: Array, n: Array, pj: Array, m: Array) -> Tori:
    """Tori of points p with normals n and neighbours pj (points x NEIGHBOURS x 3), normals m."""
    d = pj - p[:, None]
    dist = jnp.sqrt(dot(d, d) + 1e-20)
    scale, rho = dist[:, CLOSED - 1], dist[:, 5]
    d, r = d / scale[:, None, None], dist / scale[:, None]
    aside = jnp.where(jnp.abs(n[:, :1]) > 0.9, jnp.array([0.0, 1, 0]), jnp.array([1.0, 0, 0]))
    s = unit(jnp.cross(n, aside))
    t = jnp.cross(n, s)
    S, T, H = dot(d, s[:, None]), dot(d, t[:, None]), dot(d, n[:, None])
    A, B, C = dot(m, s[:, None]), dot(m, t[:, None]), dot(m, n[:, None])
    flat = S * S + T * T
    apart = jnp.maximum(r, 0.05)
    rises, seen = H / apart, dot(d, m) / apart  # either point from the other's plane
    inverse = 1 / jnp.sqrt(flat + 1e-8)
    along, across = (A * S + B * T) * inverse, jnp.abs(A * T - B * S) * inverse
    features = jnp.stack(
        [jnp.minimum(r, 4), rises, seen, C, along, across, jnp.abs(rises), jnp.abs(seen)], -1
    )
    out, own = predict(net, features)
    base = jnp.where(jnp.arange(NEIGHBOURS) < CLOSED, 1.0, np.exp(-4.0)) / apart**2
    w, v = base * jnp.exp(out[..., 0]), 0.25 * base * jnp.exp(out[..., 1])
    height = H * flat / (flat + H * H + 1e-12)
    one, zero = jnp.ones_like(S), jnp.zeros_like(S)
    rows = jnp.concatenate(
        [
            jnp.stack([one, T, S, S * T, T * T, S * S], -1),
            jnp.stack([zero, zero, one, T, zero, 2 * S], -1),
            jnp.stack([zero, one, zero, S, 2 * T, zero], -1),
        ],
        1,
    )
    value, weight = jnp.concatenate([height, -A, -B], 1), jnp.concatenate([w, v, v], 1)
    weighted = rows * weight[..., None]
    M = jnp.swapaxes(weighted, 1, 2) @ rows + jnp.diag(jnp.array([0, 0, 0, 1, 1, 1]) * 1e-3 + 1e-6)
    M = M.at[:, 0, 0].add(1.5 * jnp.exp(own[:, 0]))
    a = jnp.linalg.solve(M, (weighted * value[..., None]).sum(1)[..., None])[..., 0]
    da = a[:, 2:3] + a[:, 3:4] * T + 2 * a[:, 5:] * S + A
    db = a[:, 1:2] + a[:, 3:4] * S + 2 * a[:, 4:5] * T + B
    residual = jnp.sqrt((v * (da * da + db * db)).sum(1) / v.sum(1) + 1e-12)
    # Curvatures and directions, in units of scale.
    a01, a10 = a[:, 1], a[:, 2]
    size = jnp.sqrt(1 + a10 * a10 + a01 * a01)
    normal = (n - a10[:, None] * s - a01[:, None] * t) / size[:, None]
    Qs, Qt = s + a10[:, None] * n, t + a01[:, None] * n
    f1 = unit(Qs)
    f2 = jnp.cross(normal, f1)
    j11, j12, j22 = dot(f1, Qs), dot(f1, Qt), dot(f2, Qt)
    # W = J^-T II J^-1 with J = [j11 j12; 0 j22].
    l11, l12, l22 = 2 * a[:, 5] / size, a[:, 3] / size, 2 * a[:, 4] / size
    w11 = l11 / j11**2
    w12 = (l12 - l11 * j12 / j11) / (j11 * j22)
    w22 = (l22 - 2 * l12 * j12 / j11 + l11 * (j12 / j11) ** 2) / j22**2
    mean, half = (w11 + w22) / 2, (w11 - w22) / 2
    radius = jnp.sqrt(half * half + w12 * w12 + 1e-10)
    angle = 0.5 * jnp.arctan2(w12, half + 1e-5)
    larger = jnp.cos(angle)[:, None] * f1 + jnp.sin(angle)[:, None] * f2
    swap = mean > 0
    limit = 3 * scale / rho
    k1 = jnp.clip(jnp.where(swap, mean - radius, mean + radius), -limit, limit)
    k2 = jnp.clip(jnp.where(swap, mean + radius, mean - radius), -limit, limit)
    confidence = -20 * jnp.abs(a[:, 0]) * scale / rho - 4 * residual + own[:, 1]
    return {
        "q": p + (a[:, 0] * scale)[:, None] * n,
        "n": normal,
        "e1": jnp.where(swap[:, None], jnp.cross(normal, larger), larger),
        "k1": k1 / scale,
        "k2": k2 / scale,
        "rho": rho,
        "c": jnp.clip(confidence, -10, 0),
    }


def circle(k: Array, u2: Array, w: Array) -> Array:
    a = w - 0.5 * k * (u2 + w * w)
    return 2 * a / (1 + jnp.sqrt(jnp.maximum(1 - 2 * k * a, 1e-8)))


def safe(x: Array) -> Array:
    return jnp.where(jnp.abs(x) < 1e-3, 1e-3, x)


def patch(t: Tori, rows: Array, x: Array) -> Array:
    """Distance of places x (m x 3) to the patches of tori rows (m x BLENDED)."""
    n, e1, k1, k2 = t["n"][rows], t["e1"][rows], t["k1"][rows], t["k2"][rows]
    y = x[:, None] - t["q"][rows]
    u, v, w = dot(y, e1), dot(y, jnp.cross(n, e1)), dot(y, n)
    c = circle(k1, u * u, w)
    g = circle(k2, v * v, c)
    a, b = safe(1 - k1 * c), safe(1 - k2 * g)
    through = (1 - k2 * c) / b
    fu, fv = u - g * through * (-k1 * u) / a, v - g * (-k2 * v / b)
    fw = w - g * through * (1 - k1 * w) / a
    limit = 1.5 * t["rho"][rows]
    shrink = limit / jnp.sqrt(fu * fu + fv * fv + 1e-12)
    pu, pv = fu * shrink, fv * shrink
    lift = 0.5 * (k1 * pu * pu + k2 * pv * pv)
    size = jnp.sqrt((u - pu) ** 2 + (v - pv) ** 2 + (w - lift) ** 2 + 1e-12)
    far = fu * fu + fv * fv + fw * fw > limit * limit
    return jnp.where(far, jnp.where(g < 0, -size, size), g)


def blend(t: Tori, x: Array, rows: Array, d: Array) -> tuple[Array, Array]:
    """Eq. 5.1 as in methods/tori/tori.cpp, and the same kept near the distance to the points."""
    near = (1 - d / d[:, -1:]) ** 2 + 1e-9
    rho = (near * t["rho"][rows]).sum(1, keepdims=True) / near.sum(1, keepdims=True)
    decay = jnp.exp(-SHARPNESS * (d - d[:, :1]) / rho)
    w = jnp.exp(t["c"][rows]) * (decay - decay[:, -1:]) + 1e-7
    phi = (w * patch(t, rows, x)).sum(1) / w.sum(1)
    least = jnp.maximum(d[:, 0] - rho[:, 0], 0)
    size = jnp.minimum(jnp.maximum(jnp.abs(phi), least), d[:, 0])
    return phi, jnp.where(phi < 0, -size, size)


class Sample:
    """A cloud with its neighbours found."""

    def __init__(self, cloud: Cloud) -> None:
        tree = cKDTree(cloud.points)
        self.neighbours = tree.query(cloud.points, NEIGHBOURS + 1)[1][:, 1:]
        d, self.rows = tree.query(cloud.queries, BLENDED)
        self.p, self.n = cloud.points.astype("f4"), cloud.normals.astype("f4")
        self.x, self.phi = cloud.queries.astype("f4"), cloud.distance.astype("f4")
        self.d = d.astype("f4")
        self.base = 1.0

    def data(self, some: np.ndarray) -> tuple[np.ndarray, ...]:
        j = self.neighbours
        fitted = (self.p, self.n, self.p[j], self.n[j])
        return (*fitted, self.x[some], self.rows[some], self.d[some], self.phi[some])


@jax.jit
def errors(net: Net, data: tuple[Array, ...]) -> tuple[Array, Array]:
    """Mean errors of the blend, and of what is kept of it near the distance to the points."""
    p, n, pj, m, x, rows, d, phi = data
    free, kept = blend(fit(net, p, n, pj, m), x, rows, d)
    return jnp.abs(free - phi).mean(), jnp.abs(kept - phi).mean()


def loss(net: Net, data: tuple[Array, ...], base: float) -> Array:
    free, kept = errors(net, data)
    return (kept + 0.1 * free) / base


@jax.jit
def adam(
    net: Net, state: tuple[Net, Net], data: tuple[Array, ...], base: float, rate: float, step: int
) -> tuple[Net, tuple[Net, Net], Array]:
    """One step of Adam on a gradient no longer than one; none where it is not finite."""
    value, g = jax.value_and_grad(loss)(net, data, base)
    size = jnp.sqrt(sum((x * x).sum() for x in jax.tree.leaves(g)))
    good = jnp.isfinite(size)
    g = jax.tree.map(lambda x: jnp.where(good, x / jnp.maximum(size, 1), 0), g)
    first = jax.tree.map(lambda a, b: 0.9 * a + 0.1 * b, state[0], g)
    second = jax.tree.map(lambda a, b: 0.999 * a + 0.001 * b * b, state[1], g)
    scale = rate * jnp.sqrt(1 - 0.999**step) / (1 - 0.9**step)
    net = jax.tree.map(lambda x, a, b: x - scale * a / (jnp.sqrt(b) + 1e-8), net, first, second)
    return net, (first, second), value


def mean_error(net: Net, sample: Sample) -> float:
    return float(errors(net, sample.data(np.arange(len(sample.x))))[1])


def ratio(net: Net, samples: list[Sample]) -> float:
    return float(np.mean([mean_error(net, s) / s.base for s in samples]))


def write(net: Net, path: Path, note: str) -> None:
    """Layers in order, each as rows, columns, its matrix by rows, its offsets."""
    lines = ["littoral-torus-fit 1", f"# {note}"]
    for matrix, offset in net:
        lines.append(f"{matrix.shape[0]} {matrix.shape[1]}")
        lines += [" ".join(f"{x:.5g}" for x in row) for row in np.asarray(matrix)]
        lines.append(" ".join(f"{x:.5g}" for x in np.asarray(offset)))
    path.write_text("\n".join(lines) + "\n")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("out", type=Path)
    parser.add_argument("--minutes", type=float, default=5)
    parser.add_argument("--clouds", type=int, default=150)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    random = np.random.default_rng(asked.seed)
    net, samples = untrained(asked.seed), []
    start = time.process_time()
    for seed in range(asked.clouds):
        cloud = make_cloud(1000 * asked.seed + seed)
        if cloud is None:
            continue
        sample = Sample(cloud)
        sample.base = mean_error(net, sample) + 3e-4
        if np.isfinite(sample.base) and sample.base < 0.2:
            samples.append(sample)
    held, used = samples[::10], [s for i, s in enumerate(samples) if i % 10]
    closed = np.mean([s.base for s in samples])
    took = time.process_time() - start
    print(f"{len(samples)} clouds, {took:.0f} s; closed form {closed:.2e}", flush=True)
    zero = jax.tree.map(jnp.zeros_like, net)
    state, step, losses = (zero, zero), 0, []
    start, total = time.process_time(), 60 * asked.minutes
    while (passed := (time.process_time() - start) / total) < 1:
        rate = 2e-3 * min(1, (step + 1) / 100) * (0.5 + 0.5 * np.cos(np.pi * passed))
        s = used[random.integers(len(used))]
        some = random.choice(len(s.x), 600, replace=False)
        step += 1
        net, state, value = adam(net, state, s.data(some), s.base, rate, step)
        losses.append(float(value))
        if step % 500 == 0:
            mean = np.nanmean(losses[-500:])
            print(f"step {step}: loss {mean:.3f}, held back {ratio(net, held):.3f}", flush=True)
            write(net, asked.out, f"step {step}, seed {asked.seed}")
    end = ratio(net, held)
    print(f"step {step}: held back {end:.3f} of the closed form's error")
    write(net, asked.out, f"seed {asked.seed}, {step} steps, held-back clouds {end:.3f} of closed")


if __name__ == "__main__":
    main()
