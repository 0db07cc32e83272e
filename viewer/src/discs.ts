// A point cloud as discs: a square about each, of which the shader keeps what is inside of the rim.
import * as THREE from "three";
import { gradients, someTriangle } from "./mesh";
import { cornerReader } from "./field";
import type { Hit, Ray } from "./pick";
import type { Field, Surface } from "./scene";

const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]] as const;

export class Discs {
  readonly geometry = new THREE.BufferGeometry();
  private readonly count: number;
  private readonly reach: Float32Array; // of the corners from their points, three numbers each
  private triangleOf: Int32Array | null = null;

  constructor(private readonly surface: Surface, private readonly discs: Float32Array) {
    const { positions: p, openness } = surface, n = (this.count = discs.length / 4), g = this.geometry;
    const place = new Float32Array(12 * n), normal = new Float32Array(12 * n), rim = new Float32Array(8 * n), index = new Uint32Array(6 * n);
    this.reach = new Float32Array(12 * n);
    for (let v = 0; v < n; ++v) {
      const [x, y, z, r] = discs.subarray(4 * v, 4 * v + 4);
      // Two directions across: the first away from the normal's largest part.
      const side = Math.abs(x) < 0.6 ? [0, -z, y] : [z, 0, -x], size = Math.hypot(...side) || 1, a = side.map((c) => c / size);
      const b = [y * a[2] - z * a[1], z * a[0] - x * a[2], x * a[1] - y * a[0]];
      corners.forEach(([i, j], k) => {
        const at = 4 * v + k;
        for (let c = 0; c < 3; ++c) {
          this.reach[3 * at + c] = r * (i * a[c] + j * b[c]);
          place[3 * at + c] = p[3 * v + c] + this.reach[3 * at + c];
        }
        normal.set([x, y, z], 3 * at);
        rim.set([i, j], 2 * at);
      });
      index.set([0, 1, 2, 0, 2, 3].map((k) => 4 * v + k), 6 * v);
    }
    g.setAttribute("position", new THREE.BufferAttribute(place, 3));
    g.setAttribute("normal", new THREE.BufferAttribute(normal, 3));
    g.setAttribute("rim", new THREE.BufferAttribute(rim, 2));
    g.setIndex(new THREE.BufferAttribute(index, 1));
    g.boundingSphere = new THREE.Sphere(new THREE.Vector3(), 1.5);
    if (openness) {
      const open = new Uint8Array(16 * n);
      for (let c = 0; c < 4 * n; ++c) open.set(openness.subarray(4 * (c >> 2), 4 * (c >> 2) + 4), 4 * c);
      g.setAttribute("openness", new THREE.BufferAttribute(open, 4, true));
    }
  }

  /** A field at vertices: on each disc it goes on as steeply as it is about the point. */
  setField(field: Field): void {
    const { positions: p, triangles } = this.surface, values = field.values ?? new Float32Array(this.count);
    const slope = new Float32Array(3 * this.count), area = new Float32Array(this.count);
    if (!field.discrete) {
      const each = gradients(p, triangles, cornerReader(field, this.surface));
      for (let c = 0; c < triangles.length; ++c) {
        const v = triangles[c], t = Math.floor(c / 3);
        for (let k = 0; k < 3; ++k) slope[3 * v + k] += each[3 * t + k];
        ++area[v];
      }
    }
    const t = new Float32Array(4 * this.count), infinite = new Uint8Array(4 * this.count);
    for (let c = 0; c < 4 * this.count; ++c) {
      const v = c >> 2, value = values[v];
      if (!Number.isFinite(value)) infinite[c] = 255;
      else t[c] = value + [0, 1, 2].reduce((sum, k) => sum + slope[3 * v + k] * this.reach[3 * c + k], 0) / Math.max(1, area[v]);
    }
    this.geometry.setAttribute("t", new THREE.BufferAttribute(t, 1));
    this.geometry.setAttribute("infinite", new THREE.BufferAttribute(infinite, 1, true));
  }

  /** The first disc that a ray meets, as the corner of a triangle. */
  pick({ origin, direction }: Ray, kept: (x: number, y: number, z: number) => boolean): Hit | null {
    const { positions: p, triangles } = this.surface, d = this.discs;
    let best = Infinity, found = -1;
    this.triangleOf ??= someTriangle(triangles, p.length / 3);
    for (let v = 0; v < this.count; ++v) {
      const nx = d[4 * v], ny = d[4 * v + 1], nz = d[4 * v + 2], x = p[3 * v] - origin[0], y = p[3 * v + 1] - origin[1], z = p[3 * v + 2] - origin[2];
      const at = (nx * x + ny * y + nz * z) / (nx * direction[0] + ny * direction[1] + nz * direction[2]);
      if (!(at > 1e-9 && at < best) || this.triangleOf[v] < 0) continue;
      if ((at * direction[0] - x) ** 2 + (at * direction[1] - y) ** 2 + (at * direction[2] - z) ** 2 > d[4 * v + 3] ** 2) continue;
      if (!kept(origin[0] + at * direction[0], origin[1] + at * direction[1], origin[2] + at * direction[2])) continue;
      best = at;
      found = v;
    }
    if (found < 0) return null;
    const triangle = this.triangleOf[found];
    return { triangle, distance: best, b: [0, 1, 2].map((k) => (triangles[3 * triangle + k] === found ? 1 : 0)) as [number, number, number] };
  }
}
