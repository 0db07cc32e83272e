// The scene as the library writes it (docs/reference/scene.md), read and checked.

export const sceneVersion = 2;

export class SceneError extends Error {}

export type Triple = [number, number, number];
export type At = "vertex" | "face" | "corner" | "p2";

/** A field of a surface. Values are 0..1 between low and high; infinite ones are infinite. */
export interface Field {
  name: string;
  at: At;
  /** At vertices, triangles, corners (3 a triangle), or corners and the sides opposite them (6 a triangle). */
  values: Float32Array | null;
  /** Of vertices, 0..255: values are interpolated as sum b w v / sum b w. */
  weights: Uint8Array | null;
  low: number;
  high: number;
  colourLow: number;
  colourHigh: number;
  map: string;
  diverging: boolean;
  infinite: boolean;
  /** Integers that name regions. */
  discrete: boolean;
  labels: Map<number, string>;
  spacing: number;
  levels: number[];
}

export const operations = ["unite", "intersect", "subtract"] as const;
export type Operation = (typeof operations)[number];
export const mostClouds = 8;  // of a trace

export interface Volume {
  n: Triple;
  origin: Triple;
  spacing: Triple;
  low: Triple;
  high: Triple;
  values: Float32Array;
  axis: number;
  position: number;
  level: number;
  isosurface: boolean;
}

/** A cloud of a trace; samples: its distance at the volume's nodes, page units. */
export interface Cloud {
  operation: Operation;
  tori: Float32Array;
  samples: Float32Array;
}

/** Clouds that are one shape, rounded where they meet and moved outward. */
export interface Trace {
  clouds: Cloud[];
  blend: number;
  offset: number;
  steepness: number;
  low: number;
  range: number;
}

export interface SourceMarks {
  signed: Float32Array;
  unsigned: Float32Array;
  arrows: Float32Array;
  points: Float32Array;
  signedColour: Triple;
  unsignedColour: Triple;
}

export const shadings = ["smooth", "flat", "occluded"] as const;
export type Shading = (typeof shadings)[number];

/** How numbers of vertices and triangles name places of the input. */
export type Nodes = "none" | "vertices" | "faces";

export interface Surface {
  positions: Float32Array;
  triangles: Uint32Array;
  innerSides: Uint8Array | null;
  /** The input's face of each triangle, where it is not the triangle's own number. */
  faces: Uint32Array | null;
  nodes: Nodes;
  /** Four a vertex: how much of the sky is seen in a direction d, w / 255 + (1.5 xyz / 255 - .75) . d; or null. */
  openness: Uint8Array | null;
  /** Of a point cloud, four a vertex: the normal and the radius of the disc that is drawn there. */
  discs: Float32Array | null;
}

export interface SceneData {
  title: string;
  facts: [string, string][];
  options: [string, string][];
  warnings: string[];
  centre: Triple;
  radius: number;
  towardsEye: Triple;
  up: Triple;
  surface: Surface;
  fields: Field[];
  sources: SourceMarks;
  volume: Volume | null;
  trace: Trace | null;
  plainColour: Triple;
  infiniteColour: Triple;
  shading: Shading;
  /** Shown beside it with the same camera; in the same frame. */
  beside: SceneData | null;
}

type Json = Record<string, unknown>;

function refuse(what: string): never {
  throw new SceneError(`the scene is damaged: ${what}`);
}

function object(value: unknown, name: string): Json {
  if (typeof value !== "object" || value === null || Array.isArray(value)) refuse(`${name} is missing`);
  return value as Json;
}

const has = (from: Json, key: string) => from[key] !== undefined && from[key] !== null;

function number(from: Json, key: string): number {
  const x = from[key];
  if (typeof x !== "number" || !Number.isFinite(x)) refuse(`${key} is not a number`);
  return x;
}

const text = (from: Json, key: string): string => (typeof from[key] === "string" ? from[key] : refuse(`${key} is not a text`));

function list(from: Json, key: string): unknown[] {
  return Array.isArray(from[key]) ? (from[key] as unknown[]) : refuse(`${key} is not a list`);
}

