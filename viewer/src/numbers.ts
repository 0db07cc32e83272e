// Numbers as they are shown: rounding, spacing of lines, ticks (io/render/scene_style.cpp is the same).

/** A number to five significant digits, or to as many as tell apart what is `fine` apart. */
export function numberText(x: number, fine = 0): string {
  if (!Number.isFinite(x)) return Number.isNaN(x) ? "none" : x > 0 ? "infinite" : "-infinite";
  if (x === 0) return "0";
  const size = Math.abs(x), order = (y: number) => Math.floor(Math.log10(y));
  const digits = Math.min(15, Math.max(5, fine > 0 ? order(size) - order(fine) + 1 : 0));
  const plain = size >= 1e-4 && (size < 1e6 || (digits > 6 && size < 1e15));
  return plain ? String(Number(x.toPrecision(digits))) : x.toExponential(digits - 1).replace(/\.?0+e/, "e");
}

/** What numbers between two others have to tell apart. */
export const fineOf = (low: number, high: number): number => 1e-4 * (high - low);

/** What the numbers of ascending levels have to tell apart. */
export function fineOfLevels(levels: number[]): number {
  let least = Infinity;
  for (let i = 1; i < levels.length; ++i) least = Math.min(least, levels[i] - levels[i - 1]);
  return Number.isFinite(least) ? 0.01 * least : 0;
}

/** The number 1, 2, 2.5 or 5 times a power of ten that cuts high - low into about `count` parts; 0 if there is none. */
export function niceSpacing(low: number, high: number, count: number): number {
  const raw = high / count - low / count;
  if (!(count >= 1) || !(raw > 2.3e-308) || !Number.isFinite(raw)) return 0;
  const magnitude = 10 ** Math.floor(Math.log10(raw));
  let best = 0, miss = Infinity;
  for (const step of [1, 2, 2.5, 5, 10]) {
    const off = Math.abs(Math.log((step * magnitude) / raw));
    if (off < miss) {
      miss = off;
      best = step * magnitude;
    }
  }
  return Number.isFinite(best) ? Number(best.toPrecision(12)) : 0;
}

/** Multiples of `step` inside [low, high], ascending; at most 1000 of them. */
export function niceTicks(low: number, high: number, step: number): number[] {
  if (!(step > 0)) return [];
  const first = Math.ceil(low / step - 1e-9), last = Math.floor(high / step + 1e-9);
  if (!(last - first < 1000)) return [];
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, i) => (first + i === 0 ? 0 : (first + i) * step));
}

/** Spacings from few lines to many, each a nice one and less than the one before. */
export function spacings(low: number, high: number): number[] {
  const steps: number[] = [];
  for (let count = 2; count < 300; count *= 1.2) {
    const step = niceSpacing(low, high, count);
    if (step > 0 && (!steps.length || step < steps[steps.length - 1])) steps.push(step);
  }
  return steps;
}

/** low + t (high - low); what rounding leaves of 0 is 0. */
export function between(low: number, high: number, t: number): number {
  const a = low * (1 - t), b = high * t;
  return Math.abs(a + b) < 1e-12 * (Math.abs(a) + Math.abs(b)) ? 0 : a + b;
}
