// The page's units: the model's box about the origin with half its diagonal 1, in single precision.
import type { FirstView } from "littoral/inline";

export type Frame = FirstView;

export function toPage(positions: Float64Array, { centre, radius }: Frame): Float32Array {
  const out = new Float32Array(positions.length);
  for (let i = 0; i < positions.length; ++i) {
    const x = (positions[i] - centre[i % 3]) / radius;
    out[i] = Number.isFinite(x) ? x : 0;
  }
  return out;
}