function numbers(from: Json, key: string): number[] {
  const items = list(from, key);
  if (!items.every((x) => typeof x === "number" && Number.isFinite(x))) refuse(`${key} holds no numbers`);
  return items as number[];
}

const triple = (from: Json, key: string): Triple => {
  const items = numbers(from, key);
  return items.length === 3 ? (items as Triple) : refuse(`${key} is no triple`);
};

const pairs = (from: Json, key: string): [string, string][] =>
  list(from, key).map((pair) => (Array.isArray(pair) && pair.length === 2 ? [String(pair[0]), String(pair[1])] : refuse(`${key} holds no pairs`)));

interface FromBase64 {
  fromBase64?(text: string): Uint8Array<ArrayBuffer>;
}

/** Bytes in base64. */
export function bytesOf(encoded: string): Uint8Array<ArrayBuffer> {
  const quick = (Uint8Array as unknown as FromBase64).fromBase64;
  if (quick) return quick.call(Uint8Array, encoded);
  const raw = atob(encoded), out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) out[i] = raw.charCodeAt(i);
  return out;
}

function bytes(from: Json, key: string, size: number, count?: number): Uint8Array<ArrayBuffer> {
  let out: Uint8Array<ArrayBuffer>;
  try {
    out = bytesOf(text(from, key));
  } catch (error) {
    if (error instanceof SceneError) throw error;
    return refuse(`${key} is not base64`);
  }
  if (out.length % size || (count !== undefined && out.length !== size * count)) refuse(`${key} has the wrong length`);
  return out;
}

function floats(from: Json, key: string, count?: number): Float32Array {
  const out = new Float32Array(bytes(from, key, 4, count).buffer);
  return out;
}

function finite(array: Float32Array, key: string): Float32Array {
  for (let i = 0; i < array.length; ++i) if (!Number.isFinite(array[i])) refuse(`${key} holds a number that is not finite`);
  return array;
}

const valueCount = (at: At, vertices: number, triangles: number) =>
  ({ vertex: vertices, face: triangles, corner: 3 * triangles, p2: 6 * triangles })[at];

function readField(from: Json, vertices: number, triangles: number, ofVolume: boolean): Field {
  const at = (has(from, "at") ? text(from, "at") : "vertex") as At;
  if (!["vertex", "face", "corner", "p2"].includes(at)) refuse(`a field is given at "${at}"`);
  let values: Float32Array | null = null;
  if (has(from, "values") && !ofVolume) {
    values = floats(from, "values", valueCount(at, vertices, triangles));
    for (let i = 0; i < values.length; ++i) if (Number.isNaN(values[i])) refuse("a value is not a number");
  }
  const labels = new Map<number, string>();
  if (has(from, "labels")) for (const [key, label] of pairs(from, "labels")) labels.set(Number(key), label);
  return {
    name: text(from, "name"), at, values, labels,
    weights: has(from, "weights") ? bytes(from, "weights", 1, vertices) : null,
    low: number(from, "low"), high: number(from, "high"),
    colourLow: number(from, "colourLow"), colourHigh: number(from, "colourHigh"),
    map: text(from, "map"), diverging: from.diverging === true, infinite: from.infinite === true,
    discrete: from.discrete === true, spacing: number(from, "spacing"), levels: numbers(from, "levels"),
  };
}

function readSurface(from: Json): Surface {
  const positions = finite(floats(from, "positions"), "positions");
  const triangles = new Uint32Array(bytes(from, "triangles", 12).buffer);
  const vertices = positions.length / 3, count = triangles.length / 3;
  if (positions.length % 3) refuse("positions are no triples");
  if (count === 0) refuse("there are no triangles");
  for (let i = 0; i < triangles.length; ++i) if (triangles[i] >= vertices) refuse(`triangle ${Math.floor(i / 3)} refers to vertex ${triangles[i]}, there are ${vertices}`);
  return {
    positions, triangles,
    innerSides: has(from, "innerSides") ? bytes(from, "innerSides", 1, count) : null,
    faces: has(from, "faces") ? new Uint32Array(bytes(from, "faces", 4, count).buffer) : null,
    nodes: has(from, "nodes") ? (text(from, "nodes") as Nodes) : "none",
    openness: has(from, "openness") ? bytes(from, "openness", 4, vertices) : null,
    discs: has(from, "discs") ? finite(new Float32Array(bytes(from, "discs", 16, vertices).buffer), "discs") : null,
  };
}

