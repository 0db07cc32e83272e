// What the worker does with the library: files in memory, objects by number, arrays to hand over.
import type { Failure } from "./errors";

/** An object of embind. */
export interface Native {
  delete(): void;
}
type Answer = { value: unknown } | Failure;
type Native_ = (...args: unknown[]) => unknown;

/** The module that emscripten makes; its functions are bound in web/bindings. */
export interface Library {
  FS: {
    writeFile(path: string, bytes: Uint8Array, options?: { canOwn?: boolean }): void;
    readFile(path: string): Uint8Array;
    unlink(path: string): void;
    analyzePath(path: string): { exists: boolean };
  };
  HEAPU8: Uint8Array;
  [name: string]: unknown;
}

/** Called in the library while it computes; true stops it. */
export type Watch = ((fraction: number, stage: string) => boolean) | undefined;

export class Failed extends Error {
  constructor(readonly failure: Failure) {
    super(failure.message);
  }
}

interface Description {
  [name: string]: unknown;
}
interface Slice {
  origin: number[];
  u: number[];
  v: number[];
  n: [number, number];
}

/** The nodes of a flat grid in space. */
function sliceNodes({ origin, u, v, n }: Slice): Float64Array {
  for (const count of n) {
    if (!Number.isInteger(count) || count < 1 || count > 20000) {
      throw new Failed({ error: "InputError", message: "a slice has 1 to 20000 points along each side" });
    }
  }
  const out = new Float64Array(3 * n[0] * n[1]);
  let at = 0;
  for (let j = 0; j < n[1]; ++j) {
    for (let i = 0; i < n[0]; ++i) {
      const s = n[0] > 1 ? i / (n[0] - 1) : 0, t = n[1] > 1 ? j / (n[1] - 1) : 0;
      for (let a = 0; a < 3; ++a) out[at++] = origin[a] + s * u[a] + t * v[a];
    }
  }
  return out;
}

