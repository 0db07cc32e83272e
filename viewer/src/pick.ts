// What a ray meets: all triangles are tried, which takes 5 ms for 500 000 of them.

export interface Hit {
  /** Number of the triangle. */
  triangle: number;
  /** How far along the ray, whose direction has length 1. */
  distance: number;
  /** Barycentric coordinates. */
  b: [number, number, number];
}

export type Ray = { origin: ArrayLike<number>; direction: ArrayLike<number> };

/** The first triangle that a ray meets at a place that `kept` keeps (position x, y, z), from either side. */
export function pickTriangle(
  p: Float32Array, triangles: Uint32Array, ray: Ray, kept?: (x: number, y: number, z: number) => boolean,
): Hit | null {
  const [ox, oy, oz] = Array.from(ray.origin), [dx, dy, dz] = Array.from(ray.direction);
  let best = Infinity, found = -1, u = 0, v = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
    const ax = p[a], ay = p[a + 1], az = p[a + 2];
    const e1x = p[b] - ax, e1y = p[b + 1] - ay, e1z = p[b + 2] - az;
    const e2x = p[c] - ax, e2y = p[c + 1] - ay, e2z = p[c + 2] - az;
    const hx = dy * e2z - dz * e2y, hy = dz * e2x - dx * e2z, hz = dx * e2y - dy * e2x;
    const det = e1x * hx + e1y * hy + e1z * hz;
    if (det === 0) continue;
    const f = 1 / det, sx = ox - ax, sy = oy - ay, sz = oz - az;
    const r = f * (sx * hx + sy * hy + sz * hz);
    if (!(r >= -1e-7 && r <= 1.0000001)) continue;
    const qx = sy * e1z - sz * e1y, qy = sz * e1x - sx * e1z, qz = sx * e1y - sy * e1x;
    const s = f * (dx * qx + dy * qy + dz * qz);
    if (!(s >= -1e-7 && r + s <= 1.0000001)) continue;
    const d = f * (e2x * qx + e2y * qy + e2z * qz);
    if (!(d > 1e-9 && d < best)) continue;
    if (kept && !kept(ox + d * dx, oy + d * dy, oz + d * dz)) continue;
    best = d;
    found = t / 3;
    u = r;
    v = s;
  }
  return found < 0 ? null : { triangle: found, distance: best, b: [1 - u - v, u, v] };
}

/** A place of a surface as a line of a source file (docs/reference/curves.md): at a vertex or on an edge where it
 * is near one (by barycentric coordinates), inside the face otherwise. */
export function nodeLine(
  hit: Hit, triangles: Uint32Array, options: { face?: number; vertexOnly?: boolean; snap?: number } = {},
): string {
  const { face = hit.triangle, vertexOnly = false, snap = 0.06 } = options;
  const v = (k: number) => triangles[3 * hit.triangle + k];
  const nearest = hit.b.indexOf(Math.max(...hit.b)), least = hit.b.indexOf(Math.min(...hit.b));
  if (vertexOnly || hit.b[nearest] > 1 - snap) return `v ${v(nearest)}`;
  const text = (x: number) => String(Number(Math.min(1, Math.max(0, x)).toFixed(5)));
  if (hit.b[least] < snap / 2) {
    const i = (least + 1) % 3, j = (least + 2) % 3;
    return `e ${v(i)} ${v(j)} ${text(hit.b[j] / (hit.b[i] + hit.b[j]))}`;
  }
  const b = hit.b.map((x) => Math.max(0, x));
  return `f ${face} ${text(b[0])} ${text(b[1])} ${text(1 - Number(text(b[0])) - Number(text(b[1])))}`;
}
