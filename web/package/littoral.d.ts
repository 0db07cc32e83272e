/**
 * littoral in JavaScript: distance and inside/outside for geometry that is broken, computed by the
 * C++ library in a worker.
 *
 * Lengths are in the unit of the input. Everything counts from 0. Arrays are flat: points x y z
 * x y z ..., triangles a b c a b c .... Arrays that are handed in are copied; arrays that come back
 * belong to the caller. Every failure is a LittoralError.
 *
 * What lives in the worker (Surface, Solver, Sdf, Volume) is freed by dispose(), or when it is no
 * longer referred to. Where a call could only be cancelled by ending the worker, a new one makes
 * these again by itself when they are next used.
 */

import type {
  Grid, Orientation, Repaired, RepairOptions, SampleOptions, Samples, Sdf, Triple, Volume,
} from "./space.js";

export * from "./errors.js";
export * from "./space.js";

// ------------------------------------------------------------------------------------- a call

/** The last, optional argument of every call that computes. */
export interface Call {
  /** Ends the call with Cancelled, also while it waits for others to finish. */
  signal?: AbortSignal;
  /** Told the share of the work that is done, 0 to 1, and what is being done. */
  onProgress?: (fraction: number, stage: string) => void;
}

/** Values of options by name, as the tables of `methods` have them; those not named have their
 * defaults. Text serves for all of them. */
export type OptionValues = Readonly<Record<string, number | boolean | string>>;

/** A method by name with its options; nothing is the library's choice. */
export interface Method {
  name?: string;
  options?: OptionValues;
}

// ------------------------------------------------------------------------------------- opening

export interface OpenOptions {
  /** Where littoral.wasm and the worker are, if not beside the module. The build `littoral/inline`
   * has both in it and takes no address. */
  wasm?: string | URL;
  worker?: string | URL;
}

/** Starts a worker with the library in it. */
export function open(options?: OpenOptions): Promise<Littoral>;

/** Calls run one after the other, in the order in which they were made. */
export interface Littoral {
  readonly version: string;
  /** All methods there are by purpose, the default of each purpose first. */
  readonly families: readonly MethodFamily[];
  /** Extensions with the dot, in lower case: ".obj". */
  readonly extensions: {
    /** That loadSurface takes: meshes, clouds, voxels. */
    readonly surfaces: readonly string[];
    /** That loadVolume takes. */
    readonly volumes: readonly string[];
    /** That Surface.readSources takes. */
    readonly sources: readonly string[];
  };

  /** A mesh, a cloud, or the boundary of voxels: the bytes of a file, and its name, whose extension
   * says the format. The bytes are kept, for a worker that has to begin anew. */
  loadSurface(bytes: Uint8Array | ArrayBuffer, name: string, call?: Call): Promise<Surface>;
  /** A surface from arrays. Without corners a point cloud; without offsets triangles. */
  makeSurface(data: SurfaceData, call?: Call): Promise<Surface>;
  loadVolume(bytes: Uint8Array | ArrayBuffer, name: string, call?: Call): Promise<Volume>;
  /** A volume from values at the nodes of a grid, x fastest. */
  makeVolume(grid: Grid, values: ArrayLike<number>, call?: Call): Promise<Volume>;

  /** Megabytes that the library's memory has grown to; it shrinks only with a new worker. */
  memory(): Promise<number>;
  /** Ends the worker. What it held is of no use afterwards. */
  close(): void;
}

export interface MethodFamily {
  /** "Distance on surfaces", "All pairs of vertices", ... */
  readonly title: string;
  readonly methods: readonly MethodInfo[];
}

export interface MethodInfo {
  readonly name: string;
  /** One sentence. */
  readonly summary: string;
  /** The kinds of surface (see Surface.kind) or other domains that it runs on. */
  readonly domains: readonly string[];
  readonly options: readonly OptionInfo[];
  /** The paper. */
  readonly reference: string;
}

export interface OptionInfo {
  readonly name: string;
  readonly kind: "number" | "integer" | "toggle" | "choice" | "text";
  /** "", "[length]", "multiple of h^2" */
  readonly unit: string;
  /** What may be given, in words: "0 to 10", "admm, pdhg". */
  readonly range: string;
  /** Numbers and integers: the allowed range, inclusive; Infinity where there is no bound. */
  readonly low: number;
  readonly high: number;
  /** Choices: the allowed words. */
  readonly choices: readonly string[];
  readonly default: number | boolean | string;
  /** One sentence. */
  readonly help: string;
}

// ------------------------------------------------------------------------------------- surfaces

