// The page's units: the model's box about the origin with half its diagonal 1, in single precision.

export type Triple = [number, number, number];

export interface Frame {
  readonly centre: Triple;
  readonly radius: number;
  readonly towardsEye: Triple;
  readonly up: Triple;
}

const cross = (a: Triple, b: Triple): Triple =>
  [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

function unit(a: Triple): Triple {
  const length = Math.hypot(...a) || 1;
  return [a[0] / length, a[1] / length, a[2] / length];
}

/** Second moments xx, xy, yy of the triangles' corners by area (of points: all alike) in two axes. */
function moments(positions: Float64Array, triangles: Uint32Array, x: number, y: number): Triple {
  let weight = 0, mx = 0, my = 0, xx = 0, xy = 0, yy = 0;
  const add = (v: number, w: number) => {
    const a = positions[3 * v + x], b = positions[3 * v + y];
    if (!Number.isFinite(a * b)) return;
    weight += w;
    mx += w * a; my += w * b;
    xx += w * a * a; xy += w * a * b; yy += w * b * b;
  };
  for (let t = 0; t < triangles.length; t += 3) {
    const [p, q, r] = [0, 1, 2].map((k) => [0, 1, 2].map((i) => positions[3 * triangles[t + k] + i]) as Triple);
    const side = (a: Triple, b: Triple) => a.map((c, i) => b[i] - c) as Triple;
    const area = Math.hypot(...cross(side(p, q), side(p, r)));
    for (let k = 0; k < 3; ++k) add(triangles[t + k], area);
  }
  if (!triangles.length) for (let v = 0; 3 * v < positions.length; ++v) add(v, 1);
  if (!(weight > 0)) return [1, 0, 1];
  return [xx / weight - (mx / weight) ** 2, xy / weight - (mx * my) / weight ** 2, yy / weight - (my / weight) ** 2];
}

/** As io/render/scene_frame.cpp: along the shorter horizontal principal axis, which shows the most,
 * turned by 30 degrees and from above; flat things are seen face-on. */
export function frameOf(positions: Float64Array, triangles: Uint32Array, up: "y" | "z"): Frame {
  const low: Triple = [Infinity, Infinity, Infinity], high: Triple = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; ++i) {
    const x = positions[i], k = i % 3;
    if (!Number.isFinite(x)) continue;
    if (x < low[k]) low[k] = x;
    if (x > high[k]) high[k] = x;
  }
  const centre = low.map((x, k) => (x + high[k]) / 2) as Triple;
  const half = low.map((x, k) => (high[k] - x) / 2) as Triple;
  const radius = Math.hypot(...half) || 1, flat = half.findIndex((x) => x < 1e-4 * radius);
  // Axes to the right, up, and to the front: x y z, or x z -y.
  const [r, u, f, sign] = up === "y" ? [0, 1, 2, 1] : [0, 2, 1, -1];
  let eye: Triple = [0, 0, 0];
  let axis: Triple = up === "y" ? [0, 1, 0] : [0, 0, 1];
  if (flat >= 0) {
    eye[flat] = 1;
    if (flat === u) axis = flat === 1 ? [0, 0, -1] : [0, 1, 0];
  } else {
    const [xx, xy, yy] = moments(positions, triangles, r, f);
    const mean = (xx + yy) / 2, apart = Math.hypot((xx - yy) / 2, xy), widest = Math.atan2(sign * xy, (xx - yy) / 2) / 2;
    let front: [number, number] = [0, 1];
    if (mean - apart < 0.64 * (mean + apart)) front = [-Math.sin(widest), Math.cos(widest)];
    if (front[1] < -0.3 || (front[1] < 0.3 && front[0] < 0)) front = [-front[0], -front[1]];
    const turn = Math.PI / 6, lift = Math.PI / 9, [a, b] = front;
    eye[r] = Math.cos(lift) * (Math.cos(turn) * a + Math.sin(turn) * b);
    eye[f] = sign * Math.cos(lift) * (Math.cos(turn) * b - Math.sin(turn) * a);
    eye[u] = Math.sin(lift);
    eye = unit(eye);
  }
  return { centre, radius, towardsEye: eye, up: unit(cross(eye, cross(axis, eye))) };
}

export function toPage(positions: Float64Array, { centre, radius }: Frame): Float32Array {
  const out = new Float32Array(positions.length);
  for (let i = 0; i < positions.length; ++i) {
    const x = (positions[i] - centre[i % 3]) / radius;
    out[i] = Number.isFinite(x) ? x : 0;
  }
  return out;
}
