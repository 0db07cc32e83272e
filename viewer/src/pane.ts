// One result: what is drawn of it, and its fields.
import * as THREE from "three";
import { cornerReader, differenceField, gradientField, histogram } from "./field";
import { Descent, type Descended } from "./descent";
import { isolines, type LevelSegments } from "./isolines";
import { Look } from "./look";
import { between, fineOf, niceTicks } from "./numbers";
import type { Field, SceneData, Shading, Surface, Triple } from "./scene";
import { disposeMarks, makeLine, makeSources } from "./sources";
import { SurfaceView } from "./surface";
import { Tracer } from "./tracer";
import { VolumeView } from "./volume";

export interface FieldChoice {
  name: string;
  make(): Field;
}

/** Are two surfaces the same, place by place? */
export function sameSurface(a: Surface, b: Surface): boolean {
  if (a.positions.length !== b.positions.length || a.triangles.length !== b.triangles.length) return false;
  for (let i = 0; i < a.triangles.length; ++i) if (a.triangles[i] !== b.triangles[i]) return false;
  for (let i = 0; i < a.positions.length; ++i) if (Math.abs(a.positions[i] - b.positions[i]) > 1e-5) return false;
  return true;
}

export class Pane {
  readonly world = new THREE.Scene();
  readonly look: Look;
  readonly surface: SurfaceView | null = null;
  readonly volume: VolumeView | null = null;
  readonly tracer: Tracer | null = null;
  readonly sources: THREE.Group;
  readonly choices: FieldChoice[] = [];
  private readonly made = new Map<string, Field>();
  private wires: THREE.Object3D | null = null;
  private descent: Descent | null = null;
  private way: THREE.Group | null = null;
  field: Field | null = null;

  constructor(readonly scene: SceneData, renderer: THREE.WebGLRenderer, changed: () => void) {
    this.look = new Look(scene.plainColour, scene.infiniteColour);
    this.sources = makeSources(scene.sources);
    for (const field of scene.fields) this.choices.push({ name: field.name, make: () => field });
    if (scene.volume) {
      this.tracer = Tracer.make(scene, renderer, this.look);
      this.volume = new VolumeView(scene.volume, this.look, this.tracer, changed);
      this.world.add(this.volume.group, this.sources);
    } else {
      this.surface = new SurfaceView(scene.surface, this.look);
      this.world.add(this.surface.mesh, this.sources);
      this.addMade();
    }
    // Nothing but infinity: the whole surface is unreachable.
    this.setField(0);
  }

  private addMade(): void {
    const { fields, beside, surface, radius } = this.scene;
    const first = fields.find((field) => field.values && !field.discrete && field.at !== "face" && field.high > field.low);
    if (first && /dist/i.test(first.name) && !first.weights)
      this.choices.push({ name: `|∇ ${first.name}| − 1`, make: () => gradientField(first, surface, radius) });
    if (!beside || !sameSurface(surface, beside.surface)) return;
    for (const field of fields) {
      const other = beside.fields.find((f) => f.name === field.name);
      const made = other && differenceField(field, other);
      if (made) this.choices.push({ name: "difference", make: () => ({ ...made, name: `${this.scene.title} − ${beside.title}` }) });
      if (made) return;
    }
  }

  setField(index: number): void {
    const choice = this.choices[index];
    if (!choice) {
      this.field = null;
      this.surface?.setField(null);
      return;
    }
    let field = this.made.get(choice.name);
    if (!field) this.made.set(choice.name, (field = choice.make()));
    this.field = field;
    if (this.surface) this.surface.setField(field);
    else this.look.setField(field);
    this.volume?.tracer?.recolour(this.volume.level);
  }

  showWires(shown: boolean): void {
    if (shown && !this.wires && this.surface) {
      this.wires = this.surface.wireframe();
      this.world.add(this.wires);
    }
    if (this.wires) this.wires.visible = shown;
  }

  valueAt(triangle: number, b: Triple): number | null {
    return this.surface?.valueAt({ triangle, b, distance: 0 }) ?? null;
  }

  /** The way from a place down the field to the source; null where the field is no distance. */
  wayFrom(triangle: number, b: Triple): Descended | null {
    const { field, scene } = this;
    if (!this.hasWays || !field) return null;
    this.descent ??= new Descent(scene.surface);
    return this.descent.path(field, scene.radius, scene.sources, { triangle, b });
  }

