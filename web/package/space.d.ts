// Signed distance in space, and volumes: a part of littoral.d.ts.
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
