// Values of a field at places of a surface, its style, and fields made of others.
import { between, niceSpacing } from "./numbers";
import type { Field, Surface } from "./scene";
import { gradients } from "./mesh";

/** Value 0..1 at a corner of a triangle. */
export function cornerReader(field: Field, surface: Surface): (t: number, k: number) => number {
  const values = field.values ?? new Float32Array(surface.positions.length / 3), { triangles } = surface;
  switch (field.at) {
    case "vertex": return (t, k) => values[triangles[3 * t + k]];
    case "face": return (t) => values[t];
    case "corner": return (t, k) => values[3 * t + k];
    case "p2": return (t, k) => values[6 * t + k];
  }
}

/** The value at a place of a triangle, in the field's own unit; infinite where a corner that counts is. */
export function valueAt(field: Field, surface: Surface, t: number, b: ArrayLike<number>): number {
  const read = cornerReader(field, surface);
  const w = [0, 1, 2].map((k) => (field.weights ? field.weights[surface.triangles[3 * t + k]] / 255 : 1));
  let total = 0, sum = 0;
  for (let k = 0; k < 3; ++k) total += w[k] * b[k];
  if (!(total > 0)) {
    w.fill(1);
    total = b[0] + b[1] + b[2];
  }
  for (let k = 0; k < 3; ++k) if (w[k] > 0) sum += ((w[k] * b[k]) / total) * read(t, k);
  if (Number.isNaN(sum)) return Infinity;
  if (field.at === "p2" && field.values) {
    const bulge = bulges(field.values, t);
    for (let k = 0; k < 3; ++k) sum += 4 * bulge[k] * b[(k + 1) % 3] * b[(k + 2) % 3];
  }
  if (!Number.isFinite(sum)) return sum;
  const value = between(field.low, field.high, sum);
  return field.discrete ? Math.round(value) : value;
}

/** How far the middles of the sides (opposite corner 0, 1, 2) are above the mean of their ends. */
export function bulges(p2: Float32Array, t: number): [number, number, number] {
  const mid = (k: number) => p2[6 * t + 3 + k] - 0.5 * (p2[6 * t + ((k + 1) % 3)] + p2[6 * t + ((k + 2) % 3)]);
  return [mid(0), mid(1), mid(2)];
}

export interface FieldInput {
  name: string;
  values: ArrayLike<number>;
  at?: Field["at"];
  isolines?: number;
  map?: string;
  weights?: Uint8Array | null;
}

/** A field of values in their own unit, with the colours and lines that the library would choose (field_style). */
export function makeField({ name, values, at = "vertex", isolines = 20, map, weights = null }: FieldInput): Field {
  let low = Infinity, high = -Infinity, infinite = false;
  for (let i = 0; i < values.length; ++i) {
    if (Number.isFinite(values[i])) {
      low = Math.min(low, values[i]);
      high = Math.max(high, values[i]);
    } else infinite = true;
  }
  if (!(low <= high)) low = high = 0;
  const reach = Math.max(Math.abs(low), Math.abs(high)), diverging = map ? map === "diverging" : low < -0.01 * reach;
  const scaled = new Float32Array(values.length);
  for (let i = 0; i < values.length; ++i)
    scaled[i] = Number.isFinite(values[i]) ? (high > low ? (values[i] - low) / (high - low) : 0) : Infinity;
  return {
    name, at, values: scaled, weights, low, high, infinite, diverging,
    colourLow: diverging ? -reach : low < 0.2 * high ? Math.min(0, low) : low, colourHigh: diverging ? reach : high,
    map: map ?? (diverging ? "diverging" : "sequential"), discrete: false, labels: new Map(),
    spacing: niceSpacing(low, high, isolines), levels: [],
  };
}

/** | grad f | - 1 on each triangle: how far a field is from being a distance. In the scene's own length. */
export function gradientField(field: Field, surface: Surface, radius: number): Field {
  const g = gradients(surface.positions, surface.triangles, cornerReader(field, surface));
  const values = new Float64Array(surface.triangles.length / 3), scale = (field.high - field.low) / radius;
  const read = cornerReader(field, surface);
  for (let t = 0; t < values.length; ++t) {
    const known = [0, 1, 2].every((k) => Number.isFinite(read(t, k)));
    values[t] = known ? Math.hypot(g[3 * t], g[3 * t + 1], g[3 * t + 2]) * scale - 1 : Infinity;
  }
  const made = makeField({ name: `|∇ ${field.name}| − 1`, values, at: "face", isolines: 0, map: "diverging" });
  const reach = Math.min(1, Math.max(Math.abs(made.low), Math.abs(made.high)));
  return { ...made, colourLow: -reach, colourHigh: reach };
}

/** What fields of one name that are shown side by side have in common: range and colours. */
export function commonField(fields: Field[]): Field | null {
  const first = fields[0], signed = fields.find((field) => field.diverging) ?? null;
  if (!first) return null;
  const least = (key: "low" | "colourLow") => Math.min(...fields.map((field) => field[key]));
  const most = (key: "high" | "colourHigh") => Math.max(...fields.map((field) => field[key]));
  let colourLow = least("colourLow"), colourHigh = most("colourHigh");
  // Ends that were asked for are those of all of them.
  const alike = fields.every((field) => field.colourLow === colourLow && field.colourHigh === colourHigh);
  if (signed && !alike) {
    colourHigh = Math.max(Math.abs(colourLow), Math.abs(colourHigh));
    colourLow = -colourHigh;
  }
  return {
    ...first, low: least("low"), high: most("high"), colourLow, colourHigh,
    map: (signed ?? first).map, diverging: signed !== null, infinite: fields.some((field) => field.infinite),
  };
}

/** a - b of two fields of one surface. */
export function differenceField(a: Field, b: Field): Field | null {
  if (!a.values || !b.values || a.at !== b.at || a.values.length !== b.values.length) return null;
  const values = new Float64Array(a.values.length);
  for (let i = 0; i < values.length; ++i) {
    const x = a.values[i], y = b.values[i];
    values[i] = Number.isFinite(x) && Number.isFinite(y)
      ? between(a.low, a.high, x) - between(b.low, b.high, y)
      : Infinity;
  }
  return makeField({ name: `${a.name} − ${b.name}`, values, at: a.at, map: "diverging", weights: a.weights });
}

/** Shares of the surface's area in `bins` equal parts of a range of values. */
export function histogram(field: Field, surface: Surface, bins: number, low = field.low, high = field.high): Float64Array {
  const out = new Float64Array(bins), { positions: p, triangles } = surface, read = cornerReader(field, surface);
  const scale = high > low ? (field.high - field.low) / (high - low) : 0, shift = high > low ? (field.low - low) / (high - low) : 0;
  let total = 0;
  for (let t = 0; t < triangles.length / 3; ++t) {
    const a = 3 * triangles[3 * t], b = 3 * triangles[3 * t + 1], c = 3 * triangles[3 * t + 2];
    const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
    const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
    const area = Math.sqrt((uy * vz - uz * vy) ** 2 + (uz * vx - ux * vz) ** 2 + (ux * vy - uy * vx) ** 2);
    for (let k = 0; k < 3; ++k) {
      const x = read(t, k) * scale + shift;
      if (Number.isFinite(x)) out[Math.min(bins - 1, Math.max(0, Math.floor(x * bins)))] += area;
      total += area;
    }
  }
  if (total > 0) for (let i = 0; i < bins; ++i) out[i] /= total;
  return out;
}