export interface SurfaceData {
  positions: ArrayLike<number>;
  /** The vertex of each corner, face after face. */
  corners?: ArrayLike<number>;
  /** Where each face begins in corners, and the end: faces + 1. */
  offsets?: ArrayLike<number>;
  /** Of a cloud. */
  normals?: ArrayLike<number>;
}

/** A vertex; the point (1 - t) a + t b of the edge between vertices a and b; or barycentric
 * coordinates in a triangle, in the order of its corners (of polygons, their first three). */
export type SurfacePoint =
  | { readonly vertex: number }
  | { readonly edge: readonly [number, number]; readonly t: number }
  | { readonly face: number; readonly barycentric: readonly [number, number, number] };

/** A curve on a surface, in the direction of travel. */
export interface Curve {
  /** Nodes that do not share a face are joined along the surface when solving. */
  readonly nodes: readonly SurfacePoint[];
  /** Back to the first node, which is not repeated. */
  readonly closed?: boolean;
  /** Positive distance to the left of travel; default true. Otherwise distance to both sides. */
  readonly signed?: boolean;
}

/** A curve in space, which is projected onto the surface. */
export interface SpaceCurve {
  readonly positions: ArrayLike<number>;
  readonly closed?: boolean;
  readonly signed?: boolean;
}

export interface Sources {
  readonly curves?: readonly Curve[];
  readonly points?: readonly SurfacePoint[];
  readonly spaceCurves?: readonly SpaceCurve[];
  /** Chains of neighbouring faces across which the winding number grows by one; for regions. */
  readonly chains?: readonly (readonly number[])[];
}

/** Lines over shared memory: line i has the points offsets[i] .. offsets[i + 1]. A closed line
 * repeats its first point. */
export interface Lines {
  readonly positions: Float64Array;
  /** lines + 1, in points. */
  readonly offsets: Uint32Array;
  /** One for each line, where lines have levels; otherwise empty. */
  readonly levels: Float64Array;
}

/** A surface that is drawn by its triangles, with values at its vertices. */
export interface DrawnSurface {
  readonly positions: Float64Array;
  readonly triangles: Uint32Array;
  /** The polygon that each triangle was cut from; for triangle meshes 0, 1, 2, .... */
  readonly triangleFaces: Uint32Array;
  /** Values at the vertices by name. Where values jump the surface is split: vertices of different
   * number lie at one place, so that values at vertices are values at corners. */
  readonly scalars: Readonly<Record<string, Float64Array>>;
}

/** A ball about what there is to see, and directions of length 1 at a right angle. */
export interface FirstView {
  readonly centre: Triple;
  readonly radius: number;
  readonly towardsEye: Triple;
  readonly up: Triple;
}

/** A surface in the worker, immutable. */
export interface Surface {
  readonly name: string;
  /** "triangle mesh", "polygon mesh", "point cloud" or "voxel surface". */
  readonly kind: string;
  readonly counts: {
    readonly vertices: number;
    readonly faces: number;
    readonly edges: number;
    readonly components: number;
  };
  readonly positions: Float64Array;
  /** For drawing; none for clouds. Polygons are cut on their own corners. */
  readonly triangles: Uint32Array;
  readonly triangleFaces: Uint32Array;
  /** The polygons as they are: the vertex of each corner, and where each face begins. */
  readonly corners: Uint32Array;
  readonly offsets: Uint32Array;
  /** As the file gives them, at vertices; or empty. */
  readonly normals: Float64Array;
  /** Which axis points up: no format says; z where the surface stands on z = 0 and not on y = 0. */
  readonly up: "y" | "z";
  /** A view from the front above, as pages and pictures of results begin with. */
  readonly view: FirstView;
  /** What is unusual about the input and may matter: boundaries, nonmanifold edges, ... */
  readonly warnings: readonly string[];

  /** Facts as `littoral info --json` has them. */
  info(call?: Call): Promise<Readonly<Record<string, unknown>>>;

  /** Computes everything that does not depend on the sources. */
  prepare(method?: Method, call?: Call): Promise<Solver>;
  /** Inside and outside of (broken) curves, on triangle meshes. */
  regions(curves: Sources, method?: Method, call?: Call): Promise<Regions>;
  /** Signed distance in space around the surface or cloud. */
  signedDistance(method?: Method, orientation?: Orientation, call?: Call): Promise<Sdf>;