/** Values at nodes, 0 to 1; 65535 is infinite. */
function steps(from: Json, n: Triple): Float32Array {
  const all = new Uint16Array(bytes(from, "values", 2, n[0] * n[1] * n[2]).buffer);
  return Float32Array.from(all, (step) => step === 65535 ? Infinity : step / 65534);
}

function readTrace(from: Json, volume: Volume): Trace {
  const low = number(from, "low"), range = number(from, "range");
  const clouds = list(from, "clouds").map((one): Cloud => {
    const cloud = object(one, "cloud"), tori = floats(cloud, "tori");
    if (tori.length === 0 || tori.length % 16) refuse("tori have 16 numbers each");
    const operation = operations.find((name) => name === cloud.operation) ?? refuse("a cloud is united, intersected or subtracted");
    const own = has(cloud, "values"), base = own ? number(cloud, "low") : low, factor = own ? number(cloud, "range") : range;
    return { operation, tori, samples: (own ? steps(cloud, volume.n) : volume.values).map((x) => base + factor * x) };
  });
  if (clouds.length < 1 || clouds.length > mostClouds) refuse(`a trace has 1 to ${mostClouds} clouds`);
  return { clouds, blend: number(from, "blend"), offset: number(from, "offset"), steepness: number(from, "steepness"), low, range };
}

function readVolume(from: Json): Volume {
  const n = triple(from, "n");
  if (!n.every((k) => Number.isInteger(k) && k >= 2)) refuse("the volume's size is no three integers from 2 on");
  return {
    n, values: steps(from, n), origin: triple(from, "origin"), spacing: triple(from, "spacing"),
    low: triple(from, "low"), high: triple(from, "high"), axis: number(from, "axis"),
    position: number(from, "position"), level: number(from, "level"), isosurface: from.isosurface === true,
  };
}

function readSources(from: Json): SourceMarks {
  return {
    signed: finite(floats(from, "signed"), "sources"), unsigned: finite(floats(from, "unsigned"), "sources"),
    arrows: finite(floats(from, "arrows"), "sources"), points: finite(floats(from, "points"), "sources"),
    signedColour: triple(from, "signedColour"), unsignedColour: triple(from, "unsignedColour"),
  };
}

function readPart(from: Json): SceneData {
  const frame = object(from.frame, "frame"), surface = readSurface(object(from.surface, "surface"));
  const volume = has(from, "volume") ? readVolume(object(from.volume, "volume")) : null;
  let trace: Trace | null = null;
  if (has(from, "trace")) {
    if (!volume) refuse("a trace needs a volume");
    trace = readTrace(object(from.trace, "trace"), volume);
  }
  const fields = list(from, "fields").map((field) =>
    readField(object(field, "field"), surface.positions.length / 3, surface.triangles.length / 3, volume !== null));
  return {
    title: text(from, "title"), facts: pairs(from, "facts"), options: pairs(from, "options"),
    warnings: list(from, "warnings").map(String),
    centre: triple(frame, "centre"), radius: number(frame, "radius"),
    towardsEye: triple(frame, "towardsEye"), up: triple(frame, "up"),
    surface, fields, sources: readSources(object(from.sources, "sources")), volume, trace,
    plainColour: triple(from, "plainColour"), infiniteColour: triple(from, "infiniteColour"),
    shading: shadings.find((name) => name === from.shading) ?? "smooth",
    beside: has(from, "beside") ? readPart(object(from.beside, "beside")) : null,
  };
}

/** Reads a scene; throws SceneError with a message for people. */
export function readScene(json: string): SceneData {
  let from: unknown;
  try {
    from = JSON.parse(json);
  } catch {
    return refuse("it is not JSON (was the file cut off?)");
  }
  const scene = object(from, "it");
  if (scene.format !== "littoral scene") throw new SceneError("this is no scene of littoral");
  if (scene.version !== sceneVersion)
    throw new SceneError(`the scene has version ${String(scene.version)}, this page shows version ${sceneVersion}: write it again with one littoral`);
  return readPart(scene);
}
