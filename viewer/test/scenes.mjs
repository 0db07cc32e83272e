// Scenes made here (docs/reference/scene.md), put into the page as the library does it, and the modules of src/.
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { execFileSync } from "node:child_process";
import * as esbuild from "esbuild";
import { bundleOptions } from "../bundle.mjs";
import { openPage } from "./browser.mjs";

const viewer = join(dirname(fileURLToPath(import.meta.url)), "..");
const folder = mkdtempSync(join(tmpdir(), "littoral-scenes-"));
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));

/// A module of src/, as the page has it.
export async function load(name) {
  const { outputFiles } = await esbuild.build({ ...bundleOptions(esbuild), entryPoints: [join(viewer, "src", name)], format: "esm" });
  const file = join(folder, `${name}.mjs`);
  writeFileSync(file, outputFiles[0].text);
  return import(pathToFileURL(file).href);
}

export const base64 = (array) => Buffer.from(array.buffer, array.byteOffset, array.byteLength).toString("base64");

/// A field of values in their own unit; `more` overrides.
export function field(name, values, more = {}) {
  const finite = values.filter(Number.isFinite), low = Math.min(...finite), high = Math.max(...finite), reach = Math.max(Math.abs(low), Math.abs(high));
  const diverging = low < 0;
  return {
    name, at: "vertex", diverging, discrete: false, infinite: finite.length < values.length, map: diverging ? "diverging" : "sequential",
    low, high, colourLow: diverging ? -reach : low, colourHigh: diverging ? reach : high, spacing: (high - low) / 10, levels: [],
    values: base64(Float32Array.from(values, (x) => (Number.isFinite(x) ? (high > low ? (x - low) / (high - low) : 0) : Infinity))),
    ...more,
  };
}

/// A flat square [-1, 1]^2 of n x n cells, seen from above.
export function square(n) {
  const positions = [], triangles = [];
  for (let j = 0; j <= n; ++j) for (let i = 0; i <= n; ++i) positions.push((2 * i) / n - 1, (2 * j) / n - 1, 0);
  for (let j = 0; j < n; ++j) for (let i = 0; i < n; ++i) {
    const v = i + (n + 1) * j;
    triangles.push(v, v + 1, v + n + 2, v, v + n + 2, v + n + 1);
  }
  return { positions, triangles };
}

/// A torus, standing on its side, of m x n quads cut in two.
export function torus(m, n) {
  const positions = [], triangles = [];
  for (let i = 0; i < m; ++i) for (let j = 0; j < n; ++j) {
    const a = (2 * Math.PI * i) / m, b = (2 * Math.PI * j) / n, r = 0.68 + 0.3 * Math.cos(b);
    positions.push(r * Math.cos(a), 0.3 * Math.sin(b), r * Math.sin(a));
    const at = (x, y) => (x % m) * n + (y % n);
    triangles.push(at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i + 1, j));
  }
  return { positions, triangles };
}

/// The unit normal of torus() at a place.
export function torusNormal([x, y, z]) {
  const r = Math.hypot(x, z);
  return [(x * (r - 0.68)) / r, y, (z * (r - 0.68)) / r].map((c) => c / 0.3);
}

/// The openness of a wall with that normal that sees a part of its half of the sky.
export const sky = (normal, part) => [...normal.map((c) => Math.round((255 * (part * 0.75 * c + 0.75)) / 1.5)), Math.round(255 * 0.5 * part)];

export function scene({ positions, triangles }, fields, more = {}) {
  const none = base64(new Float32Array(0));
  return {
    format: "littoral scene", version: 2, title: "test", facts: [], options: [], warnings: [],
    frame: { centre: [0, 0, 0], radius: 1, towardsEye: [0, 0, 1], up: [0, 1, 0] },
    surface: { positions: base64(Float32Array.from(positions)), triangles: base64(Uint32Array.from(triangles)), nodes: "faces" },
    fields,
    sources: { signed: none, unsigned: none, arrows: none, points: none, signedColour: [0, 122, 70], unsignedColour: [214, 0, 108] },
    plainColour: [196, 204, 214], infiniteColour: [150, 150, 150], ...more,
  };
}

let template = null, count = 0;

/// Opens the page with a scene (an object, or text as it stands in the page), and waits for its first picture.
export async function show(what, options = {}) {
  if (template === null) {
    execFileSync(process.execPath, [join(viewer, "build.mjs"), join(folder, "dist")]);
    template = readFileSync(join(folder, "dist/page.html"), "utf8");
  }
  const text = typeof what === "string" ? what : JSON.stringify(what).replace(/</g, "\\u003c");
  const file = join(folder, `page${count++}.html`);
  writeFileSync(file, template.replace("LITTORAL_TITLE", "test").replace('"LITTORAL_DATA"', () => text));
  const { hash = "", wait = true, ...rest } = options;
  const url = pathToFileURL(file).href;
  const shown = await openPage(url + hash, { colorScheme: "light", ...rest });
  if (wait) await shown.page.waitForFunction(() => window.littoral?.frames() > 0, null, { timeout: 30000 });
  return { ...shown, url };
}
