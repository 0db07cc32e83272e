// What one can begin with: files of examples/data, put into the page by build.mjs.
import spot from "packed:examples/data/spot.obj";
import jersey from "packed:examples/data/spot-jersey.txt";
import { fromBase64, inflate } from "./packed";

export interface Example {
  readonly id: string;
  readonly title: string;
  readonly file: string;
  bytes(): Promise<Uint8Array>;
  /** The text of a source file, or none. */
  sources(): Promise<string>;
}

const text = (bytes: Uint8Array) => new TextDecoder().decode(bytes);

function ring(): Uint8Array {
  const around = 96, across = 40, lines: string[] = [];
  for (let i = 0; i < around; ++i) for (let j = 0; j < across; ++j) {
    const u = (2 * Math.PI * i) / around, v = (2 * Math.PI * j) / across, r = 1 + 0.42 * Math.cos(v);
    lines.push(`v ${(r * Math.cos(u)).toFixed(6)} ${(0.42 * Math.sin(v)).toFixed(6)} ${(r * Math.sin(u)).toFixed(6)}`);
  }
  const at = (i: number, j: number) => (i % around) * across + (j % across) + 1;
  for (let i = 0; i < around; ++i) for (let j = 0; j < across; ++j) {
    lines.push(`f ${at(i, j)} ${at(i, j + 1)} ${at(i + 1, j + 1)}`, `f ${at(i, j)} ${at(i + 1, j + 1)} ${at(i + 1, j)}`);
  }
  return new TextEncoder().encode(`${lines.join("\n")}\n`);
}

export const examples: readonly Example[] = [
  {
    id: "spot-jersey", title: "Spot, a broken outline", file: "spot.obj",
    bytes: () => inflate(fromBase64(spot)), sources: async () => text(await inflate(fromBase64(jersey))),
  },
  { id: "spot", title: "Spot, to draw on", file: "spot.obj", bytes: () => inflate(fromBase64(spot)), sources: async () => "" },
  { id: "ring", title: "Ring, to draw on", file: "ring.obj", bytes: async () => ring(), sources: async () => "" },
];
