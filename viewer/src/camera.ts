// The camera: where it starts, how keys move it, and how it is written down.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Ray } from "./pick";
import type { Triple } from "./scene";

export interface Framing {
  towardsEye: Triple;
  up: Triple;
  /** What must be inside of the first picture: positions, and which of them (all if left out). */
  positions: Float32Array;
  used?: ArrayLike<number>;
}

/** Room (CSS pixels) that something else covers. */
export interface Insets {
  right: number;
  bottom: number;
}

export class OrbitView {
  readonly camera = new THREE.PerspectiveCamera(30, 1, 0.01, 100);
  readonly controls: OrbitControls;
  private width = 1;
  private height = 1;
  private insets: Insets = { right: 0, bottom: 0 };

  constructor(canvas: HTMLElement, private readonly framing: Framing, onChange: () => void) {
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    this.controls.minDistance = 0.02;
    this.controls.maxDistance = 40;
    this.controls.addEventListener("change", () => {
      // As tight about the unit sphere as can be: depth buffers are coarse.
      const distance = this.camera.position.length();
      this.camera.near = Math.max(0.002, distance - 1.3);
      this.camera.far = distance + 1.3;
      this.camera.updateProjectionMatrix();
      onChange();
    });
  }

  /** The size of the picture, and what of it is covered: the middle of the view is the middle of the rest. */
  setSize(width: number, height: number, insets: Insets = { right: 0, bottom: 0 }): void {
    this.width = Math.max(1, width);
    this.height = Math.max(1, height);
    this.insets = insets;
    this.camera.aspect = this.width / this.height;
    this.camera.setViewOffset(this.width, this.height, insets.right / 2, insets.bottom / 2, this.width, this.height);
    this.camera.updateProjectionMatrix();
  }

  /** The side of a pixel at distance 1. */
  get pixel(): number {
    return (2 * Math.tan((this.camera.fov * Math.PI) / 360)) / this.height;
  }

  /** Which vertices have to be in the picture; null: all. Kept while the positions stay the same. */
  private marked: { of: Float32Array; which: Uint8Array | null } | null = null;

  private marks(): Uint8Array | null {
    const { positions, used } = this.framing;
    if (this.marked?.of === positions) return this.marked.which;
    const which = used ? new Uint8Array(positions.length / 3) : null;
    if (used && which) for (let i = 0; i < used.length; ++i) which[used[i]] = 1;
    this.marked = { of: positions, which };
    return which;
  }

  /** Nearest position along the view direction from which everything is inside the picture. */
  reset(): void {
    const { camera, controls } = this, { positions: p } = this.framing, which = this.marks();
    const z = new THREE.Vector3(...this.framing.towardsEye), y = new THREE.Vector3(...this.framing.up);
    const x = new THREE.Vector3().crossVectors(y, z), [xx, xy, xz] = x.toArray(), [yx, yy, yz] = y.toArray(), [zx, zy, zz] = z.toArray();
    let left = 1, right = -1, bottom = 1, top = -1;
    for (let v = 0, i = 0; i < p.length; ++v, i += 3) {
      if (which && which[v] === 0) continue;
      const a = xx * p[i] + xy * p[i + 1] + xz * p[i + 2], b = yx * p[i] + yy * p[i + 1] + yz * p[i + 2];
      left = Math.min(left, a); right = Math.max(right, a);
      bottom = Math.min(bottom, b); top = Math.max(top, b);
    }
    const tan = (0.9 * Math.max(40, this.height - this.insets.bottom) * this.pixel) / 2;
    const wide = (0.9 * Math.max(40, this.width - this.insets.right) * this.pixel) / 2;
    const cx = (left + right) / 2, cy = (bottom + top) / 2;
    let distance = 1.2;
    for (let v = 0, i = 0; i < p.length; ++v, i += 3) {
      if (which && which[v] === 0) continue;
      const a = Math.abs(xx * p[i] + xy * p[i + 1] + xz * p[i + 2] - cx) / wide, b = Math.abs(yx * p[i] + yy * p[i + 1] + yz * p[i + 2] - cy) / tan;
      distance = Math.max(distance, zx * p[i] + zy * p[i + 1] + zz * p[i + 2] + Math.max(a, b));
    }
    const target = x.multiplyScalar(cx).addScaledVector(y.clone(), cy);
    this.place(target.clone().addScaledVector(z, distance), target, y);
    controls.minDistance = 0.02;
    camera.updateMatrixWorld();
  }

