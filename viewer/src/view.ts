// One or two results side by side, with one camera; drawn when something has changed.
import * as THREE from "three";
import { OrbitView, type Insets } from "./camera";
import { between } from "./numbers";
import { Pane } from "./pane";
import { nodeLine, type Hit } from "./pick";
import type { SceneData, Triple } from "./scene";

/** What is at a place of the picture. */
export interface Picked {
  pane: number;
  /** Of the field shown; null without one. */
  value: number | null;
  /** In the input's unit. */
  place: Triple;
  /** In the page's unit. */
  spot: Triple;
  /** A line of a source file, where the surface is the input's. */
  node: string | null;
  triangle: number | null;
  /** Barycentric coordinates in it. */
  b: Triple | null;
}

export class ViewError extends Error {}

export interface ViewOptions {
  width: number;
  height: number;
  insets: Insets;
  pixelRatio: number;
}

export class ResultView {
  readonly renderer: THREE.WebGLRenderer;
  readonly panes: Pane[];
  readonly orbit: OrbitView;
  /** After each frame. */
  onFrame: () => void = () => undefined;
  frames = 0;
  private asked = false;
  private lost = false;
  private width = 1;
  private height = 1;
  private readonly lamp = new THREE.DirectionalLight(0xffffff, 2.2);
  private readonly ambient = new THREE.AmbientLight(0xffffff, 1);
  private paper = new THREE.Color(0xffffff);

  constructor(readonly canvas: HTMLCanvasElement, readonly scene: SceneData) {
    const context = canvas.getContext("webgl2", { antialias: true, alpha: false, powerPreference: "high-performance" });
    if (!context) throw new ViewError("This browser does not offer WebGL 2, which the view needs. Turn on hardware acceleration or try another browser.");
    this.renderer = new THREE.WebGLRenderer({ canvas, context, antialias: true });
    this.renderer.autoClear = false;
    const scenes = scene.beside ? [scene, scene.beside] : [scene];
    this.panes = scenes.map((one) => new Pane(one, this.renderer, () => this.ask()));
    const positions = this.framed(scenes), used = scene.volume || scene.beside ? undefined : scene.surface.triangles;
    this.orbit = new OrbitView(canvas, { towardsEye: scene.towardsEye, up: scene.up, positions, used }, () => this.ask());
    this.orbit.controls.zoomToCursor = scenes.length === 1;
    this.lamp.position.set(-0.25, 0.35, 1);
    this.orbit.camera.add(this.lamp, this.lamp.target);
  }

  private framed(scenes: SceneData[]): Float32Array {
    if (scenes.length === 1) return scenes[0].surface.positions;
    const all = new Float32Array(scenes.reduce((n, s) => n + s.surface.positions.length, 0));
    all.set(scenes[0].surface.positions);
    all.set(scenes[1].surface.positions, scenes[0].surface.positions.length);
    return all;
  }

