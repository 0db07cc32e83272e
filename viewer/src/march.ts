// Isosurfaces of sampled values, and values between samples.
import type { Triple } from "./scene";

export interface Grid {
  n: Triple;
  origin: Triple;
  spacing: Triple;
  values: Float32Array;
}

export interface Shell {
  positions: Float32Array;
  normals: Float32Array;
  triangles: Uint32Array;
}

// The six tetrahedra of a cell, by corner (bits x, y, z); all cells are cut alike, so faces match.
const tets = [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];

/** Triangles where the values take a level, with the normals of the field: triangles may be slivers, normals are not. */
export function march({ n, origin, spacing, values }: Grid, level: number): Shell {
  const stepY = n[0], stepZ = n[0] * n[1], points: number[] = [], normals: number[] = [], triangles: number[] = [];
  const made = new Map<number, number>();
  const offset = Array.from({ length: 8 }, (_, c) => (c & 1) + ((c >> 1) & 1) * stepY + (c >> 2) * stepZ);
  const steps = [1, stepY, stepZ], p = [0, 0, 0], q = [0, 0, 0], g = [0, 0, 0];

  const place = (v: number, into: number[]) => {
    into[0] = v % stepY;
    into[1] = Math.floor((v % stepZ) / stepY);
    into[2] = Math.floor(v / stepZ);
  };
  const addGradient = (v: number, at: number[], weight: number) => {
    for (let a = 0; a < 3; ++a) {
      const low = at[a] > 0 ? v - steps[a] : v, high = at[a] + 1 < n[a] ? v + steps[a] : v;
      const d = (values[high] - values[low]) / (((high - low) / steps[a]) * spacing[a]);
      if (Number.isFinite(d)) g[a] += weight * d;
    }
  };
  // Where the level is met between two corners of a cell, one of which has all bits of the other.
  const crossing = (base: number, one: number, two: number) => {
    const a = base + offset[one & two], b = base + offset[one | two], key = 8 * a + (one ^ two);
    let found = made.get(key);
    if (found === undefined) {
      const t = Math.min(1, Math.max(0, (level - values[a]) / (values[b] - values[a])));
      place(a, p);
      place(b, q);
      g[0] = g[1] = g[2] = 0;
      addGradient(a, p, 1 - t);
      addGradient(b, q, t);
      const length = Math.hypot(g[0], g[1], g[2]) || 1;
      found = points.length / 3;
      for (let k = 0; k < 3; ++k) {
        points.push(origin[k] + spacing[k] * (p[k] + t * (q[k] - p[k])));
        normals.push(g[k] / length);
      }
      made.set(key, found);
    }
    return found;
  };
  const below: number[] = [], above: number[] = [];
  for (let k = 0; k + 1 < n[2]; ++k) for (let j = 0; j + 1 < n[1]; ++j) for (let i = 0; i + 1 < n[0]; ++i) {
    const base = i + j * stepY + k * stepZ;
    let least = Infinity, greatest = -Infinity;
    for (let c = 0; c < 8; ++c) {
      const v = values[base + offset[c]];
      if (v < least) least = v;
      if (v > greatest) greatest = v;
    }
    if (least > level || greatest <= level || greatest === Infinity) continue;
    for (const tet of tets) {
      below.length = above.length = 0;
      for (const c of tet) (values[base + offset[c]] <= level ? below : above).push(c);
      const at = (one: number, two: number) => crossing(base, one, two);
      if (below.length === 1) triangles.push(at(below[0], above[0]), at(below[0], above[1]), at(below[0], above[2]));
      else if (below.length === 3) triangles.push(at(below[0], above[0]), at(below[1], above[0]), at(below[2], above[0]));
      else if (below.length === 2) {
        const a = at(below[0], above[0]), b = at(below[0], above[1]), c = at(below[1], above[1]), d = at(below[1], above[0]);
        triangles.push(a, b, c, a, c, d);
      }
    }
  }
  return { positions: Float32Array.from(points), normals: Float32Array.from(normals), triangles: Uint32Array.from(triangles) };
}

/** The value between samples, linear along each axis; infinite beside infinite ones, NaN outside of the grid. */
export function sample({ n, origin, spacing, values }: Grid, x: number, y: number, z: number): number {
  const place = [x, y, z], base = [0, 0, 0], part = [0, 0, 0];
  for (let a = 0; a < 3; ++a) {
    const at = (place[a] - origin[a]) / spacing[a];
    if (!(at >= -1e-4 && at <= n[a] - 1 + 1e-4)) return NaN;
    base[a] = Math.min(n[a] - 2, Math.max(0, Math.floor(at)));
    part[a] = Math.min(1, Math.max(0, at - base[a]));
  }
  let sum = 0;
  for (let c = 0; c < 8; ++c) {
    let weight = 1, node = 0;
    for (let a = 0, step = 1; a < 3; step *= n[a], ++a) {
      const up = (c >> a) & 1;
      weight *= up ? part[a] : 1 - part[a];
      node += step * (base[a] + up);
    }
    if (weight > 0) sum += weight * values[node];
  }
  return sum;
}
