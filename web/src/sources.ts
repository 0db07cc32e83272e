// Sources between JavaScript's objects and the library's .json source files, which are how they travel:
// what is wrong with them is said as of a file.
import type { Curve, Sources, SurfacePoint } from "../package/littoral";
import { InputError } from "./errors";

type Node = { v: number } | { e: readonly number[]; t: number } | { f: number; b: readonly number[] };
interface FileCurve {
  signed?: boolean;
  closed?: boolean;
  nodes?: Node[];
  points?: number[][];
}
interface SourceFile {
  curves: FileCurve[];
  points: Node[];
}

/** What crosses to the worker. */
export interface SourceText {
  json: string;
  chains: readonly (readonly number[])[];
}

function nodeOf(point: SurfacePoint): Node {
  if ("vertex" in point) return { v: point.vertex };
  if ("edge" in point) return { e: point.edge, t: point.t };
  if ("face" in point) return { f: point.face, b: point.barycentric };
  throw new InputError("a point on a surface has a vertex, an edge or a face");
}

const pointOf = (node: Node): SurfacePoint =>
  "v" in node ? { vertex: node.v }
  : "e" in node ? { edge: [node.e[0], node.e[1]], t: node.t }
  : { face: node.f, barycentric: [node.b[0], node.b[1], node.b[2]] };

function triples(numbers: ArrayLike<number>): number[][] {
  if (numbers.length % 3 !== 0) {
    throw new InputError(`positions have three coordinates each, there are ${numbers.length} numbers`);
  }
  return Array.from({ length: numbers.length / 3 }, (_, i) => [numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]]);
}

/** What JSON has no words for would arrive as null. */
function textOf(file: SourceFile): string {
  return JSON.stringify(file, (_, value: unknown) => {
    if (typeof value === "number" && !Number.isFinite(value)) {
      throw new InputError(`the number ${value} in sources is not finite`);
    }
    return value;
  });
}

export function sourceText(sources: Sources): SourceText {
  const { curves = [], points = [], spaceCurves = [], chains = [] } = sources;
  const onSurface = curves.map(({ nodes, signed = true, closed = false }) =>
    ({ signed, closed, nodes: nodes.map(nodeOf) }));
  const inSpace = spaceCurves.map(({ positions, signed = true, closed = false }) =>
    ({ signed, closed, points: triples(positions) }));
  const file = { curves: [...onSurface, ...inSpace], points: points.map(nodeOf) };
  const alone = chains.length > 0 && file.curves.length === 0 && points.length === 0;
  return { json: alone ? "" : textOf(file), chains };
}

/** Points as a file, and a path's nodes. */
export const pointsText = (points: readonly SurfacePoint[]): string =>
  textOf({ curves: [], points: points.map(nodeOf) });
export const pathText = (nodes: readonly SurfacePoint[], closed: boolean): string =>
  textOf({ curves: [{ closed, nodes: nodes.map(nodeOf) }], points: [] });

export const pointsOf = (json: string): SurfacePoint[] =>
  (JSON.parse(json) as SourceFile).points.map(pointOf);

export function sourcesOf({ json, chains }: { json: string; chains: Int32Array[] }): Sources {
  const file = JSON.parse(json) as SourceFile;
  const flags = ({ signed = true, closed = false }: FileCurve) => ({ signed, closed });
  const onSurface = file.curves.filter((curve) => curve.nodes);
  return {
    curves: onSurface.map((curve): Curve => ({ ...flags(curve), nodes: curve.nodes!.map(pointOf) })),
    points: file.points.map(pointOf),
    spaceCurves: file.curves.filter((curve) => curve.points)
      .map((curve) => ({ ...flags(curve), positions: Float64Array.from(curve.points!.flat()) })),
    chains: chains.map((chain) => Array.from(chain)),
  };
}
