// How much of the sky is seen from places of a surface, as the library does it (io/render/openness.cpp): from 64
// directions, by pictures of heights.
import type { Grid } from "./march";

const directions = 64;

// Evenly spread, along a spiral from pole to pole.
function direction(i: number): [number, number, number] {
  const z = 1 - (2 * i + 1) / directions, r = Math.sqrt(1 - z * z), angle = i * Math.PI * (3 - Math.sqrt(5));
  return [r * Math.cos(angle), r * Math.sin(angle), z];
}

/** How far up the highest surface is at each pixel; all in pixels. */
function heightMap(p: Float32Array, triangles: Uint32Array, side: number): Float32Array {
  const heights = new Float32Array(side * side).fill(-Infinity);
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
    const ax = p[a], ay = p[a + 1], bx = p[b], by = p[b + 1], cx = p[c], cy = p[c + 1];
    const x0 = Math.floor(Math.min(ax, bx, cx) + 0.5), x1 = Math.min(side, Math.floor(Math.max(ax, bx, cx) + 0.5)) - 1;
    if (x0 > x1) continue;  // between the middles of pixels, as most small ones are
    const y0 = Math.floor(Math.min(ay, by, cy) + 0.5), y1 = Math.min(side, Math.floor(Math.max(ay, by, cy) + 0.5)) - 1;
    if (y0 > y1) continue;
    const area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    if (!(Math.abs(area) > 1e-12)) continue;
    for (let y = y0; y <= y1; ++y) for (let x = x0; x <= x1; ++x) {
      const px = x + 0.5, py = y + 0.5;
      const u = ((bx - px) * (cy - py) - (by - py) * (cx - px)) / area, v = ((px - ax) * (cy - ay) - (py - ay) * (cx - ax)) / area;
      const w = 1 - u - v;
      if (u < -1e-5 || v < -1e-5 || w < -1e-5) continue;
      const height = u * p[a + 2] + v * p[b + 2] + w * p[c + 2], i = x + side * y;
      if (height > heights[i]) heights[i] = height;
    }
  }
  return heights;
}

/** Takes the lowest of each pixel and its neighbours: then nothing that is flat hides itself. */
function lower(heights: Float32Array, side: number): void {
  for (const [step, across] of [[1, side], [side, 1]]) for (let j = 0; j < side; ++j) {
    let before = Infinity, i = j * across, here = heights[i];
    for (let k = 0; k < side; ++k, i += step) {
      const after = k + 1 < side ? heights[i + step] : Infinity;
      heights[i] = Math.min(before, here, after);
      before = here;
      here = after;
    }
  }
}

const byte = (x: number) => Math.round(255 * Math.min(1, Math.max(0, x)));

/** The openness of vertices as a scene has it (docs/reference/scene.md); stops after each direction. */
export function* opennessSteps(positions: Float32Array, triangles: Uint32Array): Generator<void, Uint8Array> {
  const count = positions.length / 3, used = new Uint8Array(count), out = new Uint8Array(4 * count);
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let v = 0; v < count; ++v) out.set([128, 128, 128, 255], 4 * v);
  for (let i = 0; i < triangles.length; ++i) used[triangles[i]] = 1;
  for (let v = 0; v < count; ++v) if (used[v]) for (let k = 0; k < 3; ++k) {
    low[k] = Math.min(low[k], positions[3 * v + k]);
    high[k] = Math.max(high[k], positions[3 * v + k]);
  }
  const centre = low.map((x, k) => 0.5 * (x + high[k]));
  let size = 0;  // of the ball about all
  for (let v = 0; v < count; ++v) if (used[v])
    size = Math.max(size, Math.hypot(...centre.map((x, k) => positions[3 * v + k] - x)));
  if (!(size > 0)) return out;
  const side = count < 50000 ? 256 : 512, scale = (0.5 * (side - 4)) / size, [ox, oy, oz] = centre;
  const p = new Float32Array(3 * count), sum = new Float32Array(4 * count);  // 3 (sum of d), sum of 1, over what is seen
  for (let i = 0; i < directions; ++i) {
    const d = direction(i), r = Math.hypot(d[0], d[1]), a = [-d[1] / r, d[0] / r, 0];
    const b = [d[1] * a[2] - d[2] * a[1], d[2] * a[0] - d[0] * a[2], d[0] * a[1] - d[1] * a[0]];
    for (let k = 0; k < 3 * count; k += 3) {
      const x = scale * (positions[k] - ox), y = scale * (positions[k + 1] - oy), z = scale * (positions[k + 2] - oz);
      p[k] = a[0] * x + a[1] * y + a[2] * z + 0.5 * side;
      p[k + 1] = b[0] * x + b[1] * y + b[2] * z + 0.5 * side;
      p[k + 2] = d[0] * x + d[1] * y + d[2] * z;
    }
    const heights = heightMap(p, triangles, side);
    lower(heights, side);
    for (let v = 0; v < count; ++v) {
      const x = Math.min(side - 1, Math.max(0, Math.floor(p[3 * v]))), y = Math.min(side - 1, Math.max(0, Math.floor(p[3 * v + 1])));
      if (!(p[3 * v + 2] >= heights[x + side * y] - 1)) continue;
      sum[4 * v] += 3 * d[0];
      sum[4 * v + 1] += 3 * d[1];
      sum[4 * v + 2] += 3 * d[2];
      sum[4 * v + 3] += 1;
    }
    yield;
  }
  for (let v = 0; v < count; ++v) if (used[v]) {
    for (let k = 0; k < 3; ++k) out[4 * v + k] = byte((sum[4 * v + k] / directions + 0.75) / 1.5);
    out[4 * v + 3] = byte(sum[4 * v + 3] / directions);
  }
  return out;
}

