// The shortest way from a place to the sources: down a distance, triangle by triangle.
import { cornerReader } from "./field";
import { between } from "./numbers";
import type { Field, SourceMarks, Surface, Triple } from "./scene";

export interface Descended {
  /** Three numbers a place, from the one asked for on. */
  places: number[];
  length: number;
  /** Does it end at a source, or where the field is zero? */
  reached: boolean;
}

/** Numbers of vertices, the same for vertices at one place. */
export function welded(positions: Float32Array): Uint32Array {
  const count = positions.length / 3, bits = new Uint32Array(positions.slice().map((x) => x + 0).buffer); // -0 is 0
  let size = 1;
  while (size < 2 * count) size *= 2;
  const table = new Int32Array(size).fill(-1), out = new Uint32Array(count);
  for (let v = 0; v < count; ++v) {
    const a = bits[3 * v], b = bits[3 * v + 1], c = bits[3 * v + 2];
    let slot = (Math.imul(a, 0x9e3779b1) ^ Math.imul(b, 0x85ebca6b) ^ Math.imul(c, 0xc2b2ae35)) >>> 0;
    slot = (slot ^ (slot >>> 15)) & (size - 1);
    for (;;) {
      const at = table[slot];
      if (at < 0) {
        table[slot] = v;
        out[v] = v;
        break;
      }
      if (bits[3 * at] === a && bits[3 * at + 1] === b && bits[3 * at + 2] === c) {
        out[v] = at;
        break;
      }
      slot = (slot + 1) & (size - 1);
    }
  }
  return out;
}

type Place = { triangle: number; b: Triple };
/** A way down inside of one triangle: how coordinates change by length, and how much is lost by length. */
interface Way { place: Place; rate: Triple; slope: number }

const onSide = 1e-6; // coordinates below are 0

export class Descent {
  private readonly vertex: Uint32Array; // of each corner, welded
  private readonly first: Uint32Array;  // triangles at each vertex, one after the other
  private readonly star: Uint32Array;

  constructor(private readonly surface: Surface) {
    const { positions, triangles } = surface, same = welded(positions), count = positions.length / 3;
    this.vertex = triangles.map((v) => same[v]);
    this.first = new Uint32Array(count + 1);
    for (const v of this.vertex) ++this.first[v + 1];
    for (let v = 0; v < count; ++v) this.first[v + 1] += this.first[v];
    this.star = new Uint32Array(triangles.length);
    const next = this.first.slice(0, count);
    for (let c = 0; c < this.vertex.length; ++c) this.star[next[this.vertex[c]]++] = Math.floor(c / 3);
  }

  /** From a place, to where |field| is 0 or to a mark of a source that is in sight. Lengths are the page's; `radius` is
   * what one of them is in the field's unit. */
  path(field: Field, radius: number, marks: SourceMarks, from: Place): Descended {
    const read = cornerReader(field, this.surface), { weights } = field, { triangles } = this.surface;
    const raw = (t: number, k: number) => {
      const x = read(t, k);
      if (!Number.isFinite(x) || (weights && weights[triangles[3 * t + k]] === 0)) return NaN;
      return between(field.low, field.high, x) / radius;
    };
    const sum = ({ triangle: t, b }: Place) => b[0] * raw(t, 0) + b[1] * raw(t, 1) + b[2] * raw(t, 2);
    const sign = sum(from) < 0 ? -1 : 1, value = (t: number, k: number) => sign * raw(t, k);
    const places = [...this.spot(from)], near = nearestMark(marks);
    let length = 0, here: Place = { triangle: from.triangle, b: [...from.b] };
    const go = (to: ArrayLike<number>) => {
      const n = places.length;
      length += Math.hypot(to[0] - places[n - 3], to[1] - places[n - 2], to[2] - places[n - 1]);
      places.push(to[0], to[1], to[2]);
    };
    const most = 1000 + triangles.length / 3;
    for (let step = 0; step < most; ++step) {
      const p = this.spot(here), height = sign * sum(here), side = this.longest(here.triangle), mark = near(p);
      if (!Number.isFinite(height)) break;
      if (mark && mark.away <= side && height <= 2 * side) {
        go(mark.place);
        return { places, length, reached: true };
      }
      const way = this.steepest(here, value);
      if (!way) { // the bottom: of triangles that hold a source, which is not at their corners
        if (mark && mark.away <= 2 * side) go(mark.place);
        return { places, length, reached: height <= side || (mark !== null && mark.away <= 2 * side) };
      }
      let reach = Infinity;
      way.place.b.forEach((x, k) => { if (way.rate[k] < 0) reach = Math.min(reach, x / -way.rate[k]); });
      const zero = height / way.slope, ends = zero <= reach;
      const b = way.place.b.map((x, k) => x + way.rate[k] * Math.min(reach, zero)) as Triple;
      here = { triangle: way.place.triangle, b: settled(b) };
      go(this.spot(here));
      if (ends) return { places, length, reached: true };
    }
    return { places, length, reached: false };
  }

