// The surface of one cloud or of several, traced through their tori in a fragment shader. While the view or a slider
// moves, it is traced at as few pixels as the machine can do at once; at rest, strip by strip from below, at all.
import * as THREE from "three";
import { placeInMap } from "./colours";
import type { Look } from "./look";
import { mostClouds, operations, type SceneData, type Trace, type Triple, type Volume } from "./scene";
import { makeTrees, width } from "./tori-tree";
import { screenVertex, showFragment, traceFragment } from "./trace-shader";

const quick = 25, strip = 30, longestStrip = 300, rest = 150;  // milliseconds

function joined(parts: Float32Array[]): Float32Array<ArrayBuffer> {
  const all = new Float32Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

const filled = (numbers: number[]): number[] => Array.from({ length: mostClouds }, (_, i) => numbers[i] ?? 0);

type Numbers = Float32Array<ArrayBuffer> | Int32Array<ArrayBuffer> | Uint32Array<ArrayBuffer>;

function texture(
  data: Numbers, channels: number, format: THREE.PixelFormat, type: THREE.TextureDataType, internal: THREE.PixelFormatGPU,
): THREE.DataTexture {
  const rows = Math.max(1, Math.ceil(data.length / channels / width));
  const padded = new (data.constructor as new (n: number) => Numbers)(rows * width * channels);
  padded.set(data);
  const t = new THREE.DataTexture(padded, width, rows, format, type);
  t.internalFormat = internal;
  t.minFilter = t.magFilter = THREE.NearestFilter;
  t.needsUpdate = true;
  return t;
}

/** Samples of all clouds, one above the other. */
function gridTexture([nx, ny, nz]: Triple, samples: Float32Array[]): THREE.Data3DTexture {
  const t = new THREE.Data3DTexture(joined(samples), nx, ny, nz * samples.length);
  t.format = THREE.RedFormat;
  t.type = THREE.FloatType;
  t.internalFormat = "R32F";
  t.minFilter = t.magFilter = THREE.NearestFilter;
  t.unpackAlignment = 4;
  t.needsUpdate = true;
  return t;
}

function openTexture(n: Triple, data: Uint8Array): THREE.Data3DTexture {
  const t = new THREE.Data3DTexture(data as Uint8Array<ArrayBuffer>, ...n);
  t.minFilter = t.magFilter = THREE.LinearFilter;
  t.needsUpdate = true;
  return t;
}

const makeTarget = () => new THREE.WebGLRenderTarget(1, 1, {
  type: THREE.FloatType, format: THREE.RGBAFormat, depthBuffer: false,
  minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter,
});

const quad = (material: THREE.Material) => {
  const mesh = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), material);
  mesh.frustumCulled = false;
  return mesh;
};

export class Tracer {
  readonly mesh: THREE.Mesh;
  private readonly low: Triple;
  private readonly high: Triple;
  private readonly uniforms;
  private readonly shown;
  private readonly stage = new THREE.Scene();
  private readonly still = new THREE.Camera();
  private readonly coarse = makeTarget();
  private readonly full = makeTarget();
  private readonly single = makeTarget();
  private readonly size = new THREE.Vector2();
  private readonly one = new Float32Array(4);
  private scale = 0.08;
  private dirty = true;
  private rows = 0;
  private changedAt = 0;
  private endedAt = 0;  // when the last strip was traced
  private perRow = strip / 16;
  private last = "";

  /** Null where there is nothing to trace or the browser cannot render to floating-point numbers. */
  static make(scene: SceneData, renderer: THREE.WebGLRenderer, look: Look): Tracer | null {
    if (!scene.trace || !scene.volume || !renderer.extensions.has("EXT_color_buffer_float")) return null;
    return new Tracer(scene.volume, scene.trace, renderer, look);
  }

