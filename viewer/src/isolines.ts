// Isolines as segments, for numbers on them and for drawings.

export interface LevelSegments {
  level: number;
  /** Six numbers a segment. */
  ends: number[];
}

/** A field that is linear on triangles: values in their own unit at corner k of triangle t. */
export interface LinearField {
  positions: ArrayLike<number>;
  triangles: ArrayLike<number>;
  corner: (t: number, k: number) => number;
}

/** The segments along which a field takes each of some ascending levels. Triangles with a corner that is not finite have none. */
export function isolines({ positions: p, triangles, corner }: LinearField, levels: number[]): LevelSegments[] {
  const out = levels.map((level) => ({ level, ends: [] as number[] })), value = [0, 0, 0], count = triangles.length / 3;
  for (let t = 0; t < count; ++t) {
    for (let k = 0; k < 3; ++k) value[k] = corner(t, k);
    const low = Math.min(value[0], value[1], value[2]), high = Math.max(value[0], value[1], value[2]);
    if (!Number.isFinite(high) || !(high > low)) continue;
    let first = 0, end = levels.length;
    while (first < end) {
      const middle = (first + end) >> 1;
      if (levels[middle] <= low) first = middle + 1;
      else end = middle;
    }
    for (let i = first; i < levels.length && levels[i] <= high; ++i) {
      const { ends } = out[i], before = ends.length;
      for (let k = 0; k < 3; ++k) {
        const j = (k + 1) % 3;
        if (value[k] < levels[i] === value[j] < levels[i]) continue;
        const part = (levels[i] - value[k]) / (value[j] - value[k]), a = 3 * triangles[3 * t + k], b = 3 * triangles[3 * t + j];
        for (let c = 0; c < 3; ++c) ends.push(p[a + c] + part * (p[b + c] - p[a + c]));
      }
      if (ends.length !== before + 6) ends.length = before;
    }
  }
  return out;
}