/** Openness at the nodes of a grid from that of vertices in its cells, four a node: for what passes near them. */
export function onGrid({ n, origin, spacing }: Pick<Grid, "n" | "origin" | "spacing">, positions: Float32Array, open: Uint8Array): Uint8Array {
  const nodes = n[0] * n[1] * n[2], sum = new Float32Array(4 * nodes), weight = new Float32Array(nodes);
  const steps = [1, n[0], n[0] * n[1]], out = new Uint8Array(4 * nodes), base = [0, 0, 0], part = [0, 0, 0];
  for (let v = 0; v < positions.length / 3; ++v) {
    for (let a = 0; a < 3; ++a) {
      const at = (positions[3 * v + a] - origin[a]) / spacing[a];
      base[a] = Math.min(n[a] - 2, Math.max(0, Math.floor(at)));
      part[a] = at - base[a];
    }
    for (let c = 0; c < 8; ++c) {
      let w = 1e-6, node = 0;
      for (let a = 0, all = 1; a < 3; ++a) {
        const up = (c >> a) & 1;
        all *= up ? part[a] : 1 - part[a];
        node += steps[a] * (base[a] + up);
        if (a === 2) w += Math.max(0, all);
      }
      for (let k = 0; k < 4; ++k) sum[4 * node + k] += w * open[4 * v + k];
      weight[node] += w;
    }
  }
  const put = (i: number, total: number, at: (k: number) => number) => {
    for (let k = 0; k < 4; ++k) out[4 * i + k] = total > 0 ? Math.round(at(k) / total) : k < 3 ? 128 : 255;
  };
  const around = steps.flatMap((step) => [-step, step]), total = [0, 0, 0, 0];
  for (let i = 0; i < nodes; ++i) {
    if (weight[i] > 0) {
      put(i, weight[i], (k) => sum[4 * i + k]);
      continue;
    }
    let found = 0;  // the mean of its neighbours: what passes here is beside the vertices, not among them
    total.fill(0);
    for (const step of around) if (weight[i + step] > 0) {
      ++found;
      for (let k = 0; k < 4; ++k) total[k] += sum[4 * (i + step) + k] / weight[i + step];
    }
    put(i, found, (k) => total[k]);
  }
  return out;
}

/** A question for the openness of a surface's vertices. */
export interface Asked {
  job: number;
  positions: Float32Array;
  triangles: Uint32Array;
}

const atOnce = 8;  // directions

/** What takes questions, a few directions at a time: of several only the newest is answered. */
export function follow(done: (open: Uint8Array, job: number) => void): (asked: Asked) => void {
  let newest = 0;
  return ({ job, positions, triangles }) => {
    newest = job;
    const steps = opennessSteps(positions, triangles), go = () => {
      if (job !== newest) return;
      for (let i = 0; i < atOnce; ++i) {
        const { done: ended, value } = steps.next();
        if (ended) return done(value as Uint8Array, job);
      }
      setTimeout(go);
    };
    setTimeout(go);
  };
}
