// Surfaces and methods prepared for them.
import type * as api from "../package/littoral";
import { InputError } from "./errors";
import { forgotten, Remote, request } from "./handles";
import type { Call, Process } from "./process";
import { pathText, pointsOf, pointsText, sourcesOf, type SourceText, sourceText } from "./sources";
import { SdfInWorker } from "./space";

type Text = Record<string, string>;

/** Values of options as text. */
export function methodOf(method: api.Method = {}): [string, Text] {
  const text = (value: number | boolean | string) =>
    typeof value === "boolean" ? (value ? "on" : "off") : String(value);
  const options: Text = {};
  for (const [name, value] of Object.entries(method.options ?? {})) options[name] = text(value);
  return [method.name ?? "", options];
}

/** Anything that serves as an array of numbers. */
export const numbers = (values: ArrayLike<number>): Float64Array => Float64Array.from(values);
export const bytesOf = (data: Uint8Array | ArrayBuffer | string): Uint8Array =>
  typeof data === "string" ? new TextEncoder().encode(data)
  : data instanceof ArrayBuffer ? new Uint8Array(data.slice(0)) : Uint8Array.from(data);

/** Reports come as JSON text, in which numbers that are not finite are words. */
export const reportOf = (json: string): api.Report => JSON.parse(json) as api.Report;

export interface SurfaceDescription {
  kind: string;
  vertices: number;
  faces: number;
  edges: number;
  components: number;
  positions: Float64Array;
  triangles: Uint32Array;
  triangleFaces: Uint32Array;
  corners: Uint32Array;
  offsets: Uint32Array;
  normals: Float64Array;
  up: "y" | "z";
  view: api.FirstView;
  warnings: string[];
}

export class SurfaceInWorker implements api.Surface {
  readonly kind; readonly counts; readonly positions; readonly triangles; readonly triangleFaces;
  readonly corners; readonly offsets; readonly normals; readonly up; readonly view; readonly warnings;

  constructor(private readonly process: Process, private readonly remote: Remote,
              readonly name: string, described: SurfaceDescription) {
    const { vertices, faces, edges, components } = described;
    this.counts = { vertices, faces, edges, components };
    ({ kind: this.kind, positions: this.positions, triangles: this.triangles,
       triangleFaces: this.triangleFaces, corners: this.corners, offsets: this.offsets,
       normals: this.normals, up: this.up, view: this.view, warnings: this.warnings } = described);
    forgotten.register(this, remote, this);
  }

  /** Makes a surface in the worker. */
  static async make(process: Process, op: string, args: unknown[], name: string, call: Call): Promise<SurfaceInWorker> {
    const remote = new Remote(process, op, args);
    const described = await request(process, op, args, [remote], call) as SurfaceDescription;
    return new SurfaceInWorker(process, remote, name, described);
  }

  async info(call: Call = {}) {
    return JSON.parse(await this.ask("info", [], call) as string) as Record<string, unknown>;
  }

  async prepare(method?: api.Method, call: Call = {}): Promise<api.Solver> {
    const args = [this.remote, ...methodOf(method)];
    const remote = new Remote(this.process, "prepare", args);
    const { report } = await request(this.process, "prepare", args, [remote], call) as { report: string };
    return new SolverInWorker(this.process, remote, this, reportOf(report));
  }

  async regions(curves: api.Sources, method?: api.Method, call: Call = {}): Promise<api.Regions> {
    const { json, chains } = sourceText(curves);
    const found = await this.ask("regions", [json, chains, ...methodOf(method)], call) as
      Omit<api.Regions, "boundingSources" | "report"> & { boundingSources: SourceText & { chains: Int32Array[] }; report: string };
    return { ...found, boundingSources: sourcesOf(found.boundingSources), report: reportOf(found.report) };
  }

  signedDistance(method?: api.Method, { flip = false, estimateNormals = false }: api.Orientation = {}, call: Call = {}) {
    return SdfInWorker.make(this.process, "signedDistance", [this.remote, ...methodOf(method), flip, estimateNormals], call);
  }

  async repair(options: api.RepairOptions = {}, method?: api.Method, { flip = false, estimateNormals = false }: api.Orientation = {}, call: Call = {}) {
    const args = [this.remote, ...methodOf(method), flip, estimateNormals, options];
    const remote = new Remote(this.process, "repair", args);
    const made = await request(this.process, "repair", args, [remote], call) as SurfaceDescription & { report: string };
    return { surface: new SurfaceInWorker(this.process, remote, this.name, made), report: reportOf(made.report) };
  }