  /** A closed surface made of a broken one. */
  repair(options?: RepairOptions, method?: Method, orientation?: Orientation, call?: Call): Promise<Repaired>;
  /** Points on the surface and around it with their distances, for learning; the name of the file, .npz or .tar. */
  samples(name: string, options?: SampleOptions, method?: Method, orientation?: Orientation, call?: Call): Promise<Samples>;

  /** The nodes joined along the surface by locally shortest paths; triangle meshes only. */
  path(nodes: readonly SurfacePoint[], closed?: boolean, call?: Call): Promise<SurfacePath>;
  /** Positions of points on the surface. */
  locate(points: readonly SurfacePoint[], call?: Call): Promise<Float64Array>;

  /** The lines on which a field takes the values of `levels`. */
  isolines(field: FieldValues, levels: Levels, call?: Call): Promise<Lines>;

  /** What a source file holds: the formats that the command line takes. The name's extension says
   * which. */
  readSources(file: string | Uint8Array | ArrayBuffer, name: string, call?: Call): Promise<Sources>;
  /** The text of a source file that the command line takes, ".txt" or ".json" by the name: one line
   * for each node. Curves in space need ".json", chains ".txt". */
  writeSources(sources: Sources, name: string, call?: Call): Promise<string>;

  /** The bytes of a file with the surface: .ply .obj .off .stl .vtp. */
  write(name: string, call?: Call): Promise<Uint8Array>;
  /** The bytes of a file with a field: .ply .obj .vtp .csv .npy .txt. */
  writeField(field: FieldValues, name: string, call?: Call): Promise<Uint8Array>;
  /** The bytes of a file with lines, e.g. isolines: .ply .obj .vtp. */
  writeLines(lines: Lines, name: string, call?: Call): Promise<Uint8Array>;

  dispose(): void;
}

export interface SurfacePath {
  /** Neighbours share a face; a closed path repeats its first node. */
  readonly nodes: readonly SurfacePoint[];
  readonly positions: Float64Array;
  readonly length: number;
}

/** Multiples of a spacing within the values' range, or the levels themselves [length]. */
export type Levels = { readonly spacing: number } | readonly number[];

/** Of a field, what lines and files are made of; a Field serves. */
export interface FieldValues {
  readonly values: ArrayLike<number>;
  readonly refined?: DrawnSurface | null;
}

// ------------------------------------------------------------------------------------- distance

/** A method prepared for one surface. */
export interface Solver {
  readonly surface: Surface;
  readonly report: Report;
  solve(sources: Sources, call?: Call): Promise<Field>;
  /** Lines at the given distances from the region on the negative side of curves, with levels.
   * Levels that are met nowhere are missing. */
  offsets(sources: Sources, distances: readonly number[], shape?: Morphology, call?: Call): Promise<Lines>;
  dispose(): void;
}

/** What is done to a shape before its offsets are taken [length]. */
export interface Morphology {
  /** Erode by this, then dilate: thin parts go. */
  readonly open?: number;
  /** Dilate by this, then erode: gaps fill; after opening. */
  readonly close?: number;
}

export interface Field {
  /** At the vertices [length]; Infinity where no source reaches. */
  readonly values: Float64Array;
  /** At the vertices, 0 to 1: how sure the sign is; null unless asked for. */
  readonly confidence: Float64Array | null;
  /** The surface that the field lives on where that is not the surface itself: a finer one, one
   * split where values jump, or a cloud's triangles; with the scalar "distance". */
  readonly refined: DrawnSurface | null;
  readonly report: Report;
}

/** What a computation says about itself; docs/reference/report.md. */
export interface Report {
  readonly method: string;
  readonly domain: string;
  /** "converged", "not converged" (the best iterate) or "uncertain" (see the warnings). */
  readonly status: string;
  readonly options: Readonly<Record<string, string | number | boolean>>;
  readonly sizes: Readonly<Record<string, number>>;
  /** Seconds by stage. */
  readonly timings: Readonly<Record<string, number>>;
  readonly iterations: Readonly<Record<string, number>>;
  readonly residuals: Readonly<Record<string, number | string>>;
  /** A sentence each, with a code that stays the same when the wording changes. */
  readonly warnings: readonly { readonly code: string; readonly message: string }[];
  readonly unreachable_components: readonly number[];
}

export interface Regions {
  /** At the faces: the winding number of the larger part of each. */
  readonly region: Int32Array;
  /** The surface cut along the curves, with the scalars "winding", "region" and "weight". */
  readonly surface: DrawnSurface;
  readonly bounding: Lines;
  readonly nonbounding: Lines;
  readonly completed: Lines;
  /** The curves that bound something. */
  readonly boundingSources: Sources;
  readonly report: Report;
}
