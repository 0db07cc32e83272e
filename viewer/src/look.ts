// The materials of a field: colours, lines, filter and cuts, shared by all that is drawn with it.
import * as THREE from "three";
import { colourMap, middleOf, regionColour } from "./colours";
import type { Field, Triple } from "./scene";
import { depthFragment, surfaceFragment, surfaceVertex } from "./shaders";

type Bytes = Uint8Array<ArrayBuffer> | Float32Array<ArrayBuffer>;

export function dataTexture(
  data: Bytes, width: number, format: THREE.PixelFormat, type: THREE.TextureDataType, filter: THREE.MagnificationTextureFilter,
): THREE.DataTexture {
  const t = new THREE.DataTexture(data, width, 1, format, type);
  t.minFilter = filter;
  t.magFilter = filter;
  t.needsUpdate = true;
  return t;
}

const unit = (bytes: Triple) => new THREE.Vector3(...bytes).divideScalar(255);
const far = 1e9;

export class Look {
  readonly uniforms = {
    cut: { value: new THREE.Vector4(0, 0, 0, 1) },
    boxLow: { value: new THREE.Vector3(-far, -far, -far) },
    boxHigh: { value: new THREE.Vector3(far, far, far) },
    hasField: { value: false },
    showLines: { value: true },
    diverging: { value: false },
    zeroLine: { value: true },
    discrete: { value: false },
    flatShading: { value: false },
    occluded: { value: false },
    regions: { value: 0 },
    colours: { value: dataTexture(new Uint8Array(4 * 256), 256, THREE.RGBAFormat, THREE.UnsignedByteType, THREE.LinearFilter) },
    colourMap: { value: new THREE.Vector2() },
    middle: { value: 0.5 },
    lineMap: { value: new THREE.Vector2() },
    zeroAt: { value: -1 },
    levels: { value: dataTexture(new Float32Array(1), 1, THREE.RedFormat, THREE.FloatType, THREE.NearestFilter) },
    levelCount: { value: 0 },
    range: { value: new THREE.Vector2(-far, far) },
    pixel: { value: 0.001 },
    pixelRatio: { value: 1 },
    plainColour: { value: new THREE.Vector3(0.8, 0.8, 0.8) },
    infiniteColour: { value: new THREE.Vector3(0.6, 0.6, 0.6) },
    depthRange: { value: new THREE.Vector2(0, 1) },
  };
  readonly material: THREE.ShaderMaterial;
  /** For surfaces whose normals are exact, however bad their triangles are. */
  readonly trusting: THREE.ShaderMaterial;
  readonly depthMaterial: THREE.ShaderMaterial;
  field: Field | null = null;

  constructor(plainColour: Triple, infiniteColour: Triple) {
    this.uniforms.plainColour.value = unit(plainColour);
    this.uniforms.infiniteColour.value = unit(infiniteColour);
    const make = (trusted: boolean, fragmentShader = surfaceFragment) =>
      new THREE.ShaderMaterial({
        glslVersion: THREE.GLSL3, side: THREE.DoubleSide, vertexShader: surfaceVertex, fragmentShader,
        uniforms: { ...this.uniforms, trusted: { value: trusted } },
        polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
      });
    this.material = make(false);
    this.trusting = make(true);
    this.depthMaterial = make(false, depthFragment);
    this.depthMaterial.blending = THREE.NoBlending;
  }

  /** Takes over a field's range, colours and lines. */
  setField(field: Field | null): void {
    this.field = field;
    const u = this.uniforms;
    u.hasField.value = field !== null && (field.values !== null || field.high >= field.low);
    if (!field) return;
    const span = field.high - field.low;
    u.diverging.value = field.diverging;
    u.discrete.value = field.discrete;
    u.regions.value = field.discrete ? Math.round(span) : 0;
    u.zeroLine.value = field.levels.length ? field.levels.includes(0) : true;
    u.zeroAt.value = span > 0 ? -field.low / span : -1;
    const sorted = field.levels.map((x) => (span > 0 ? (x - field.low) / span : 0)).sort((a, b) => a - b).slice(0, 4096);
    u.levels.value.dispose();
    u.levels.value = dataTexture(Float32Array.from(sorted.length ? sorted : [0]), Math.max(1, sorted.length), THREE.RedFormat, THREE.FloatType, THREE.NearestFilter);
    u.levelCount.value = sorted.length;
    this.setSpacing(field.levels.length ? 0 : field.spacing);
    this.setColours(field.map, field.colourLow, field.colourHigh);
    this.setRange(field.low, field.high);
  }