  private constructor(private readonly volume: Volume, private readonly trace: Trace, private readonly renderer: THREE.WebGLRenderer, private readonly look: Look) {
    this.low = [...volume.origin];
    this.high = this.low.map((x, a) => x + (volume.n[a] - 1) * volume.spacing[a]) as Triple;
    const all = trace.clouds.map((cloud) => cloud.tori), tree = makeTrees(all, this.low, this.high);
    this.uniforms = {
      tori: { value: texture(joined(all), 4, THREE.RGBAFormat, THREE.FloatType, "RGBA32F") },
      nodes: { value: texture(tree.nodes, 2, THREE.RGIntegerFormat, THREE.IntType, "RG32I") },
      lists: { value: texture(tree.lists, 1, THREE.RedIntegerFormat, THREE.UnsignedIntType, "R32UI") },
      samples: { value: gridTexture(volume.n, trace.clouds.map((cloud) => cloud.samples)) },
      clouds: { value: trace.clouds.length },
      roots: { value: filled(tree.roots) },
      operations: { value: filled(trace.clouds.map((cloud) => operations.indexOf(cloud.operation))) },
      blend: { value: trace.blend },
      offset: { value: trace.offset },
      origin: { value: new THREE.Vector3(...volume.origin) },
      spacing: { value: new THREE.Vector3(...volume.spacing) },
      centre: { value: new THREE.Vector3().fromArray(tree.centre) },
      halfSide: { value: tree.half },
      low: { value: new THREE.Vector3(...this.low) },
      high: { value: new THREE.Vector3(...this.high) },
      cut: { value: new THREE.Vector4(0, 0, 0, 1) },
      level: { value: 0 },
      steepness: { value: trace.steepness },
      tolerance: { value: 1e-4 },
      eye: { value: new THREE.Vector3() },
      rays: { value: new THREE.Matrix3() },
    };
    this.shown = {
      coarse: { value: this.coarse.texture }, full: { value: this.full.texture }, fullRows: { value: 0 }, eye: { value: new THREE.Vector3() }, rays: { value: new THREE.Matrix3() },
      colours: look.uniforms.colours, plainColour: look.uniforms.plainColour, colourAt: { value: -1 },
      view: { value: new THREE.Matrix4() }, toScreen: { value: new THREE.Matrix4() },
      occluded: { value: false }, openness: { value: openTexture([1, 1, 1], Uint8Array.from([128, 128, 128, 255])) },
      origin: this.uniforms.origin, spacing: this.uniforms.spacing,
    };
    const options = { glslVersion: THREE.GLSL3, vertexShader: screenVertex, depthTest: false, depthWrite: false };
    this.stage.add(quad(new THREE.ShaderMaterial({ ...options, fragmentShader: traceFragment, uniforms: this.uniforms })));
    this.mesh = quad(new THREE.ShaderMaterial({
      ...options, depthTest: true, depthWrite: true, fragmentShader: showFragment, uniforms: this.shown,
    }));
  }

  /** Traces rows [from, to) of a target and waits for it; returns milliseconds. */
  private run(target: THREE.WebGLRenderTarget, from: number, to: number): number {
    const { renderer } = this, start = performance.now(), before = renderer.getRenderTarget(), clear = renderer.autoClear;
    target.scissor.set(0, from, target.width, to - from);
    target.scissorTest = true;
    renderer.autoClear = false;
    renderer.setRenderTarget(target);
    renderer.render(this.stage, this.still);
    renderer.readRenderTargetPixels(target, 0, from, 1, 1, this.one);
    renderer.setRenderTarget(before);
    renderer.autoClear = clear;
    return performance.now() - start;
  }

  private aim(camera: THREE.PerspectiveCamera): void {
    camera.updateMatrixWorld();
    const e = camera.matrixWorld.elements, p = camera.projectionMatrix.elements, { uniforms } = this;
    const column = (k: number) => new THREE.Vector3(e[4 * k], e[4 * k + 1], e[4 * k + 2]);
    const right = column(0).divideScalar(p[0]), up = column(1).divideScalar(p[5]);
    const ahead = column(2).negate().addScaledVector(right, p[8]).addScaledVector(up, p[9]);
    uniforms.eye.value.setFromMatrixPosition(camera.matrixWorld);
    uniforms.rays.value.set(right.x, up.x, ahead.x, right.y, up.y, ahead.y, right.z, up.z, ahead.z);
    // A fifth of a pixel at the nearest place.
    uniforms.tolerance.value = Math.max(2e-5, (0.4 / p[5]) * Math.max(0.05, uniforms.eye.value.length() - 1) / Math.max(1, this.size.y));
  }

