// Colour maps, from the table that pictures are made with too.
import table from "../../src/io/render/colour_maps.inc";

export type Rgb = [number, number, number];
type Stop = [at: number, r: number, g: number, b: number];

function stopsOf(text: string): Stop[] {
  return [...text.matchAll(/\{([^}]*)\}/g)].map((match) => match[1].split(",").map(Number) as Stop);
}

const stops = new Map<string, Stop[]>();
let regions: Stop[] = [];
for (const line of table.split("\n")) {
  const map = /^MAP\((\w+),(.*)\)\s*$/.exec(line);
  if (map) stops.set(map[1], stopsOf(map[2]));
  else if (line.startsWith("REGIONS(")) regions = stopsOf(line);
}

export const mapNames: readonly string[] = [...stops.keys()];

const linear = (byte: number) => (byte / 255 <= 0.04045 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4);
function toOklab([, r8, g8, b8]: Stop): Rgb {
  const r = linear(r8), g = linear(g8), b = linear(b8);
  const l = Math.cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const m = Math.cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const s = Math.cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return [
    0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s,
    1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s,
    0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s,
  ];
}

function fromOklab([L, A, B]: Rgb): Rgb {
  const l = (L + 0.3963377774 * A + 0.2158037573 * B) ** 3;
  const m = (L - 0.1055613458 * A - 0.0638541728 * B) ** 3;
  const s = (L - 0.0894841775 * A - 1.291485548 * B) ** 3;
  const byte = (c: number) =>
    Math.round(255 * Math.min(1, Math.max(0, c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055)));
  return [
    byte(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
    byte(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
    byte(-0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s),
  ];
}

/** The 256 colours of a map, three bytes each, from low to high. Unknown names mean "sequential". */
export function colourMap(name: string): Uint8Array {
  const map = stops.get(name) ?? stops.get("sequential") ?? [];
  const labs = map.map(toOklab), bytes = new Uint8Array(3 * 256);
  for (let i = 0; i < 256; ++i) {
    const x = i / 255;
    let k = 1;
    while (k + 1 < map.length && map[k][0] < x) ++k;
    const t = (x - map[k - 1][0]) / (map[k][0] - map[k - 1][0]);
    bytes.set(fromOklab([0, 1, 2].map((c) => (1 - t) * labs[k - 1][c] + t * labs[k][c]) as Rgb), 3 * i);
  }
  return bytes;
}

/** Where between its ends a map has its middle, 0..1: of two hues at 0, however far from it the ends are. */
export function middleOf(map: string, low: number, high: number): number {
  if (map !== "diverging" || !(high > low)) return 0.5;
  return (Math.min(high, Math.max(low, 0)) - low) / (high - low);
}

/** The place in a map, 0..1, of what is a part 0..1 of the way between its ends. */
export function placeInMap(part: number, middle: number): number {
  const u = Math.min(1, Math.max(0, part));
  if (u === middle) return 0.5;
  return u < middle ? (0.5 * u) / middle : 0.5 + (0.5 * (u - middle)) / (1 - middle);
}

/** The colour of a region by its number. */
export function regionColour(number: number): Rgb {
  const n = regions.length - 1;
  const i = number === 0 ? 0 : number > 0 ? 1 + ((number - 1) % n) : n - ((-number - 1) % n);
  return regions[i].slice(1) as Rgb;
}

/** How light a colour looks, 0..1 (OKLab's L). */
export const lightness = (rgb: Rgb): number => toOklab([0, ...rgb])[0];

export const css = (rgb: ArrayLike<number>): string => `rgb(${rgb[0]},${rgb[1]},${rgb[2]})`;
