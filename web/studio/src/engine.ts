// The library in its worker, behind what the page needs: one surface, one prepared method, and an
// answer to the newest sources only.
import * as littoral from "littoral/inline";
import type { Backend, GivenFiles } from "./backend";
import type {
  Call, Curve, Field, Lines, Method, MethodInfo, Regions, Report, Solver, Sources, Surface,
} from "littoral/inline";

import { isEmpty } from "./drawing";

export type Task = "distance" | "regions";

export interface Settings {
  readonly task: Task;
  readonly method: Method;
}

/** What is shown: values at the vertices of the surface, or of a finer or cut one. */
export interface Answer {
  readonly name: string;
  readonly values: Float64Array;
  readonly refined: littoral.DrawnSurface | null;
  /** Of the values, in interpolation; or null. */
  readonly weights: Float64Array | null;
  readonly field: Field | null;
  readonly regions: Regions | null;
  readonly report: Report;
  readonly seconds: number;
  /** By a quicker method than the one asked for, whose answer follows. */
  readonly preview: boolean;
}

export interface Listener {
  busy(stage: string, fraction: number): void;
  idle(): void;
  /** Curves are known as the library joins them. */
  joined(): void;
  answer(answer: Answer, stamp: number): void;
  failure(error: Error): void;
}

interface Request { readonly sources: Sources; readonly settings: Settings; readonly stamp: number }

/** A curve as it runs along the surface; kept by the list of its nodes. */
type Kept = { open?: Float64Array; closed?: Float64Array };

const quick = 150, long = 2500, rest = 350; // milliseconds

/** Completing curves and measuring exact distance take long on large meshes: what stands in for them while one draws,
 * the quickest first. */
function previewsOf({ task, method }: Settings, kind: string, { curves = [] }: Sources): Settings[] {
  const metric = method.options?.["metric"] ?? "auto", triangles = kind === "triangle mesh";
  if (task !== "distance" || method.name !== "auto" || (metric !== "auto" && metric !== "exact")) return [];
  if (!triangles && kind !== "polygon mesh") return [];
  const plain = triangles && curves.some(({ closed, signed }) => !closed && signed !== false);
  return [
    ...(plain ? [{ task, method: { name: "fast-marching", options: {} } }] : []),
    { task, method: { ...method, options: { ...method.options, metric: triangles ? "fast-marching" : "heat" } } },
  ];
}

const familyOf: Record<Task, RegExp> = { distance: /^distance on surfaces/i, regions: /^inside and outside on surfaces/i };

export class Engine {
  surface: Surface | null = null;
  private solvers = new Map<string, Solver>(); // three at most: of the method and of its previews
  private lastWhole = Infinity; // milliseconds of the last answer that had a preview
  private whole = false; // such an answer is under way
  private wake: () => void = () => {}; // ends the rest before it
  private running: AbortController | null = null;
  private waiting: Request | null = null;
  private active: Promise<void> = Promise.resolve(); // ends with what is running
  private paths = new WeakMap<Curve["nodes"], Kept>();

  private constructor(readonly library: Backend, private readonly listener: Listener) {}

  static async start(listener: Listener): Promise<Engine> {
    return new Engine(await littoral.open(), listener);
  }

  /** The methods of a task that run on the surface at hand, the default first. */
  methods(task: Task): readonly MethodInfo[] {
    const family = this.library.families.find((each) => familyOf[task].test(each.title));
    const kind = this.surface?.kind;
    return (family?.methods ?? []).filter((method) => !kind || method.domains.includes(kind));
  }

  /** Work that is no answer to what is drawn, with its progress, and cancelled as that is. */
  async apart<T>(stage: string, work: (surface: Surface, call: Call) => Promise<T>): Promise<T> {
    while (this.running) await this.active;
    const { surface } = this;
    if (!surface) throw new Error("nothing is open");
    const call = this.begin(stage), done = work(surface, call).finally(() => this.finish());
    this.active = done.then(() => undefined, () => undefined);
    return done;
  }

  /** Takes the place of the surface there was, unless it cannot be read. */
  load(bytes: Uint8Array, name: string): Promise<Surface> {
    return this.replace(name, (call) => this.read(bytes, name, call));
  }

  /** The file that the program was started with. */
  loadGiven(given: GivenFiles): Promise<Surface> {
    return this.replace(given.name, (call) => this.library.loadGiven!(given, call));
  }

  private async replace(name: string, read: (call: Call) => Promise<Surface>): Promise<Surface> {
    this.cancel();
    await this.active;
    const call = this.begin(`reading ${name}`);
    try {
      const next = await read(call);
      this.forgetSolvers();
      this.surface?.dispose();
      this.lastWhole = Infinity;
      this.surface = next;
      this.paths = new WeakMap();
      return next;
    } finally {
      this.finish();
    }
  }

  private async read(bytes: Uint8Array, name: string, call: Call): Promise<Surface> {
    const extension = name.slice(name.lastIndexOf(".")).toLowerCase();
    if (this.library.extensions.surfaces.includes(extension) ||
        !this.library.extensions.volumes.includes(extension)) {
      return this.library.loadSurface(bytes, name, call);
    }
    const volume = await this.library.loadVolume(bytes, name, call);
    try {
      return await volume.isosurface(0, true, call);
    } finally {
      volume.dispose();
    }
  }