  /** The map and the values at its ends. Discrete fields keep the colours of regions. */
  setColours(map: string, low: number, high: number): void {
    const { field, uniforms: u } = this;
    if (!field) return;
    let count = 256, texels: Uint8Array<ArrayBuffer>;
    if (field.discrete) {
      count = Math.round(field.high - field.low) + 1;
      texels = new Uint8Array(4 * count).fill(255);
      for (let i = 0; i < count; ++i) texels.set(regionColour(Math.round(field.low) + i), 4 * i);
    } else {
      const bytes = colourMap(map);
      texels = new Uint8Array(4 * 256).fill(255);
      for (let i = 0; i < 256; ++i) texels.set(bytes.subarray(3 * i, 3 * i + 3), 4 * i);
    }
    u.colours.value.dispose();
    u.colours.value = dataTexture(texels, count, THREE.RGBAFormat, THREE.UnsignedByteType, field.discrete ? THREE.NearestFilter : THREE.LinearFilter);
    const span = high - low;
    u.middle.value = field.discrete ? 0.5 : middleOf(map, low, high);
    u.colourMap.value.set(span > 0 ? (field.low - low) / span : 0.5, span > 0 ? (field.high - field.low) / span : 0);
  }

  /** Lines at multiples of a step; 0: none but explicit levels. */
  setSpacing(step: number): void {
    const { field, uniforms: u } = this;
    if (!field) return;
    const low = step > 0 ? field.low / step : 0;
    u.lineMap.value.set(step > 0 ? low - Math.floor(low) : 0, step > 0 ? (field.high - field.low) / step : 0);
    u.zeroLine.value = field.levels.length ? field.levels.includes(0) : step > 0;
  }

  /** Values outside are drawn pale. */
  setRange(low: number, high: number): void {
    const { field, uniforms: u } = this;
    if (!field) return;
    const span = field.high - field.low;
    const whole = low <= field.low && high >= field.high;
    if (whole || !(span > 0)) u.range.value.set(-far, far);
    else u.range.value.set((low - field.low) / span - 1e-6, (high - field.low) / span + 1e-6);
  }

  /** Nothing is drawn outside; null: everywhere. */
  setBox(low: Triple | null, high: Triple | null): void {
    this.uniforms.boxLow.value.set(...(low ?? [-far, -far, -far]));
    this.uniforms.boxHigh.value.set(...(high ?? [far, far, far]));
  }

  /** Is a place drawn, for all that cuts it? */
  keeps(x: number, y: number, z: number): boolean {
    const { cut, boxLow, boxHigh } = this.uniforms, c = cut.value, l = boxLow.value, h = boxHigh.value;
    return c.x * x + c.y * y + c.z * z <= c.w && x >= l.x && y >= l.y && z >= l.z && x <= h.x && y <= h.y && z <= h.z;
  }

  /** Is a line at that value drawn, for the range of values? */
  drawsLine(value: number): boolean {
    const { field } = this, range = this.uniforms.range.value;
    if (!field || !(field.high > field.low)) return false;
    const t = (value - field.low) / (field.high - field.low);
    return t >= range.x && t <= range.y;
  }

  /** What is drawn of segments, six numbers each, for all that cuts them. */
  clip(ends: number[]): number[] {
    const { cut, boxLow, boxHigh } = this.uniforms, l = boxLow.value, h = boxHigh.value, c = cut.value;
    // Half-spaces a x + b y + c z <= d.
    const halves = [
      [c.x, c.y, c.z, c.w], [-1, 0, 0, -l.x], [0, -1, 0, -l.y], [0, 0, -1, -l.z],
      [1, 0, 0, h.x], [0, 1, 0, h.y], [0, 0, 1, h.z],
    ];
    const over = (half: number[], i: number) =>
      half[0] * ends[i] + half[1] * ends[i + 1] + half[2] * ends[i + 2] - half[3];
    const out: number[] = [];
    for (let i = 0; i < ends.length; i += 6) {
      let from = 0, to = 1;
      for (const half of halves) {
        const a = over(half, i), b = over(half, i + 3);
        if (a > 0) from = b > 0 ? 2 : Math.max(from, a / (a - b));
        else if (b > 0) to = Math.min(to, a / (a - b));
      }
      if (!(from < to)) continue;
      for (const t of [from, to])
        for (let k = 0; k < 3; ++k) out.push(ends[i + k] + t * (ends[i + 3 + k] - ends[i + k]));
    }
    return out;
  }

  /** All that decides which lines are drawn, and where; as text, to see whether it has changed. */
  get cuts(): string {
    const { cut, boxLow, boxHigh, range } = this.uniforms;
    return [cut, boxLow, boxHigh, range].map(({ value }) => value.toArray().join(" ")).join(" ");
  }

  dispose(): void {
    this.material.dispose();
    this.trusting.dispose();
    this.depthMaterial.dispose();
    this.uniforms.colours.value.dispose();
    this.uniforms.levels.value.dispose();
  }
}
