// A volume: a plane to move through it, and an isosurface or what a tracer sees.
import * as THREE from "three";
import type { Look } from "./look";
import { gradients, slopeTensors } from "./mesh";
import { sample, type Grid, type Shell } from "./march";
import { Marcher } from "./marcher";
import { Occlusion } from "./occlusion";
import { onGrid } from "./openness";
import { pickTriangle, type Ray } from "./pick";
import type { Triple, Volume } from "./scene";
import type { Tracer } from "./tracer";

export interface VolumeHit {
  distance: number;
  place: Triple;
  /** 0..1 between the field's least and greatest value. */
  value: number;
}

const empty: Shell = { positions: new Float32Array(0), normals: new Float32Array(0), triangles: new Uint32Array(0) };

export class VolumeView {
  readonly group = new THREE.Group();
  readonly slice: THREE.Mesh<THREE.BufferGeometry, THREE.Material>;
  readonly shell: THREE.Mesh<THREE.BufferGeometry, THREE.Material> | THREE.Mesh;
  /** The slice is where normal . place = offset, in the page's unit. */
  normal: Triple = [0, 0, 1];
  offset = 0;
  level: number;
  cut = true;
  readonly low: Triple;
  readonly high: Triple;
  private readonly grid: Grid;
  private marcher: Marcher | null;
  private occlusion: Occlusion | null = null;  // from when it is first asked for
  private occluded = false;
  private made: Shell = empty;

  constructor(readonly volume: Volume, readonly look: Look, readonly tracer: Tracer | null, private readonly changed: () => void) {
    const { n, origin, spacing, values } = volume;
    this.grid = { n, origin, spacing, values };
    this.low = [...origin];
    this.high = [0, 1, 2].map((a) => origin[a] + (n[a] - 1) * spacing[a]) as Triple;
    look.setBox(...this.padded(this.low, this.high));
    this.slice = new THREE.Mesh(new THREE.BufferGeometry(), look.material);
    this.shell = tracer ? tracer.mesh : new THREE.Mesh(new THREE.BufferGeometry(), look.trusting);
    this.group.add(this.shell, this.slice);
    this.marcher = tracer ? null : new Marcher(this.grid, (shell, level) => this.putShell(shell, level));
    this.level = volume.level;
    this.normal[2] = 0;
    this.normal[volume.axis] = 1;
    this.setSlice(this.normal, this.low[volume.axis] + volume.position * (this.high[volume.axis] - this.low[volume.axis]));
    this.setLevel(volume.level);
  }

  private padded(low: Triple, high: Triple): [Triple, Triple] {
    return [low.map((x) => x - 1e-4) as Triple, high.map((x) => x + 1e-4) as Triple];
  }

  /** Least and greatest offset of planes with a normal that meet the box. */
  reach(normal: Triple): [number, number] {
    let low = 0, high = 0;
    for (let a = 0; a < 3; ++a) {
      low += Math.min(normal[a] * this.low[a], normal[a] * this.high[a]);
      high += Math.max(normal[a] * this.low[a], normal[a] * this.high[a]);
    }
    return [low, high];
  }

  setSlice(normal: Triple, offset: number): void {
    const length = Math.hypot(...normal) || 1;
    this.normal = normal.map((x) => x / length) as Triple;
    const [low, high] = this.reach(this.normal);
    this.offset = Math.min(high, Math.max(low, offset));
    this.fillSlice();
    this.cutAway();
    this.changed();
  }

  /** Two directions that span the plane: the axes themselves where it is orthogonal to one. */
  private span(): [THREE.Vector3, THREE.Vector3] {
    const n = new THREE.Vector3(...this.normal), size = this.normal.map(Math.abs), axis = size.indexOf(Math.max(...size));
    const u = new THREE.Vector3().setComponent((axis + 1) % 3, 1);
    u.addScaledVector(n, -u.dot(n)).normalize();
    return [u, new THREE.Vector3().crossVectors(n, u)];
  }