  /** Before a frame, of which it gets one of so many parts side by side. True while there is more to trace: then another
   * frame is wanted. */
  prepare(camera: THREE.PerspectiveCamera, parts: number): boolean {
    const { size, shown, uniforms } = this;
    this.renderer.getDrawingBufferSize(size);
    size.x = Math.max(1, Math.round(size.x / parts));
    this.aim(camera);
    shown.view.value.copy(camera.matrixWorldInverse);
    shown.toScreen.value.copy(camera.projectionMatrix);
    const now = performance.now(), key = [...camera.matrixWorld.elements, ...camera.projectionMatrix.elements, size.x, size.y].join();
    if (key !== this.last) {
      this.last = key;
      this.dirty = true;
    }
    if (this.dirty) {
      this.dirty = false;
      this.rows = 0;
      this.changedAt = now;
      this.coarse.setSize(Math.max(16, Math.round(size.x * this.scale)), Math.max(16, Math.round(size.y * this.scale)));
      const took = this.run(this.coarse, 0, this.coarse.height);
      this.perRow = Math.max(0.01, took / this.coarse.height / this.scale);
      this.scale = Math.min(1, Math.max(0.06, this.scale * Math.sqrt(quick / Math.max(1, took))));
    } else if (this.rows < size.y && now - this.changedAt > rest) {
      if (this.rows === 0) this.full.setSize(size.x, size.y);
      // Each strip is shown by a frame: where frames are slow, strips take as long as they do.
      const wanted = Math.min(longestStrip, Math.max(strip, now - this.endedAt));
      const next = Math.min(size.y, this.rows + Math.max(1, Math.floor(wanted / this.perRow)));
      this.perRow = Math.max(0.01, this.run(this.full, this.rows, next) / (next - this.rows));
      this.rows = next;
    }
    shown.fullRows.value = this.rows;
    this.endedAt = performance.now();
    shown.eye.value.copy(uniforms.eye.value);
    shown.rays.value.copy(uniforms.rays.value);
    return this.rows < size.y;
  }

  /** Which part of the picture is traced in full, 0..1. */
  get progress(): number {
    return this.dirty ? 0 : Math.min(1, this.rows / Math.max(1, this.size.y));
  }

  get settled(): boolean {
    return !this.dirty && this.rows >= this.size.y;
  }

  setLevel(t: number): void {
    this.uniforms.level.value = this.trace.low + this.trace.range * t;
    this.recolour(t);
    this.dirty = true;
  }

  /** Takes the colour of a value from the look again. */
  recolour(t: number): void {
    const { colourMap, middle } = this.look.uniforms;
    this.shown.colourAt.value = placeInMap(colourMap.value.x + colourMap.value.y * t, middle.value);
  }

  setOccluded(occluded: boolean): void {
    this.shown.occluded.value = occluded;
  }

  /** Of the nodes of the grid. */
  setOpenness(open: Uint8Array): void {
    this.shown.openness.value.dispose();
    this.shown.openness.value = openTexture(this.volume.n, open);
  }

  /** Cuts away all where normal . place < offset; without a normal nothing. */
  setCut(normal: Triple | null, offset: number): void {
    if (normal) this.uniforms.cut.value.set(-normal[0], -normal[1], -normal[2], -offset);
    else this.uniforms.cut.value.set(0, 0, 0, 1);
    this.dirty = true;
  }

  /** Cuts away all outside of a box inside the volume's. */
  setBox(low: Triple, high: Triple): void {
    this.uniforms.low.value.set(...low);
    this.uniforms.high.value.set(...high);
    this.dirty = true;
  }

  /** How far along their rays the surface is at places of the screen in [-1, 1]^2, or -1. */
  probe(camera: THREE.PerspectiveCamera, places: [number, number][]): number[] {
    this.aim(camera);
    const rays = this.uniforms.rays.value.clone(), e = rays.elements;
    return places.map(([x, y]) => {
      // One pixel whose only ray is the one asked for.
      const ahead = [0, 1, 2].map((k) => e[k] * x + e[3 + k] * y + e[6 + k]);
      this.uniforms.rays.value.set(0, 0, ahead[0], 0, 0, ahead[1], 0, 0, ahead[2]);
      this.run(this.single, 0, 1);
      this.uniforms.rays.value.copy(rays);
      return this.one[0];
    });
  }

  /** Hits (t, normal) of n x n rays from an eye in the page's units, rows from below. */
  traceRays(eye: Triple, right: Triple, up: Triple, ahead: Triple, n: number): Float32Array {
    const { uniforms } = this;
    uniforms.eye.value.set(...eye);
    uniforms.rays.value.set(right[0], up[0], ahead[0], right[1], up[1], ahead[1], right[2], up[2], ahead[2]);
    uniforms.tolerance.value = 1e-4;
    const target = makeTarget(), data = new Float32Array(4 * n * n);
    target.setSize(n, n);
    this.run(target, 0, n);
    this.renderer.readRenderTargetPixels(target, 0, 0, n, n, data);
    target.dispose();
    return data;
  }
}
