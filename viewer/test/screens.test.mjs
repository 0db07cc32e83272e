// Pictures of whole pages beside those in test/screens: alike but for fonts and rounding. UPDATE=1 npm test makes them
// anew; look at them before they are committed.
import assert from "node:assert/strict";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { test } from "node:test";
import { drawing, firefox, frames } from "./browser.mjs";
import { base64, field, scene, show, sky, torus, torusNormal } from "./scenes.mjs";

drawing.smooth = true;
const folder = join(dirname(fileURLToPath(import.meta.url)), "screens");
const shape = torus(72, 36), at = (v, k) => shape.positions[3 * v + k], each = (f) => Array.from({ length: shape.positions.length / 3 }, (_, v) => f(v));
const view = { centre: [0, 0, 0], radius: 1, towardsEye: [0, 0.6, 0.8], up: [0, 0.8, -0.6] };
const facts = { facts: [["method", "signed-heat"], ["faces", "5184"]], options: [["time", "1"]], warnings: ["2 gaps of curves were traced across the mesh"], frame: view };
const signed = () => scene(shape, [field("distance", each((v) => at(v, 0) + 0.4 * at(v, 2)), { spacing: 0.1 })], { title: "torus", ...facts });
const parts = () => scene(shape, [
  field("distance", each((v) => (at(v, 0) > 0.5 ? Infinity : Math.hypot(at(v, 0) + 1, at(v, 2)))), { spacing: 0.1 }),
  field("region", Array.from({ length: 5184 }, (_, t) => Math.floor(t / 864) - 2), { at: "face", discrete: true, spacing: 0 }),
], { title: "torus", ...facts });
const pair = () => scene(shape, [field("distance", each((v) => Math.hypot(at(v, 0) + 1, at(v, 2))), { spacing: 0.2 })], {
  title: "first", ...facts,
  beside: scene(shape, [field("distance", each((v) => 1.3 * Math.hypot(at(v, 0) + 1, at(v, 1), at(v, 2))), { spacing: 0.2 })], { title: "second", frame: view }),
});
/// Distance from a place of the outer rim, straight through space: what leads to it is much like the way along the surface.
const far = () => field("distance", each((v) => Math.hypot(at(v, 0) - 0.98, at(v, 1), at(v, 2))), { spacing: 0.1 });
const place = (v) => [at(v, 0), at(v, 1), at(v, 2)];
function occluded() {
  const made = scene(shape, [far()], { title: "torus", ...facts, shading: "occluded" });
  made.surface.openness = base64(Uint8Array.from(each((v) => sky(torusNormal(place(v)), 0.5 + 0.5 * Math.min(1, Math.hypot(at(v, 0), at(v, 2)) ** 3))).flat()));
  return made;
}
function cloud() {
  const made = scene(shape, [far()], { title: "points", ...facts });
  Object.assign(made.surface, { nodes: "vertices", discs: base64(Float32Array.from(each((v) => [...torusNormal(place(v)), 0.054]).flat())) });
  return made;
}
/// The distance from a ring, cut open by a tilted slice.
function ring() {
  const n = 48, step = 2 / (n - 1), low = -0.25, high = 1.5, steps = new Uint16Array(n ** 3);
  for (let v = 0; v < steps.length; ++v) {
    const [x, y, z] = [v % n, Math.floor(v / n) % n, Math.floor(v / n / n)].map((i) => i * step - 1);
    steps[v] = Math.round((65534 * (Math.hypot(Math.hypot(x, y) - 0.6, z) - 0.25 - low)) / (high - low));
  }
  const box = { positions: [-1, -1, -1, 1, -1, -1, 1, 1, 1, -1, 1, 1], triangles: [0, 1, 2, 0, 2, 3] };
  return scene(box, [{ ...field("distance", [low, high]), spacing: 0.1, values: undefined }], {
    title: "ring", ...facts, shading: "occluded",
    volume: { n: [n, n, n], origin: [-1, -1, -1], spacing: [step, step, step], low: [-1, -1, -1], high: [1, 1, 1], values: base64(steps), axis: 2, position: 0.5, level: -low / (high - low), isosurface: true },
  });
}
/// Pins a place, and with it the way from there.
async function pinned(page) {
  const at = await page.evaluate(() => littoral.view.project([-0.5, 0.27, 0.35])), stage = await page.locator("#stage").boundingBox();
  await page.mouse.click(stage.x + at.x, stage.y + at.y);
  await page.mouse.move(stage.x + 60, stage.y + stage.height - 4);
}