  /** Asks for the answer to these sources; of requests that wait only the newest is answered. */
  request(sources: Sources, settings: Settings, stamp: number): void {
    this.waiting = { sources, settings, stamp };
    this.wake();
    if (!this.running) this.active = this.work();
    else if (this.whole && this.lastWhole > long) this.running.abort();
  }

  /** Nothing that was asked for is wanted any more. */
  drop(): void {
    this.waiting = null;
  }

  cancel(): void {
    this.drop();
    this.running?.abort();
    this.wake();
  }

  get busy(): boolean { return this.running !== null || this.waiting !== null; }

  private begin(stage: string): Call {
    const control = new AbortController();
    this.running = control;
    this.listener.busy(stage, 0);
    return {
      signal: control.signal,
      onProgress: (fraction, what) => this.listener.busy(what || stage, fraction),
    };
  }

  private finish(): void {
    this.running = null;
    if (this.waiting) this.active = this.work();
    else this.listener.idle();
  }

  private async work(): Promise<void> {
    const request = this.waiting, { surface } = this;
    this.waiting = null;
    if (!request || !surface) return this.listener.idle();
    const call = this.begin("solving");
    try {
      await this.join(surface, request, call);
      if (isEmpty(request.sources)) return;
      const previews = this.lastWhole > quick ? previewsOf(request.settings, surface.kind, request.sources) : [];
      for (const [i, settings] of previews.entries()) {
        try {
          await this.solve(surface, { ...request, settings }, call, true);
        } catch (error) {
          if (error instanceof littoral.Cancelled) throw error; // the method asked for has its own say
        }
        if (i === 0) await this.rested();
        if (this.waiting) return;
        call.signal?.throwIfAborted();
      }
      this.whole = previews.length > 0;
      const start = performance.now();
      await this.solve(surface, request, call, false);
      if (this.whole) this.lastWhole = performance.now() - start;
    } catch (error) {
      if (surface === this.surface && !(call.signal?.aborted && this.waiting))
        this.listener.failure(call.signal?.aborted ? new littoral.Cancelled("cancelled") : error as Error);
    } finally {
      this.whole = false;
      this.finish();
    }
  }

  private async solve(surface: Surface, request: Request, call: Call, preview: boolean): Promise<void> {
    const start = performance.now();
    const answer = request.settings.task === "regions"
      ? await this.regions(surface, request, call) : await this.distance(surface, request, call);
    const seconds = (performance.now() - start) / 1000;
    if (surface === this.surface) this.listener.answer({ ...answer, seconds, preview }, request.stamp);
  }

  /** After a while without anything new, or at once when there is something. */
  private rested(): Promise<void> {
    return new Promise((done) => {
      this.wake = done;
      setTimeout(done, rest);
    });
  }

  /** Positions of a curve along the surface, once the library has joined its nodes. */
  pathOf(nodes: Curve["nodes"], closed: boolean): Float64Array | undefined {
    return this.paths.get(nodes)?.[closed ? "closed" : "open"];
  }

  /** Asks for the curves that are not known yet. What cannot be joined is the solve's to report. */
  private async join(surface: Surface, { sources }: Request, call: Call): Promise<void> {
    if (surface.kind !== "triangle mesh") return;
    let any = false;
    for (const { nodes, closed = false } of sources.curves ?? []) {
      if (this.pathOf(nodes, closed)) continue;
      try {
        const { positions } = await surface.path(nodes, closed, call);
        const kept = this.paths.get(nodes) ?? {};
        this.paths.set(nodes, { ...kept, [closed ? "closed" : "open"]: positions });
        any = true;
      } catch (error) {
        if (error instanceof littoral.Cancelled) throw error;
      }
    }
    if (any) this.listener.joined();
  }

  private async distance(surface: Surface, { sources, settings }: Request, call: Call) {
    const solver = await this.solverOf(surface, settings.method, call);
    const field = await solver.solve(sources, call);
    const finer = field.refined?.scalars["distance"];
    return {
      name: "distance", values: finer ?? field.values, refined: finer ? field.refined : null,
      weights: null, field, regions: null, report: field.report,
    };
  }

  private async solverOf(surface: Surface, method: Method, call: Call): Promise<Solver> {
    const key = JSON.stringify(method), known = this.solvers.get(key);
    if (known) return known;
    if (this.solvers.size > 2) this.forgetSolvers();
    const made = await surface.prepare(method, call);
    this.solvers.set(key, made);
    return made;
  }

  /** Lines at distances from the region on the negative side of curves. */
  async offsets(sources: Sources, { task, method }: Settings, distances: readonly number[]): Promise<Lines> {
    if (!this.surface || task !== "distance") throw new Error("offsets are those of a distance");
    return (await this.solverOf(this.surface, method, {})).offsets(sources, distances);
  }

  private forgetSolvers(): void {
    for (const solver of this.solvers.values()) solver.dispose();
    this.solvers.clear();
  }

  private async regions(surface: Surface, { sources, settings }: Request, call: Call) {
    const regions = await surface.regions(sources, settings.method, call);
    const { scalars } = regions.surface;
    const values = scalars["region"] ?? scalars["winding"];
    if (!values) throw new Error("the regions came without values");
    return {
      name: "region", values, refined: regions.surface,
      weights: scalars["region"] ? null : scalars["weight"] ?? null,
      field: null, regions, report: regions.report,
    };
  }
}