  private fillSlice(): void {
    const [u, w] = this.span(), { n, spacing } = this.volume, ends: [number[], number[]] = [[], []];
    for (let c = 0; c < 8; ++c) {
      const p = new THREE.Vector3(...[0, 1, 2].map((a) => ((c >> a) & 1 ? this.high[a] : this.low[a])) as Triple);
      ends[0].push(p.dot(u));
      ends[1].push(p.dot(w));
    }
    const least = [Math.min(...ends[0]), Math.min(...ends[1])], most = [Math.max(...ends[0]), Math.max(...ends[1])];
    // Along an axis as many points as there are nodes, so that the values are the nodes' own.
    const size = this.normal.map(Math.abs), along = Math.max(...size) > 1 - 1e-9;
    const axis = size.indexOf(1), finest = Math.min(...spacing);
    const counts = [0, 1].map((k) => along && axis >= 0 ? n[(axis + 1 + k) % 3] : Math.min(320, 2 + Math.ceil((most[k] - least[k]) / finest)));
    const [nu, nw] = counts, total = nu * nw;
    const positions = new Float32Array(3 * total), t = new Float32Array(total), infinite = new Uint8Array(total);
    const triangles = new Uint32Array(6 * (nu - 1) * (nw - 1));
    const normals = new Float32Array(3 * total), known = new Uint8Array(total);
    let used = 0;
    for (let j = 0; j < nw; ++j) for (let i = 0; i < nu; ++i) {
      const v = i + nu * j, a = least[0] + ((most[0] - least[0]) * i) / (nu - 1), b = least[1] + ((most[1] - least[1]) * j) / (nw - 1);
      const p = [0, 1, 2].map((k) => a * u.getComponent(k) + b * w.getComponent(k) + this.offset * this.normal[k]);
      let value = sample(this.grid, p[0], p[1], p[2]);
      known[v] = Number.isNaN(value) ? 0 : 1;
      if (Number.isNaN(value)) {  // beside the box, where the shader cuts: what is at its border
        const q = p.map((x, k) => Math.min(this.high[k], Math.max(this.low[k], x)));
        value = sample(this.grid, q[0], q[1], q[2]);
      }
      if (Number.isFinite(value)) t[v] = value;
      else infinite[v] = 255;
      positions.set(p, 3 * v);
      normals.set(this.normal, 3 * v);
    }
    for (let j = 0; j + 1 < nw; ++j) for (let i = 0; i + 1 < nu; ++i) {
      const v = i + nu * j;
      if (!(known[v] || known[v + 1] || known[v + nu] || known[v + nu + 1])) continue;
      triangles.set([v, v + 1, v + 1 + nu, v, v + 1 + nu, v + nu], used);
      used += 6;
    }
    const indices = triangles.slice(0, used);
    const g = new THREE.BufferGeometry();
    const values = (c: number, k: number) => (infinite[indices[3 * c + k]] ? Infinity : t[indices[3 * c + k]]);
    const buffer = new THREE.InterleavedBuffer(slopeTensors(positions, indices, gradients(positions, indices, values)), 6);
    g.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    g.setAttribute("normal", new THREE.BufferAttribute(normals, 3));
    g.setAttribute("t", new THREE.BufferAttribute(t, 1));
    g.setAttribute("infinite", new THREE.BufferAttribute(infinite, 1, true));
    g.setAttribute("slopeA", new THREE.InterleavedBufferAttribute(buffer, 3, 0));
    g.setAttribute("slopeB", new THREE.InterleavedBufferAttribute(buffer, 3, 3));
    g.setIndex(new THREE.BufferAttribute(indices, 1));
    g.boundingSphere = new THREE.Sphere(new THREE.Vector3(), 2);
    this.slice.geometry.dispose();
    this.slice.geometry = g;
    this.reopen();
  }

  /** Darker where less of the sky is seen, beside surface and slice. */
  setOccluded(occluded: boolean): void {
    if (occluded === this.occluded) return;
    this.occluded = occluded;
    this.tracer?.setOccluded(occluded);
    if (!occluded) return;
    this.occlusion ??= new Occlusion(() => this.both(), (open) => this.putOpenness(open));
    if (this.tracer) {  // what it traces, made once more of triangles
      this.marcher ??= new Marcher(this.grid, (shell) => this.keepShell(shell));
      this.marcher.ask(this.level);
    }
    this.reopen();
  }

  /** Surface and slice have changed: until it is known how open they are, they are taken as open. */
  private reopen(): void {
    if (!this.occluded) return;
    const { shown, slice } = this.parts();
    this.putOpenness(new Uint8Array(4 * (shown + slice)).map((_, i) => (i % 4 < 3 ? 128 : 255)));
    this.occlusion?.ask();
  }

  private parts(): { shown: number; slice: number } {
    return { shown: this.shell.visible ? this.made.positions.length / 3 : 0, slice: this.slice.geometry.getAttribute("position").count };
  }

  private both(): { positions: Float32Array; triangles: Uint32Array } {
    const { shown, slice } = this.parts(), g = this.slice.geometry, inner = shown ? this.made.triangles : empty.triangles;
    const positions = new Float32Array(3 * (shown + slice)), plane = g.getIndex()?.array ?? [];
    positions.set(this.made.positions.subarray(0, 3 * shown));
    positions.set(g.getAttribute("position").array, 3 * shown);
    const triangles = new Uint32Array(inner.length + plane.length);
    triangles.set(inner);
    for (let i = 0; i < plane.length; ++i) triangles[inner.length + i] = shown + plane[i];
    return { positions, triangles };
  }