/** The operations on one instance of the library. What makes objects answers them under `made`. */
export function operationsOn(library: Library) {
  const call = (name: string, ...args: unknown[]): unknown => {
    const answer = (library[name] as Native_)(...args) as Answer;
    if ("error" in answer) throw new Failed(answer);
    return answer.value;
  };
  /** The file's own name: messages begin with it. */
  const fileName = (name: string) => name.replace(/^.*[/\\]/, "").replace(/\0/g, "") || "unnamed";
  const withFile = <T>(bytes: Uint8Array, name: string, read: (path: string) => T): T => {
    const path = fileName(name);
    library.FS.writeFile(path, bytes, { canOwn: true });
    try {
      return read(path);
    } finally {
      library.FS.unlink(path);
    }
  };
  const bytesOf = (name: string, write: (path: string) => void): Uint8Array => {
    const path = fileName(name);
    try {
      write(path);
      return library.FS.readFile(path);
    } finally {
      if (library.FS.analyzePath(path).exists) library.FS.unlink(path);
    }
  };
  const surface = (mesh: unknown) => {
    try {
      return { made: [mesh as Native], value: call("described", mesh) as Description };
    } catch (error) {
      (mesh as Native).delete();
      throw error;
    }
  };
  const solver = (made: unknown) =>
    ({ made: [made as Native], value: { report: call("solverReport", made) } });
  const sdf = (made: unknown) => ({ made: [made as Native], value: call("aboutSdf", made) });
  const volume = (made: unknown) => ({ made: [made as Native], value: call("volumeGrid", made) });
  const result = (value: unknown) => ({ made: [] as Native[], value });

  return {
    about: () => result((library.about as Native_)()),
    memory: () => result(library.HEAPU8.length / 2 ** 20),

    loadSurface: (_: Watch, bytes: Uint8Array, name: string) =>
      surface(withFile(bytes, name, (path) => call("readSurface", path))),
    makeSurface: (_: Watch, positions: unknown, corners: unknown, offsets: unknown, normals: unknown) =>
      surface(call("made", positions, corners, offsets, normals)),
    info: (_: Watch, mesh: Native) => result(call("info", mesh)),
    readSources: (_: Watch, mesh: Native, bytes: unknown, name: string) =>
      result(call("readSourceFile", mesh, bytes, fileName(name))),
    writeSources: (_: Watch, mesh: Native, json: string, chains: unknown, name: string) =>
      result(call("writeSourceFile", mesh, json, chains, name)),
    locate: (_: Watch, mesh: Native, json: string) => result(call("located", mesh, json)),
    path: (watch: Watch, mesh: Native, json: string) => result(call("path", mesh, json, watch)),
    isolines: (_: Watch, mesh: Native, values: unknown, refined: unknown, levels: unknown) =>
      result(call("isolines", mesh, values, refined, levels)),
    writeMesh: (_: Watch, mesh: Native, name: string) =>
      result(bytesOf(name, (path) => call("writeMesh", mesh, path))),
    writeField: (_: Watch, mesh: Native, values: unknown, refined: unknown, name: string) =>
      result(bytesOf(name, (path) => call("writeField", mesh, values, refined, path))),
    writeLines: (_: Watch, lines: unknown, name: string) =>
      result(bytesOf(name, (path) => call("writeLines", lines, path))),

    prepare: (watch: Watch, mesh: Native, method: string, options: unknown) =>
      solver(call("prepare", mesh, method, options, watch)),
    solve: (watch: Watch, made: Native, json: string, chains: unknown) =>
      result(call("solve", made, json, chains, watch)),
    offsets: (watch: Watch, made: Native, json: string, distances: unknown, open: number, close: number) =>
      result(call("offsets", made, json, distances, open, close, watch)),
    regions: (watch: Watch, mesh: Native, json: string, chains: unknown, method: string, options: unknown) =>
      result(call("regions", mesh, json, chains, method, options, watch)),

    signedDistance: (watch: Watch, mesh: Native, method: string, options: unknown, flip: boolean, estimate: boolean) =>
      sdf(call("signedDistance", mesh, method, options, flip, estimate, watch)),
    sdfAt: (watch: Watch, of: Native, points: unknown) => result(call("sdfAt", of, points, watch)),
    sdfSlice: (watch: Watch, of: Native, slice: Slice) =>
      result(call("sdfAt", of, sliceNodes(slice), watch)),
    sdfGradients: (watch: Watch, of: Native, points: unknown) =>
      result(call("sdfGradients", of, points, watch)),
    sdfClosest: (watch: Watch, of: Native, points: unknown) =>
      result(call("sdfClosest", of, points, watch)),
    sdfWinding: (watch: Watch, of: Native, points: unknown) =>
      result(call("sdfWinding", of, points, watch)),
    sdfConfidence: (watch: Watch, of: Native, points: unknown) =>
      result(call("sdfConfidence", of, points, watch)),
    sample: (watch: Watch, of: Native, grid: unknown) => volume(call("sampled", of, grid, watch)),

    loadVolume: (_: Watch, bytes: Uint8Array, name: string) =>
      volume(withFile(bytes, name, (path) => call("readVolume", path))),
    makeVolume: (_: Watch, grid: unknown, values: unknown) => volume(call("madeVolume", grid, values)),
    volumeValues: (_: Watch, of: Native) => result(call("volumeValues", of)),
    volumeAt: (_: Watch, of: Native, points: unknown) => result(call("volumeAt", of, points)),
    volumeSlice: (_: Watch, of: Native, slice: Slice) =>
      result(call("volumeAt", of, sliceNodes(slice))),
    isosurface: (watch: Watch, of: Native, level: number, close: boolean) =>
      surface(call("isosurface", of, level, close, watch)),
    volumeOffsets: (watch: Watch, of: Native, distances: unknown, open: number, close: number) => {
      const surfaces = (call("volumeOffsets", of, distances, open, close, watch) as Native[]).map(surface);
      return { made: surfaces.flatMap((s) => s.made), value: surfaces.map((s) => s.value) };
    },
    volumeDistance: (watch: Watch, of: Native, meaning: string, threshold: number | undefined) =>
      sdf(call("volumeDistance", of, meaning, threshold, watch)),
    writeVolume: (_: Watch, of: Native, name: string) =>
      result(bytesOf(name, (path) => call("writeVolume", of, path))),
  };
}