  /** One frame, soon. */
  ask(): void {
    if (this.asked || this.lost) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      if (this.lost) return;
      this.draw();
    });
  }

  get waiting(): boolean {
    return this.asked;
  }

  /** While the graphics context is away nothing is drawn. */
  setLost(lost: boolean): void {
    this.lost = lost;
    if (!lost) this.ask();
  }

  private draw(): void {
    // The first frame is without the tracer, which may take its time: never a black picture.
    let more = false;
    for (const pane of this.panes) {
      const tracer = pane.tracer;
      if (tracer && tracer.mesh.visible && this.frames > 0) more = tracer.prepare(this.orbit.camera, this.panes.length) || more;
      else if (tracer && this.frames === 0) more = true;
    }
    this.render();
    ++this.frames;
    if (more) this.ask();
    this.onFrame();
  }

  /** Draws at once, for saving and tests. */
  render(): void {
    const { renderer } = this, count = this.panes.length;
    renderer.setScissorTest(count > 1);
    this.panes.forEach((pane, i) => {
      const left = Math.round((i * this.width) / count), right = Math.round(((i + 1) * this.width) / count);
      renderer.setViewport(left, 0, right - left, this.height);
      if (count > 1) renderer.setScissor(left, 0, right - left, this.height);
      renderer.setClearColor(this.paper, 1);
      renderer.clear();
      this.renderPane(pane);
    });
  }

  private renderPane(pane: Pane): void {
    pane.world.add(this.orbit.camera, this.ambient);
    pane.look.uniforms.pixel.value = this.orbit.pixel;
    pane.look.uniforms.pixelRatio.value = this.renderer.getPixelRatio();
    this.renderer.render(pane.world, this.orbit.camera);
  }

  setPaper(colour: string): void {
    this.paper = new THREE.Color(colour);
    this.ask();
  }

  setSize({ width, height, insets, pixelRatio }: ViewOptions): void {
    this.width = Math.max(1, width);
    this.height = Math.max(1, height);
    this.renderer.setPixelRatio(pixelRatio);
    this.renderer.setSize(this.width, this.height, false);
    this.orbit.setSize(this.width / this.panes.length, this.height, insets);
    this.ask();
  }

  private pickSurface(pane: Pane, hit: Hit): { value: number | null; node: string | null } {
    const { surface } = pane.scene, at = pane.surface;
    if (!at) return { value: null, node: null };
    const vertexOnly = surface.nodes === "vertices" || (surface.innerSides !== null && surface.innerSides[hit.triangle] !== 0);
    const face = surface.faces ? surface.faces[hit.triangle] : hit.triangle;
    const node = surface.nodes === "none" ? null : nodeLine(hit, surface.triangles, { face, vertexOnly });
    return { value: at.valueAt(hit), node };
  }

  /** What is at a place of the picture, CSS pixels from its upper left. */
  pick(x: number, y: number): Picked | null {
    const each = this.width / this.panes.length, index = Math.min(this.panes.length - 1, Math.max(0, Math.floor(x / each)));
    const pane = this.panes[index], local = x - index * each, ray = this.orbit.ray(local, y);
    const at = (t: number) => [0, 1, 2].map((k) => ray.origin[k] + t * ray.direction[k]) as Triple;
    const { centre, radius } = pane.scene, real = (p: Triple) => p.map((c, k) => centre[k] + radius * c) as Triple;
    if (pane.volume) {
      const tracer = pane.tracer?.mesh.visible ? pane.tracer : null;
      const traced = tracer?.probe(this.orbit.camera, [[(2 * local) / each - 1, 1 - (2 * y) / this.height]])[0] ?? -1;
      const hit = pane.volume.pick(ray, traced);
      if (!hit || !pane.field) return null;
      const value = Number.isFinite(hit.value) ? between(pane.field.low, pane.field.high, hit.value) : hit.value;
      return { pane: index, value, place: real(hit.place), spot: hit.place, node: null, triangle: null, b: null };
    }
    const hit = pane.surface?.pick(ray);
    if (!hit) return null;
    const spot = at(hit.distance);
    return { pane: index, ...this.pickSurface(pane, hit), spot, place: real(spot), triangle: hit.triangle, b: hit.b };
  }

  /** Where a place (page's unit) is in the picture. */
  project(spot: ArrayLike<number>, pane = 0): { x: number; y: number; depth: number } {
    const p = this.orbit.project(spot);
    return { ...p, x: p.x + (pane * this.width) / this.panes.length };
  }

  /** Asks of places of a pane, CSS pixels from the pane's upper left, and depths whether they are hidden by the surface. */
  visibility(index = 0): (x: number, y: number, depth: number) => boolean {
    const { renderer } = this, pane = this.panes[index];
    const width = Math.max(1, Math.round(this.width / this.panes.length)), height = Math.max(1, Math.round(this.height));
    const target = new THREE.WebGLRenderTarget(width, height), bytes = new Uint8Array(4 * width * height);
    const { camera } = this.orbit, range = pane.look.uniforms.depthRange.value.set(camera.near, camera.far);
    pane.bare(() => {
      pane.world.add(camera, this.ambient);
      pane.world.overrideMaterial = pane.look.depthMaterial;
      renderer.setScissorTest(false);
      renderer.setRenderTarget(target);
      renderer.setClearColor(0xffffff, 1);
      renderer.clear();
      renderer.render(pane.world, camera);
      renderer.readRenderTargetPixels(target, 0, 0, width, height, bytes);
      renderer.setRenderTarget(null);
      pane.world.overrideMaterial = null;
    });
    target.dispose();
    const depthAt = (x: number, y: number) => {
      const i = 4 * (Math.min(width - 1, Math.max(0, x)) + width * Math.min(height - 1, Math.max(0, height - 1 - y)));
      return range.x + ((range.y - range.x) * (65536 * bytes[i] + 256 * bytes[i + 1] + bytes[i + 2])) / 16777215;
    };
    return (x, y, depth) => {
      if (!(x >= 0 && y >= 0 && x < width && y < height)) return false;
      // Behind the farthest of the pixels around it: a line lies on the surface, which may be seen at a slant.
      let far = 0;
      for (let dx = -1; dx <= 1; ++dx) for (let dy = -1; dy <= 1; ++dy) far = Math.max(far, depthAt(Math.round(x) + dx, Math.round(y) + dy));
      return depth < far + 0.006;
    };
  }

  /** A picture of any size, drawn once; `over` draws on it while places are projected to its pixels. */
  picture(
    width: number, height: number, insets: Insets, over: (context: CanvasRenderingContext2D) => void,
  ): HTMLCanvasElement {
    const { renderer } = this, before = { width: this.width, height: this.height, pixelRatio: renderer.getPixelRatio() };
    const out = document.createElement("canvas"), context = out.getContext("2d");
    out.width = width;
    out.height = height;
    const scale = height / Math.max(1, before.height);
    this.width = width;
    this.height = height;
    renderer.setPixelRatio(1);
    renderer.setSize(width, height, false);
    this.orbit.setSize(width / this.panes.length, height, { right: insets.right * scale, bottom: insets.bottom * scale });
    for (const pane of this.panes) while (pane.tracer?.mesh.visible && pane.tracer.prepare(this.orbit.camera, this.panes.length));
    this.render();
    context?.drawImage(this.canvas, 0, 0);
    if (context) over(context);
    this.setSize({ ...before, insets });
    return out;
  }

  dispose(): void {
    this.orbit.dispose();
    for (const pane of this.panes) pane.dispose();
    this.renderer.dispose();
  }
}