  private spot({ triangle, b }: Place): Triple {
    const { positions: p, triangles } = this.surface;
    return [0, 1, 2].map((i) => b.reduce((sum, x, k) => sum + x * p[3 * triangles[3 * triangle + k] + i], 0)) as Triple;
  }

  private side(t: number, from: number, to: number): Triple {
    const { positions: p, triangles } = this.surface, a = 3 * triangles[3 * t + from], b = 3 * triangles[3 * t + to];
    return [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
  }

  private longest(t: number): number {
    return Math.max(...[0, 1, 2].map((k) => Math.hypot(...this.side(t, k, (k + 1) % 3))));
  }

  /** The same place in all triangles that have it. */
  private *around({ triangle, b }: Place): Generator<Place> {
    yield { triangle, b };
    const on = [0, 1, 2].filter((k) => b[k] > 0);
    if (on.length === 3) return;
    const names = on.map((k) => this.vertex[3 * triangle + k]);
    for (let i = this.first[names[0]]; i < this.first[names[0] + 1]; ++i) {
      const t = this.star[i], other: Triple = [0, 0, 0];
      if (t === triangle) continue;
      let found = 0;
      for (let k = 0; k < 3; ++k) {
        const at = names.indexOf(this.vertex[3 * t + k]);
        if (at < 0) continue;
        other[k] = b[on[at]];
        ++found;
      }
      if (found === names.length) yield { triangle: t, b: other };
    }
  }

  private steepest(here: Place, value: (t: number, k: number) => number): Way | null {
    let best: Way | null = null;
    for (const place of this.around(here)) for (const way of this.ways(place, value)) if (!best || way.slope > best.slope) best = way;
    return best;
  }

  /** Straight down where that stays inside, and down along the sides that the place is on. */
  private *ways(place: Place, value: (t: number, k: number) => number): Generator<Way> {
    const { triangle: t, b } = place, f = [0, 1, 2].map((k) => value(t, k));
    if (!f.every(Number.isFinite)) return;
    const u = this.side(t, 0, 1), v = this.side(t, 0, 2), dot = (x: Triple, y: Triple) => x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    const uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), area2 = uu * vv - uv * uv, p = f[1] - f[0], q = f[2] - f[0];
    const steep = 1e-9 * (Math.abs(f[0]) + Math.abs(f[1]) + Math.abs(f[2]));
    if (area2 > 1e-12 * uu * vv) {
      const r = (vv * p - uv * q) / area2, s = (uu * q - uv * p) / area2;   // the gradient is r u + s v
      const slope = Math.sqrt(Math.max(0, r * r * uu + 2 * r * s * uv + s * s * vv)), rate: Triple = [(r + s) / slope, -r / slope, -s / slope];
      if (slope * Math.sqrt(uu + vv) > steep && b.every((x, k) => x > 0 || rate[k] >= 0)) yield { place, rate, slope };
    }
    for (let k = 0; k < 3; ++k) {
      if (b[k] > 0) continue;
      const i = (k + 1) % 3, j = (k + 2) % 3, long = Math.hypot(...this.side(t, i, j)), rise = f[j] - f[i];
      const to = rise < 0 ? j : i, away = rise < 0 ? i : j;
      if (!(long > 0) || Math.abs(rise) <= steep || b[away] === 0) continue;
      const rate: Triple = [0, 0, 0];
      rate[to] = 1 / long;
      rate[away] = -1 / long;
      yield { place, rate, slope: Math.abs(rise) / long };
    }
  }
}

/** On sides and corners exactly where it is next to them. */
function settled(b: Triple): Triple {
  const clean = b.map((x) => (x < onSide ? 0 : x)), total = clean[0] + clean[1] + clean[2];
  return clean.map((x) => x / total) as Triple;
}

/** The nearest place of the marks of sources. */
function nearestMark({ signed, unsigned, points }: SourceMarks): (p: Triple) => { place: Triple; away: number } | null {
  return (p) => {
    let best = Infinity;
    const place: Triple = [0, 0, 0];
    const take = (x: number, y: number, z: number) => {
      const d = (x - p[0]) ** 2 + (y - p[1]) ** 2 + (z - p[2]) ** 2;
      if (!(d < best)) return;
      best = d;
      place[0] = x;
      place[1] = y;
      place[2] = z;
    };
    for (const ends of [signed, unsigned]) for (let i = 0; i < ends.length; i += 6) {
      const x = ends[i + 3] - ends[i], y = ends[i + 4] - ends[i + 1], z = ends[i + 5] - ends[i + 2], size = x * x + y * y + z * z;
      const along = (p[0] - ends[i]) * x + (p[1] - ends[i + 1]) * y + (p[2] - ends[i + 2]) * z;
      const part = size > 0 ? Math.min(1, Math.max(0, along / size)) : 0;
      take(ends[i] + part * x, ends[i + 1] + part * y, ends[i + 2] + part * z);
    }
    for (let i = 0; i < points.length; i += 3) take(points[i], points[i + 1], points[i + 2]);
    return best < Infinity ? { place, away: Math.sqrt(best) } : null;
  };
}
