// The picture: renderer, camera, the surface with its field, and what lies on it.
import * as THREE from "three";
import type { DrawnSurface, Surface } from "littoral/inline";
import { OrbitView, type Framing } from "../../../viewer/src/camera";
import type { Field } from "../../../viewer/src/scene";
import { toPage, type Frame } from "./frame";
import { Picker, type Hit } from "./pick";
import { Skin } from "./skin";

export class Stage {
  readonly overlay = new THREE.Group();
  frame: Frame = { centre: [0, 0, 0], radius: 1, towardsEye: [0, 0, 1], up: [0, 1, 0] };
  surface: Surface | null = null;
  /** Called after every frame. */
  drawn: () => void = () => {};
  /** Called when the picture has another size. */
  resized: () => void = () => {};
  frames = 0;

  private readonly renderer: THREE.WebGLRenderer;
  private readonly world = new THREE.Scene();
  private readonly view: OrbitView;
  private readonly framing: Framing = { positions: new Float32Array(0), towardsEye: [0, 0, 1], up: [0, 1, 0] };
  private picker: Picker | null = null;
  private base: Skin | null = null; // the surface as it is
  private finer: Skin | null = null; // the one its field lives on
  private finerOf: DrawnSurface | null = null;
  private lines = true;
  private wires = false;
  spacing = 0;
  private insets = { right: 0, bottom: 0 };
  private home = ""; // the camera as it was put
  private asked = false;
  private readonly size = new THREE.Vector2();
  private readonly fitted = new THREE.Vector2(); // the size that the camera was put for

  /** Throws where there is no WebGL 2. */
  constructor(readonly canvas: HTMLCanvasElement) {
    const context = canvas.getContext("webgl2", { antialias: true, alpha: false, powerPreference: "high-performance" });
    if (!context) throw new Error("no WebGL 2");
    this.renderer = new THREE.WebGLRenderer({ canvas, context, antialias: true });
    this.view = new OrbitView(canvas, this.framing, () => this.ask());
    const lamp = new THREE.DirectionalLight(0xffffff, 2.2);
    lamp.position.set(-0.25, 0.35, 1);
    this.camera.add(lamp, lamp.target);
    this.world.add(this.camera, new THREE.AmbientLight(0xffffff, 1), this.overlay);
    new ResizeObserver(() => {
      this.fit();
      this.resized();
    }).observe(canvas.parentElement!);
    this.fit();
  }

  get camera(): THREE.PerspectiveCamera { return this.view.camera; }
  get controls() { return this.view.controls; }
  get pixelRatio(): number { return this.renderer.getPixelRatio(); }