  async samples(name: string, options: api.SampleOptions = {}, method?: api.Method, { flip = false, estimateNormals = false }: api.Orientation = {}, call: Call = {}) {
    const found = await this.ask("samples", [...methodOf(method), flip, estimateNormals, options, name, this.name], call) as
      Omit<api.Samples, "report"> & { report: string };
    return { ...found, report: reportOf(found.report) };
  }

  async path(nodes: readonly api.SurfacePoint[], closed = false, call: Call = {}): Promise<api.SurfacePath> {
    const { json, positions, length } = await this.ask("path", [pathText(nodes, closed)], call) as
      { json: string; positions: Float64Array; length: number };
    return { nodes: pointsOf(json), positions, length };
  }

  async locate(points: readonly api.SurfacePoint[], call: Call = {}) {
    if (points.length === 0) return new Float64Array(0);
    return await this.ask("locate", [pointsText(points)], call) as Float64Array;
  }

  async isolines(field: api.FieldValues, levels: api.Levels, call: Call = {}) {
    const values = numbers(field.values);
    const refined = field.refined ?? null;
    return await this.ask("isolines", [values, refined, levelsOf(refined?.scalars.distance ?? values, levels)], call) as api.Lines;
  }

  async readSources(file: string | Uint8Array | ArrayBuffer, name: string, call: Call = {}) {
    return sourcesOf(await this.ask("readSources", [bytesOf(file), name], call) as { json: string; chains: Int32Array[] });
  }

  async writeSources(sources: api.Sources, name: string, call: Call = {}) {
    const { json, chains } = sourceText(sources);
    return await this.ask("writeSources", [json, chains, name], call) as string;
  }

  async write(name: string, call: Call = {}) {
    return await this.ask("writeMesh", [name], call) as Uint8Array;
  }

  async writeField(field: api.FieldValues, name: string, call: Call = {}) {
    return await this.ask("writeField", [numbers(field.values), field.refined ?? null, name], call) as Uint8Array;
  }

  async writeLines(lines: api.Lines, name: string, call: Call = {}) {
    return await request(this.process, "writeLines", [lines, name], [], call) as Uint8Array;
  }

  dispose() {
    forgotten.unregister(this);
    this.remote.dispose();
  }

  private ask(op: string, args: unknown[], call: Call): Promise<unknown> {
    return request(this.process, op, [this.remote, ...args], [], call);
  }
}

/** At most this many lines are drawn of one field. */
const mostLevels = 10000;

function levelsOf(values: ArrayLike<number>, levels: api.Levels): Float64Array {
  if (!("spacing" in levels)) return numbers(levels);
  const { spacing } = levels;
  let low = Infinity, high = -Infinity;
  for (let i = 0; i < values.length; ++i) {
    if (!Number.isFinite(values[i])) continue;
    low = Math.min(low, values[i]);
    high = Math.max(high, values[i]);
  }
  if (!(spacing > 0)) throw new InputError(`the spacing of lines must be positive, not ${spacing}`);
  if (low > high) return new Float64Array(0);
  const first = Math.ceil(low / spacing), count = Math.floor(high / spacing) - first + 1;
  if (count > mostLevels) throw new InputError(`a spacing of ${spacing} would make ${count} levels; at most ${mostLevels} are drawn`);
  return Float64Array.from({ length: Math.max(0, count) }, (_, k) => (first + k) * spacing);
}

class SolverInWorker implements api.Solver {
  constructor(private readonly process: Process, private readonly remote: Remote,
              readonly surface: api.Surface, readonly report: api.Report) {
    forgotten.register(this, remote, this);
  }

  async solve(sources: api.Sources, call: Call = {}): Promise<api.Field> {
    const { json, chains } = sourceText(sources);
    const field = await request(this.process, "solve", [this.remote, json, chains], [], call) as
      Omit<api.Field, "report"> & { report: string };
    return { ...field, report: reportOf(field.report) };
  }

  async offsets(sources: api.Sources, distances: readonly number[], { open = 0, close = 0 }: api.Morphology = {}, call: Call = {}) {
    const { json } = sourceText(sources);
    return await request(this.process, "offsets", [this.remote, json, numbers(distances), open, close], [], call) as api.Lines;
  }

  dispose() {
    forgotten.unregister(this);
    this.remote.dispose();
  }
}