  private putOpenness(open: Uint8Array): void {
    const { shown, slice } = this.parts();
    if (open.length !== 4 * (shown + slice)) return;
    const surface = open.slice(0, 4 * shown);
    this.slice.geometry.setAttribute("openness", new THREE.BufferAttribute(open.slice(4 * shown), 4, true));
    if (this.tracer && shown) this.tracer.setOpenness(onGrid(this.grid, this.made.positions, surface));
    else if (shown) this.shell.geometry.setAttribute("openness", new THREE.BufferAttribute(surface, 4, true));
    this.changed();
  }

  showShell(shown: boolean): void {
    if (this.shell.visible === shown) return;
    this.shell.visible = shown;
    this.reopen();
    this.changed();
  }

  setCut(cut: boolean): void {
    this.cut = cut;
    this.cutAway();
    this.changed();
  }

  private cutAway(): void {
    // What lies behind the slice, seen from the first view, is hidden by it anyway.
    const plane = this.look.uniforms.cut.value.set(0, 0, 0, 1);
    if (this.cut) plane.set(-this.normal[0], -this.normal[1], -this.normal[2], 1e-4 - this.offset);
    this.tracer?.setCut(this.cut ? this.normal : null, this.offset);
  }

  setLevel(level: number): void {
    this.level = level;
    this.tracer?.setLevel(level);
    if (!this.tracer || this.occluded) this.marcher?.ask(level);
    this.changed();
  }

  /** Is the surface still being made? */
  get working(): boolean {
    return (this.marcher?.working ?? false) || this.shadingNow;
  }

  /** Is it still being found out how open it is? */
  get shadingNow(): boolean {
    return this.occluded && (this.occlusion?.working ?? false);
  }

  private keepShell(shell: Shell): void {
    this.made = shell;
    this.reopen();
  }

  private putShell(shell: Shell, level: number): void {
    const g = new THREE.BufferGeometry(), count = shell.positions.length / 3;
    g.setAttribute("position", new THREE.BufferAttribute(shell.positions, 3));
    g.setAttribute("normal", new THREE.BufferAttribute(shell.normals, 3));
    g.setAttribute("t", new THREE.BufferAttribute(new Float32Array(count).fill(level), 1));
    g.setIndex(new THREE.BufferAttribute(shell.triangles, 1));
    g.boundingSphere = new THREE.Sphere(new THREE.Vector3(), 2);
    this.shell.geometry.dispose();
    this.shell.geometry = g;
    this.keepShell(shell);
    this.changed();
  }

  /** Nothing is drawn outside of a part (0..1 along each side) of the box. */
  setBox(from: Triple, to: Triple): void {
    const place = (part: Triple) => part.map((x, a) => this.low[a] + x * (this.high[a] - this.low[a])) as Triple;
    this.look.setBox(...this.padded(place(from), place(to)));
    this.tracer?.setBox(place(from), place(to));
    this.changed();
  }

  get triangleCount(): number {
    return this.made.triangles.length / 3;
  }

  get positions(): Float32Array {
    return this.made.positions;
  }

  /** What a ray meets first: the slice, or the surface unless it is hidden; `traced`: where a tracer meets it. */
  pick(ray: Ray, traced = -1): VolumeHit | null {
    const kept = (x: number, y: number, z: number) => this.look.keeps(x, y, z), at = (t: number) =>
      [0, 1, 2].map((k) => ray.origin[k] + t * ray.direction[k]) as Triple;
    let best: VolumeHit | null = null;
    const facing = [0, 1, 2].reduce((sum, k) => sum + this.normal[k] * ray.direction[k], 0);
    const t = (this.offset - [0, 1, 2].reduce((sum, k) => sum + this.normal[k] * ray.origin[k], 0)) / facing;
    if (this.slice.visible && t > 0 && Number.isFinite(t)) {
      const p = at(t), value = sample(this.grid, ...p);
      const { boxLow, boxHigh } = this.look.uniforms;
      const inside = p.every((x, a) => x >= boxLow.value.getComponent(a) && x <= boxHigh.value.getComponent(a));
      if (inside && !Number.isNaN(value)) best = { distance: t, place: p, value };
    }
    if (!this.shell.visible) return best;
    const met = this.tracer ? traced : pickTriangle(this.made.positions, this.made.triangles, ray, kept)?.distance ?? -1;
    return met >= 0 && (!best || met < best.distance) ? { distance: met, place: at(met), value: this.level } : best;
  }

  dispose(): void {
    this.marcher?.dispose();
    this.occlusion?.dispose();
    this.slice.geometry.dispose();
    this.shell.geometry.dispose();
  }
}