  /** One frame, when the browser next draws. */
  ask(): void {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.render();
      ++this.frames;
      this.drawn();
    });
  }

  get settled(): boolean { return !this.asked; }

  render(): void { this.renderer.render(this.world, this.camera); }

  fit(): void {
    const ratio = Math.min(window.devicePixelRatio || 1, 2), box = this.canvas.parentElement!;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(box.clientWidth, box.clientHeight, false);
    this.renderer.getSize(this.size);
    // A line more in the footer is no reason to move what somebody draws on.
    const resized = this.size.x !== this.fitted.x || Math.abs(this.size.y - this.fitted.y) > 80;
    const untouched = this.surface !== null && this.cameraText === this.home;
    this.view.setSize(this.size.x, this.size.y, this.insets);
    if (resized) this.fitted.copy(this.size);
    if (untouched && resized) this.reset();
    for (const skin of [this.base, this.finer]) skin?.setPixel(ratio, this.view.pixel);
    this.ask();
  }

  /** What covers the picture at the right and below [CSS pixels]. */
  setInsets(right: number, bottom: number): void {
    if (right === this.insets.right && bottom === this.insets.bottom) return;
    this.insets = { right, bottom };
    this.fitted.set(0, 0);
    this.fit();
  }

  get width(): number { return this.size.x; }
  get height(): number { return this.size.y; }

  usePaper(colour: string): void {
    this.renderer.setClearColor(colour, 1);
    this.ask();
  }

  /** Shows a surface without a field, from the front. */
  show(surface: Surface): void {
    this.hideFiner();
    this.drop(this.base);
    this.surface = surface;
    this.frame = surface.view;
    const positions = toPage(surface.positions, this.frame);
    const { triangles } = surface;
    // Everything that is to be in the picture, as the camera takes it.
    this.framing.positions = positions;
    if (triangles.length) this.framing.used = triangles;
    else delete this.framing.used;
    this.framing.towardsEye = [...this.frame.towardsEye];
    this.framing.up = [...this.frame.up];
    this.picker = new Picker(positions, triangles);
    this.base = this.skinOf(positions, triangles, surface.triangleFaces, this.picker);
    this.reset();
  }

  /** A field, on the surface at hand or on the one it came with; or none. */
  showField(field: Field | null, refined: DrawnSurface | null): void {
    if (!this.base) return;
    if (!field || !refined) {
      this.hideFiner();
      this.base.setField(field);
    } else {
      if (refined !== this.finerOf) {
        this.hideFiner();
        this.finer = this.skinOf(toPage(refined.positions, this.frame), refined.triangles, refined.triangleFaces);
        this.finerOf = refined;
      }
      this.base.group.visible = false;
      this.finer!.setField(field);
    }
    this.ask();
  }

  private drop(skin: Skin | null): void {
    if (!skin) return;
    this.world.remove(skin.group);
    skin.dispose();
  }

  private skinOf(positions: Float32Array, triangles: Uint32Array, faces: Uint32Array, picker?: Picker): Skin {
    const skin = new Skin(positions, triangles, faces, picker);
    skin.setPixel(this.pixelRatio, this.view.pixel);
    skin.setLines(this.lines, this.spacing);
    skin.setWires(this.wires);
    this.world.add(skin.group);
    return skin;
  }

  /** Isolines at multiples of a spacing (0: as many as suit), and the sides of faces. */
  setLines(lines: boolean, spacing: number, wires: boolean): void {
    Object.assign(this, { lines, spacing, wires });
    for (const skin of [this.base, this.finer]) {
      skin?.setLines(lines, spacing);
      skin?.setWires(wires);
    }
    this.ask();
  }

  private hideFiner(): void {
    this.drop(this.finer);
    this.finer = null;
    this.finerOf = null;
    if (this.base) this.base.group.visible = true;
  }

  /** The surface on show and its field. */
  get skin(): Skin | null { return this.finer ?? this.base; }

  reset(): void {
    this.view.reset();
    this.home = this.cameraText;
  }
  turn(across: number, upward: number): void { this.view.turn(across, upward); }
  move(across: number, upward: number): void { this.view.move(across, upward); }
  zoom(factor: number): void { this.view.zoom(factor); }

  /** A place of the window as the camera's -1 .. 1. */
  private aim(x: number, y: number): THREE.Ray {
    const box = this.canvas.getBoundingClientRect();
    const { origin, direction } = this.view.ray(x - box.left, y - box.top);
    return new THREE.Ray(new THREE.Vector3().fromArray(origin), new THREE.Vector3().fromArray(direction));
  }

  /** What nodes are made of: a place on the surface itself. */
  pick(x: number, y: number): Hit | null { return this.picker?.along(this.aim(x, y)) ?? null; }

  /** The field's value at a place of the window; null beside the surface. */
  valueAt(x: number, y: number): number | null { return this.skin?.valueAlong(this.aim(x, y)) ?? null; }

  normalAt(place: THREE.Vector3, out: THREE.Vector3): THREE.Vector3 {
    return this.picker ? this.picker.normalAt(place, out) : out.set(0, 0, 0);
  }

  hidden(place: THREE.Vector3): boolean {
    return this.picker?.hidden(this.camera.position, place) ?? false;
  }

  /** Where a place of the page is in the window. */
  project(place: THREE.Vector3): { x: number; y: number } {
    const box = this.canvas.getBoundingClientRect(), { x, y } = this.view.project(place.toArray());
    return { x: box.left + x, y: box.top + y };
  }

  /** Eye and target, as text. */
  get cameraText(): string { return this.view.toText(); }
  setCamera(text: string): void { this.view.fromText(text); }

  pixels(): Uint8Array {
    this.render();
    const gl = this.renderer.getContext();
    const bytes = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
    gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return bytes;
  }
}
