// A surface with one of its fields.
import * as THREE from "three";
import { Discs } from "./discs";
import { bulges, cornerReader, valueAt } from "./field";
import type { Look } from "./look";
import { gradients, slopeTensors, vertexNormals, wireEdges } from "./mesh";
import { pickTriangle, type Hit, type Ray } from "./pick";
import type { Field, Surface } from "./scene";

export class SurfaceView {
  readonly mesh: THREE.Mesh<THREE.BufferGeometry, THREE.Material>;
  private readonly shared: THREE.BufferGeometry;     // corners share vertices
  private split: THREE.BufferGeometry | null = null; // every corner its own
  private readonly normals: Float32Array;
  private wires: THREE.LineSegments | null = null;
  private discs: Discs | null = null;
  private asDiscs: boolean;
  field: Field | null = null;

  constructor(readonly surface: Surface, readonly look: Look) {
    const { positions, triangles } = surface;
    this.normals = vertexNormals(positions, triangles);
    this.shared = new THREE.BufferGeometry();
    this.shared.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    this.shared.setAttribute("normal", new THREE.BufferAttribute(this.normals, 3));
    if (surface.openness) this.shared.setAttribute("openness", new THREE.BufferAttribute(surface.openness, 4, true));
    this.asDiscs = surface.discs !== null;
    this.shared.setIndex(new THREE.BufferAttribute(triangles, 1));
    this.shared.boundingSphere = new THREE.Sphere(new THREE.Vector3(), 1);
    this.mesh = new THREE.Mesh(this.shared, look.material);
  }

  /** Shows a field (null: none), with its own style. Moved sources on the same surface need no more than this. */
  setField(field: Field | null): void {
    this.field = field;
    this.look.setField(field);
    if (this.asDiscs && this.surface.discs && (!field || field.at === "vertex")) {
      this.discs ??= new Discs(this.surface, this.surface.discs);
      if (field?.values) this.discs.setField(field);
      this.mesh.geometry = this.discs.geometry;
    } else if (!field?.values) this.mesh.geometry = this.shared;
    else if (field.at === "vertex") this.fillShared(field);
    else this.fillSplit(field);
  }

  /** Of a cloud: as discs, or as the triangles that join its points. */
  showDiscs(shown: boolean): void {
    if (shown === this.asDiscs || !this.surface.discs) return;
    this.asDiscs = shown;
    this.setField(this.field);
  }

  private fillShared(field: Field): void {
    const values = field.values as Float32Array, count = values.length, { positions, triangles } = this.surface;
    const t = new Float32Array(count), infinite = new Uint8Array(count);
    for (let v = 0; v < count; ++v) {
      if (Number.isFinite(values[v])) t[v] = values[v];
      else infinite[v] = 255;
    }
    const tensors = slopeTensors(positions, triangles, gradients(positions, triangles, cornerReader(field, this.surface)));
    const buffer = new THREE.InterleavedBuffer(tensors, 6), g = this.shared;
    g.setAttribute("t", new THREE.BufferAttribute(t, 1));
    g.setAttribute("infinite", new THREE.BufferAttribute(infinite, 1, true));
    g.setAttribute("slopeA", new THREE.InterleavedBufferAttribute(buffer, 3, 0));
    g.setAttribute("slopeB", new THREE.InterleavedBufferAttribute(buffer, 3, 3));
    if (field.weights) g.setAttribute("lightness", new THREE.BufferAttribute(field.weights.map((w) => 255 - w), 1, true));
    else g.deleteAttribute("lightness");
    this.mesh.geometry = g;
  }

  private fillSplit(field: Field): void {
    const { positions, triangles } = this.surface, corners = triangles.length;
    if (!this.split) {
      const p = new Float32Array(3 * corners), n = new Float32Array(3 * corners);
      for (let c = 0; c < corners; ++c) for (let k = 0; k < 3; ++k) {
        p[3 * c + k] = positions[3 * triangles[c] + k];
        n[3 * c + k] = this.normals[3 * triangles[c] + k];
      }
      this.split = new THREE.BufferGeometry();
      this.split.setAttribute("position", new THREE.BufferAttribute(p, 3));
      this.split.setAttribute("normal", new THREE.BufferAttribute(n, 3));
      this.split.boundingSphere = this.shared.boundingSphere;
      const { openness } = this.surface;
      if (openness) {
        const open = new Uint8Array(4 * corners);
        for (let c = 0; c < corners; ++c) open.set(openness.subarray(4 * triangles[c], 4 * triangles[c] + 4), 4 * c);
        this.split.setAttribute("openness", new THREE.BufferAttribute(open, 4, true));
      }
    }
    const read = cornerReader(field, this.surface), t = new Float32Array(corners), infinite = new Uint8Array(corners);
    for (let c = 0; c < corners; ++c) {
      const value = read(Math.floor(c / 3), c % 3);
      if (Number.isFinite(value)) t[c] = value;
      else infinite[c] = 255;
    }
    const g = this.split;
    g.setAttribute("t", new THREE.BufferAttribute(t, 1));
    g.setAttribute("infinite", new THREE.BufferAttribute(infinite, 1, true));
    if (field.at === "p2" && field.values) {
      const bulge = new Float32Array(3 * corners), corner = new Float32Array(3 * corners);
      for (let i = 0; i < corners / 3; ++i) {
        const above = bulges(field.values, i).map((x) => (Number.isFinite(x) ? x : 0));
        for (let k = 0; k < 3; ++k) {
          bulge.set(above, 9 * i + 3 * k);
          corner[9 * i + 4 * k] = 1;
        }
      }
      g.setAttribute("bulge", new THREE.BufferAttribute(bulge, 3));
      g.setAttribute("corner", new THREE.BufferAttribute(corner, 3));
    } else {
      g.deleteAttribute("bulge");
      g.deleteAttribute("corner");
    }
    this.mesh.geometry = g;
  }

  /** Where a ray of the page's units meets what is drawn. */
  pick(ray: Ray): Hit | null {
    const kept = (x: number, y: number, z: number) => this.look.keeps(x, y, z);
    if (this.discs && this.mesh.geometry === this.discs.geometry) return this.discs.pick(ray, kept);
    return pickTriangle(this.surface.positions, this.surface.triangles, ray, kept);
  }

  valueAt(hit: Hit): number | null {
    return this.field?.values ? valueAt(this.field, this.surface, hit.triangle, hit.b) : null;
  }

  /** The sides of the faces, made when first asked for. */
  wireframe(): THREE.LineSegments {
    if (!this.wires) {
      const { positions, triangles, innerSides } = this.surface, g = new THREE.BufferGeometry();
      g.setAttribute("position", this.shared.getAttribute("position"));
      g.setIndex(new THREE.BufferAttribute(wireEdges(triangles, innerSides, positions.length / 3), 1));
      g.boundingSphere = this.shared.boundingSphere;
      this.wires = new THREE.LineSegments(g, new THREE.LineBasicMaterial({ color: 0x10141c, transparent: true, opacity: 0.35 }));
    }
    return this.wires;
  }

  dispose(): void {
    this.shared.dispose();
    this.split?.dispose();
    this.discs?.geometry.dispose();
    this.wires?.geometry.dispose();
  }
}
