// What is under the pointer: a place of the surface, found by a tree of boxes.
import * as THREE from "three";
import { MeshBVH } from "three-mesh-bvh";
import type { SurfacePoint } from "littoral/inline";

export interface Hit {
  /** The triangle, or -1 on clouds. */
  readonly triangle: number;
  readonly barycentric: readonly [number, number, number];
  /** The nearest corner; the point of a cloud. */
  readonly vertex: number;
  /** In the page's units. */
  readonly place: THREE.Vector3;
}

/** Of triangles in the page's units. */
export class Picker {
  private readonly tree: MeshBVH | null;
  private readonly corners = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()] as const;

  constructor(private readonly positions: Float32Array, private readonly triangles: Uint32Array) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
    this.tree = triangles.length ? new MeshBVH(geometry, { indirect: true }) : null;
  }

  /** Where the ray first meets the surface; of a cloud the first point nearer to it than 1 in 100. */
  along(ray: THREE.Ray): Hit | null {
    if (!this.tree) return this.pointNear(ray);
    const hit = this.tree.raycastFirst(ray, THREE.DoubleSide);
    return hit && typeof hit.faceIndex === "number" ? this.inTriangle(hit.faceIndex, hit.point) : null;
  }

  /** The normal of the surface near a place. */
  normalAt(place: THREE.Vector3, out: THREE.Vector3): THREE.Vector3 {
    const hit = this.tree?.closestPointToPoint(place);
    if (!hit) return out.set(0, 0, 0);
    this.take(hit.faceIndex);
    return THREE.Triangle.getNormal(...this.corners, out);
  }

  /** Is something between the eye and a place of the surface? */
  hidden(eye: THREE.Vector3, place: THREE.Vector3): boolean {
    if (!this.tree) return false;
    const to = place.clone().sub(eye), distance = to.length();
    const hit = this.tree.raycastFirst(new THREE.Ray(eye, to.divideScalar(distance)), THREE.DoubleSide);
    return hit !== null && hit.distance < distance - 0.004;
  }

  private take(triangle: number): void {
    this.corners.forEach((corner, k) => corner.fromArray(this.positions, 3 * this.triangles[3 * triangle + k]));
  }

  private inTriangle(triangle: number, place: THREE.Vector3): Hit {
    this.take(triangle);
    const b = THREE.Triangle.getBarycoord(place, ...this.corners, new THREE.Vector3()) ?? new THREE.Vector3(1, 0, 0);
    const inside = [b.x, b.y, b.z].map((x) => Math.max(0, x));
    const sum = inside[0] + inside[1] + inside[2], largest = inside.indexOf(Math.max(...inside));
    return {
      triangle, place,
      // Six digits are a millionth of a face; the last follows from the others, so that the sum is 1.
      barycentric: rounded(inside[0] / sum, inside[1] / sum),
      vertex: this.triangles[3 * triangle + largest],
    };
  }

  private pointNear(ray: THREE.Ray): Hit | null {
    const p = new THREE.Vector3();
    let best = -1, nearest = Infinity;
    for (let i = 0; 3 * i < this.positions.length; ++i) {
      p.fromArray(this.positions, 3 * i);
      const off = ray.distanceSqToPoint(p), deep = p.sub(ray.origin).dot(ray.direction);
      const cost = deep + 400 * off;
      if (off < 4e-4 && cost < nearest) {
        nearest = cost;
        best = i;
      }
    }
    if (best < 0) return null;
    return { triangle: -1, barycentric: [1, 0, 0], vertex: best, place: new THREE.Vector3().fromArray(this.positions, 3 * best) };
  }
}

function rounded(a: number, b: number): [number, number, number] {
  const x = Math.round(a * 1e6) / 1e6, y = Math.min(Math.round(b * 1e6) / 1e6, Number((1 - x).toFixed(6)));
  return [x, y, Math.max(0, Number((1 - x - y).toFixed(6)))];
}

/** The node of a source file at a hit. Only triangles have coordinates of their own; elsewhere, and
 * when asked for, the nearest vertex is taken. */
export function nodeOf(hit: Hit, kind: string, snap: boolean): SurfacePoint {
  if (snap || kind !== "triangle mesh") return { vertex: hit.vertex };
  return { face: hit.triangle, barycentric: hit.barycentric };
}

/** The line of a source file. */
export function lineOf(node: SurfacePoint): string {
  if ("vertex" in node) return `v ${node.vertex}`;
  if ("edge" in node) return `e ${node.edge[0]} ${node.edge[1]} ${node.t}`;
  return `f ${node.face} ${node.barycentric.join(" ")}`;
}