const screens = [
  ["light-1400", signed(), { viewport: { width: 1400, height: 900 } }],
  ["dark-420", signed(), { viewport: { width: 420, height: 800 }, colorScheme: "dark", hash: "#labels=1" }],
  ["unreachable-900", parts(), { viewport: { width: 900, height: 560 }, hash: "#map=viridis" }],
  ["regions-dark-900", parts(), { viewport: { width: 900, height: 560 }, colorScheme: "dark", hash: "#field=region" }],
  ["beside-1000", pair(), { viewport: { width: 1000, height: 560 } }],
  ["way-1400", scene(shape, [far()], { title: "torus", ...facts }), { viewport: { width: 1400, height: 900 }, act: pinned }],
  ["way-dark-420", scene(shape, [far()], { title: "torus", ...facts }), { viewport: { width: 420, height: 800 }, colorScheme: "dark", act: pinned }],
  ["occluded-1400", occluded(), { viewport: { width: 1400, height: 900 } }],
  ["occluded-dark-420", occluded(), { viewport: { width: 420, height: 800 }, colorScheme: "dark" }],
  ["discs-1400", cloud(), { viewport: { width: 1400, height: 900 } }],
  ["discs-dark-420", cloud(), { viewport: { width: 420, height: 800 }, colorScheme: "dark" }],
  ["volume-900", ring(), { viewport: { width: 900, height: 560 }, hash: "#slice=0.3,0.35,0.89,-0.3" }],
  ["folded-360", signed(), { viewport: { width: 360, height: 640 }, hash: "#panel=0&range=-0.5,0.6" }],
];

/// Mean difference of two pictures, and the share of 8 x 8 blocks that differ by more than 20 on average.
const compare = (page, one, two) => page.evaluate(async ([a, b]) => {
  const read = async (text) => {
    const image = new Image();
    image.src = `data:image/png;base64,${text}`;
    await image.decode();
    const canvas = document.createElement("canvas");
    canvas.width = Math.ceil(image.width / 8);
    canvas.height = Math.ceil(image.height / 8);
    const context = canvas.getContext("2d");
    context.imageSmoothingQuality = "high";
    context.drawImage(image, 0, 0, canvas.width, canvas.height);
    return { size: `${image.width} x ${image.height}`, bytes: context.getImageData(0, 0, canvas.width, canvas.height).data };
  };
  const [p, q] = [await read(a), await read(b)];
  if (p.size !== q.size) return { mean: 255, far: 1 };
  let sum = 0, far = 0;
  for (let i = 0; i < p.bytes.length; i += 4) {
    const apart = Math.max(...[0, 1, 2].map((k) => Math.abs(p.bytes[i + k] - q.bytes[i + k])));
    sum += apart;
    if (apart > 20) ++far;
  }
  return { mean: (4 * sum) / p.bytes.length, far: (4 * far) / p.bytes.length };
}, [one, two]);

for (const [name, made, { act, ...options }] of screens) test(`the page looks as it did: ${name}`, async () => {
  const shown = await show(made, options), file = join(folder, `${name}.png`);
  try {
    if (/labels=1/.test(options.hash ?? "")) await shown.page.waitForFunction(() => littoral.written() > 0);
    await act?.(shown.page);
    if (made.volume) await shown.page.waitForFunction(() => littoral.settled());
    await frames(shown.page);
    const taken = await shown.page.screenshot();
    assert.deepEqual(shown.errors, []);
    if (process.env.UPDATE) {
      mkdirSync(folder, { recursive: true });
      writeFileSync(file, taken);
      return;
    }
    assert.ok(existsSync(file), `${file} is missing: UPDATE=1 makes it`);
    const { mean, far } = await compare(shown.page, taken.toString("base64"), readFileSync(file).toString("base64"));
    const [most, mostFar] = firefox ? [5, 0.06] : [2.5, 0.02];  // whose lists and sliders look otherwise
    assert.ok(mean < most && far < mostFar, `${mean.toFixed(2)} apart on average, ${(100 * far).toFixed(1)} % of the blocks far`);
  } finally {
    await shown.close();
  }
});