  /** Is what is shown a distance on a surface, as far as one can tell? */
  get hasWays(): boolean {
    const { field } = this;
    if (this.surface === null || !field?.values || field.discrete || field.at === "face") return false;
    return field.high > field.low && /^(signed |unsigned )?(dist|geodesic)/i.test(field.name);
  }

  /** What the values of the field have to tell apart as text. */
  get fine(): number {
    return this.field ? fineOf(this.field.low, this.field.high) : 0;
  }

  /** All but the camera that decides where lines are in sight, as text. */
  get cuts(): string {
    const { volume: v, surface } = this;
    const slice = v ? [...v.normal, v.offset, v.level, v.shell.visible, v.triangleCount].join(" ") : "";
    return `${this.look.cuts} ${slice} ${surface?.mesh.geometry.id ?? ""}`;
  }

  /** Draws a line along some places; null: none. */
  showWay(places: number[] | null): void {
    if (this.way) {
      this.world.remove(this.way);
      disposeMarks(this.way);
    }
    this.way = places && places.length > 3 ? makeLine(places) : null;
    if (this.way) this.world.add(this.way);
  }

  setShading(shading: Shading): void {
    this.look.uniforms.flatShading.value = shading === "flat";
    this.look.uniforms.occluded.value = shading === "occluded" && this.hasOcclusion;
    this.volume?.setOccluded(shading === "occluded");
  }

  get hasOcclusion(): boolean {
    return this.volume !== null || this.scene.surface.openness !== null;
  }

  /** Runs something with only surfaces in sight. */
  bare(act: () => void): void {
    const { sources, wires, tracer, way } = this, shown = [sources.visible, wires?.visible ?? false, tracer?.mesh.visible ?? false];
    sources.visible = false;
    if (wires) wires.visible = false;
    if (tracer) tracer.mesh.visible = false;
    if (way) this.world.remove(way);
    act();
    if (way) this.world.add(way);
    sources.visible = shown[0];
    if (wires) wires.visible = shown[1];
    if (tracer) tracer.mesh.visible = shown[2];
  }

  histogram(bins: number, low: number, high: number): Float64Array | null {
    const { field, volume } = this;
    if (!field) return null;
    if (this.surface && field.values) return histogram(field, this.scene.surface, bins, low, high);
    if (!volume || !(high > low)) return null;
    const out = new Float64Array(bins), { values } = volume.volume;
    for (let i = 0; i < values.length; ++i)
      if (Number.isFinite(values[i])) out[Math.min(bins - 1, Math.floor(values[i] * bins))] += 1 / values.length;
    return out;
  }

  /** The isolines in sight with a spacing, on the surface or the slice. */
  lines(spacing: number): LevelSegments[] {
    const all = this.allLines(this.levels(spacing).filter((level) => this.look.drawsLine(level)));
    return all.map(({ level, ends }) => ({ level, ends: this.look.clip(ends) }));
  }

  /** The levels of the lines with a spacing, ascending. */
  levels(spacing: number): number[] {
    const { field } = this;
    if (!field || field.discrete) return [];
    if (field.levels.length) return [...field.levels].sort((a, b) => a - b);
    // As the shader: none where the field ends, but the line at 0 between two hues.
    const { low, high, diverging } = field, near = 1e-6 * (high - low);
    return niceTicks(low, high, spacing).filter((x) => (x > low + near && x < high - near) || (diverging && x === 0));
  }

  private allLines(levels: number[]): LevelSegments[] {
    const { field } = this;
    if (!field) return [];
    const value = (t: number) => (Number.isFinite(t) ? between(field.low, field.high, t) : t);
    if (this.volume) {
      const g = this.volume.slice.geometry, triangles = g.getIndex()?.array ?? [], t = g.getAttribute("t").array;
      return isolines({ positions: g.getAttribute("position").array, triangles, corner: (i, k) => value(t[triangles[3 * i + k]]) }, levels);
    }
    const read = cornerReader(field, this.scene.surface), { positions, triangles } = this.scene.surface;
    return isolines({ positions, triangles, corner: (i, k) => value(read(i, k)) }, levels);
  }

  dispose(): void {
    this.surface?.dispose();
    this.volume?.dispose();
    this.look.dispose();
  }
}
