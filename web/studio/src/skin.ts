// A surface or a cloud on show with its field, and what the field is under a ray.
import * as THREE from "three";
import { makeField, valueAt } from "../../../viewer/src/field";
import { Look } from "../../../viewer/src/look";
import { spacings } from "../../../viewer/src/numbers";
import type { Field, Surface, Triple } from "../../../viewer/src/scene";
import { SurfaceView } from "../../../viewer/src/surface";
import { Picker } from "./pick";

export const plainColour: Triple = [196, 204, 214], infiniteColour: Triple = [150, 150, 150];
export const signedColour: Triple = [0, 122, 70], unsignedColour: Triple = [214, 0, 108];

/** The field as the page draws it. Whole numbers that name regions have a colour each. */
export function fieldOf(name: string, values: Float64Array, weights: Float64Array | null): Field {
  const bytes = weights && Uint8Array.from(weights, (w) => Math.round(255 * w));
  const field = makeField({ name, values, weights: bytes });
  const discrete = name === "region" && field.high - field.low < 256;
  return { ...field, discrete, spacing: discrete ? 0 : field.spacing };
}

/** Bit k of a triangle: its side k lies inside a polygon. */
function innerSides(triangles: Uint32Array, faces: Uint32Array): Uint8Array | null {
  const count = triangles.length / 3, out = new Uint8Array(count);
  let any = false;
  for (let first = 0; first < count;) {
    let last = first + 1;
    while (last < count && faces[last] === faces[first]) ++last;
    for (let t = first; t < last && last > first + 1; ++t) for (let k = 0; k < 3; ++k) {
      const a = triangles[3 * t + k], b = triangles[3 * t + ((k + 1) % 3)];
      for (let s = first; s < last; ++s) {
        if (s === t) continue;
        const corners = triangles.subarray(3 * s, 3 * s + 3);
        if (corners.includes(a) && corners.includes(b)) {
          out[t] |= 1 << k;
          any = true;
        }
      }
    }
    first = last;
  }
  return any ? out : null;
}

export class Skin {
  readonly group = new THREE.Group();
  private readonly look = new Look(plainColour, infiniteColour);
  private readonly view: SurfaceView | null = null;
  private readonly dots: THREE.Points<THREE.BufferGeometry, THREE.PointsMaterial> | null = null;
  private picker: Picker | null;
  private wires: THREE.LineSegments | null = null;
  private lines = true;
  private spacing = 0;
  field: Field | null = null;

  constructor(readonly positions: Float32Array, readonly triangles: Uint32Array, readonly faces: Uint32Array, picker?: Picker) {
    this.picker = picker ?? null;
    if (triangles.length) {
      this.view = new SurfaceView({
        positions, triangles, innerSides: innerSides(triangles, faces), faces, nodes: "none", openness: null, discs: null,
      }, this.look);
      this.group.add(this.view.mesh);
    } else {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
      geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(), 2);
      this.dots = new THREE.Points(geometry, new THREE.PointsMaterial({ color: 0x6b7a90, size: 3, sizeAttenuation: false }));
      this.group.add(this.dots);
    }
  }

  setField(field: Field | null): void {
    this.field = field;
    this.view?.setField(field);
    this.setLines(this.lines, this.spacing);
  }

  /** 0: as many lines as suit the range. */
  setLines(lines: boolean, spacing: number): void {
    Object.assign(this, { lines, spacing });
    this.look.uniforms.showLines.value = lines;
    if (this.field && !this.field.discrete) this.look.setSpacing(spacing || this.field.spacing);
  }

  setWires(wires: boolean): void {
    if (wires && !this.wires && this.view) {
      this.wires = this.view.wireframe();
      this.group.add(this.wires);
    }
    if (this.wires) this.wires.visible = wires;
  }

  /** Of the screen, and the side of a pixel at distance 1. */
  setPixel(ratio: number, size: number): void {
    this.look.uniforms.pixelRatio.value = ratio;
    this.look.uniforms.pixel.value = size;
  }

  valueAlong(ray: THREE.Ray): number | null {
    const { field } = this;
    if (!field || !this.triangles.length) return null;
    this.picker ??= new Picker(this.positions, this.triangles);
    const hit = this.picker.along(ray);
    if (!hit || hit.triangle < 0) return null;
    return valueAt(field, this.asSurface(), hit.triangle, hit.barycentric);
  }

  asSurface(): Surface {
    return { positions: this.positions, triangles: this.triangles, innerSides: null, faces: null, nodes: "none", openness: null, discs: null };
  }

  /** The stops of the slider for the spacing of lines. */
  get steps(): number[] { return this.field && !this.field.discrete ? spacings(this.field.low, this.field.high) : []; }

  dispose(): void {
    this.view?.dispose();
    this.look.dispose();
    this.dots?.geometry.dispose();
    this.dots?.material.dispose();
  }
}