  private place(position: THREE.Vector3, target: THREE.Vector3, up: THREE.Vector3): void {
    const { camera, controls } = this;
    camera.up.copy(up);
    const inner = controls as unknown as { _quat?: THREE.Quaternion; _quatInverse?: THREE.Quaternion };
    inner._quat?.setFromUnitVectors(camera.up, new THREE.Vector3(0, 1, 0));
    if (inner._quat) inner._quatInverse?.copy(inner._quat).invert();
    controls.target.copy(target);
    camera.position.copy(position);
    controls.update();
    controls.dispatchEvent({ type: "change" });
  }

  turn(across: number, upward: number): void {
    const { camera, controls } = this, offset = camera.position.clone().sub(controls.target);
    const axis = new THREE.Vector3().crossVectors(camera.up, offset).normalize();
    const angle = offset.angleTo(camera.up);
    offset.applyAxisAngle(axis, Math.max(0.02, Math.min(Math.PI - 0.02, angle - upward)) - angle);
    offset.applyAxisAngle(camera.up, across);
    camera.position.copy(controls.target).add(offset);
    controls.update();
  }

  move(across: number, upward: number): void {
    const { camera, controls } = this, distance = camera.position.distanceTo(controls.target);
    const shift = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 0).multiplyScalar(across * distance);
    shift.addScaledVector(new THREE.Vector3().setFromMatrixColumn(camera.matrix, 1), upward * distance);
    controls.target.add(shift);
    camera.position.add(shift);
    controls.update();
  }

  zoom(factor: number): void {
    const { camera, controls } = this, offset = camera.position.clone().sub(controls.target);
    offset.setLength(Math.max(controls.minDistance, Math.min(controls.maxDistance, offset.length() * factor)));
    camera.position.copy(controls.target).add(offset);
    controls.update();
  }

  /** The ray through a place of the picture in CSS pixels from its upper left. */
  ray(x: number, y: number): Ray {
    this.camera.updateMatrixWorld();
    const origin = new THREE.Vector3().setFromMatrixPosition(this.camera.matrixWorld);
    const direction = new THREE.Vector3((2 * x) / this.width - 1, 1 - (2 * y) / this.height, 0.5)
      .unproject(this.camera).sub(origin).normalize();
    return { origin: origin.toArray(), direction: direction.toArray() };
  }

  /** Where a place is in the picture, CSS pixels from its upper left, and how far ahead of the eye. */
  project(p: ArrayLike<number>): { x: number; y: number; depth: number } {
    this.camera.updateMatrixWorld();
    const q = new THREE.Vector3(p[0], p[1], p[2]), depth = -q.clone().applyMatrix4(this.camera.matrixWorldInverse).z;
    q.project(this.camera);
    return { x: ((q.x + 1) / 2) * this.width, y: ((1 - q.y) / 2) * this.height, depth };
  }

  /** Eye and target, as six numbers. */
  toText(): string {
    return [...this.camera.position.toArray(), ...this.controls.target.toArray()].map((x) => Number(x.toFixed(4))).join(",");
  }

  fromText(text: string): boolean {
    const n = text.split(",").map(Number);
    if (n.length !== 6 || !n.every((x) => Number.isFinite(x) && Math.abs(x) < 100)) return false;
    const eye = new THREE.Vector3(n[0], n[1], n[2]), target = new THREE.Vector3(n[3], n[4], n[5]);
    if (!(eye.distanceTo(target) > 1e-3)) return false;
    this.place(eye, target, new THREE.Vector3(...this.framing.up));
    return true;
  }

  dispose(): void {
    this.controls.dispose();
  }
}
