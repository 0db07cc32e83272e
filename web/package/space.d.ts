// Signed distance in space, volumes, repaired shapes and samples: a part of littoral.d.ts.
import type { Call, Morphology, Report, Surface } from "./littoral.js";

export interface Orientation {
  /** The other side is positive. */
  readonly flip?: boolean;
  /** Of a cloud, instead of those it has. */
  readonly estimateNormals?: boolean;
}

export type Triple = readonly [number, number, number];

/** Nodes at origin + (i, j, k) * spacing; x runs fastest. */
export interface Grid {
  readonly n: Triple;
  readonly origin: Triple;
  readonly spacing: Triple;
}

/** At most one of resolution and spacing; without both, 64 nodes. */
export interface GridOptions {
  /** Nodes along the longest side. */
  readonly resolution?: number;
  readonly spacing?: number;
  /** x0 y0 z0 x1 y1 z1 */
  readonly bounds?: readonly [number, number, number, number, number, number];
  /** Without bounds: margin around the input, in its longest side; default 0.25. */
  readonly padding?: number;
}

/** A flat grid of points: origin + i / (n[0] - 1) u + j / (n[1] - 1) v; i runs fastest. */
export interface Slice {
  readonly origin: Triple;
  readonly u: Triple;
  readonly v: Triple;
  readonly n: readonly [number, number];
}

/** Signed distance around a surface, negative inside [length]. */
export interface Sdf {
  readonly report: Report;
  /** The corners of the box around the input: x0 y0 z0 x1 y1 z1. */
  readonly bounds: readonly [number, number, number, number, number, number];
  /** At points. UnsupportedError for methods that need a grid: sample, then ask the volume. */
  at(points: ArrayLike<number>, call?: Call): Promise<Float64Array>;
  slice(slice: Slice, call?: Call): Promise<Float64Array>;
  withGradients(points: ArrayLike<number>, call?: Call): Promise<{ values: Float64Array; gradients: Float64Array }>;
  /** Where the input itself is nearest. */
  closest(points: ArrayLike<number>, call?: Call): Promise<NearestPoints>;
  /** 1 inside, 0 outside of a closed surface. */
  windingNumber(points: ArrayLike<number>, call?: Call): Promise<Float64Array>;
  /** How sure inside and outside are, 0 to 1. */
  confidence(points: ArrayLike<number>, call?: Call): Promise<Float64Array>;
  sample(grid?: GridOptions | Grid, call?: Call): Promise<Volume>;
  dispose(): void;
}

export interface NearestPoints {
  readonly positions: Float64Array;
  /** Face of a surface, point of a cloud. */
  readonly elements: Int32Array;
  /** Three vertices each, and the barycentric coordinates on them. */
  readonly corners: Int32Array;
  readonly barycentric: Float64Array;
  readonly distances: Float64Array;
}

/** Values at the nodes of a grid, in the worker. */
export interface Volume {
  readonly name: string;
  readonly grid: Grid;
  /** At the nodes, x fastest. */
  values(call?: Call): Promise<Float64Array>;
  /** Linear between nodes; NaN outside of the box. */
  at(points: ArrayLike<number>, call?: Call): Promise<Float64Array>;
  slice(slice: Slice, call?: Call): Promise<Float64Array>;
  /** The surface on which the volume takes the value `level` (0). */
  isosurface(level?: number, closeAtBox?: boolean, call?: Call): Promise<Surface>;
  /** The surfaces at these distances from the shape {values <= 0}. */
  offsets(distances: readonly number[], shape?: Morphology, call?: Call): Promise<Surface[]>;
  /** Signed distance to what the volume bounds. */
  signedDistance(meaning?: "automatic" | "distance" | "mask" | "density", threshold?: number, call?: Call): Promise<Sdf>;
  /** The bytes of a file: .vti .nrrd .npy .npz .... */
  write(name: string, call?: Call): Promise<Uint8Array>;
  dispose(): void;
}

/** What `Surface.repair` makes of a surface; lengths in the unit of the input. */
export interface RepairOptions {
  /** Of the grid that the surface is taken from: nodes along the longest side, or a spacing. Without both, 128 nodes, or
   * up to 256 where parts are thin. */
  readonly resolution?: number;
  readonly spacing?: number;
  /** > 0: finer grids, up to 512 nodes, until no point of the result is farther than that from the input. */
  readonly error?: number;
  /** > 0: sheets become walls that thick. */
  readonly thicken?: number;
  /** Parts whose boxes have shorter diagonals go. */
  readonly smallestPart?: number;
  /** Keep parts that are holes in others; default true. */
  readonly cavities?: boolean;
  /** Take the surface from a grid also where the input's own triangles will do. */
  readonly remesh?: boolean;
  /** Move vertices onto the input; default true. */
  readonly fit?: boolean;
}

/** A closed, manifold surface without crossings; where it is not, the report's status is "uncertain" and says why. */
export interface Repaired {
  readonly surface: Surface;
  readonly report: Report;
}

/** What is sampled; lengths in half sides of the cube about the input. */
export interface SampleOptions {
  /** Nodes along a side of the cube, of the grid for the surface; default 64. */
  readonly resolution?: number;
  /** How many points on the surface, and in space; default 8192 each. */
  readonly surface?: number;
  readonly space?: number;
  /** Shares: of the surface's points where normals turn; of space's points anywhere, and near where normals turn. */
  readonly sharp?: number;
  readonly uniform?: number;
  readonly curvature?: number;
  /** How far from the surface, deviations in equal shares. */
  readonly scales?: readonly number[];
  /** Of the cube about the input, in its longest side; default 0.1. */
  readonly margin?: number;
  readonly seed?: number;
  /** How positions and distances are rounded; default "float32". */
  readonly numbers?: "float16" | "float32" | "float64";
}

/** Points on a shape and around it in the cube [-1, 1]^3; a point x of the input is at (x - centre) / halfSide. */
export interface Samples {
  readonly centre: Triple;
  readonly halfSide: number;
  readonly surfacePoints: Float64Array;
  /** Outward. */
  readonly surfaceNormals: Float64Array;
  readonly surfaceConfidence: Float64Array;
  /** 0 by area, 1 where normals turn. */
  readonly surfaceKinds: Uint8Array;
  readonly points: Float64Array;
  /** Negative inside. */
  readonly distances: Float64Array;
  readonly confidence: Float64Array;
  /** 0 anywhere, 2 near the surface, 3 near where normals turn. */
  readonly kinds: Uint8Array;
  readonly deviations: Float64Array;
  /** Version, options, normalisation and figures of quality: JSON. */
  readonly card: string;
  /** The bytes of the file that was named. */
  readonly file: Uint8Array;
  readonly report: Report;
}
