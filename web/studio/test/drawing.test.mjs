// Drawing with the mouse: what comes out is what the command line computes from the saved sources.
import assert from "node:assert/strict";
import { join } from "node:path";
import { after, before, test } from "node:test";
import {
  assertClose, byProgram, changedPixels, clickAll, closeQuietly, openStudio, ring, root, saved, settled, state,
} from "./helpers.mjs";

const spot = join(root, "examples/data/spot.obj");
let shown, page;
before(async () => {
  shown = await openStudio({ example: "spot" });
  page = shown.page;
});
after(() => closeQuietly(shown));

test("an example begins without anything drawn", async () => {
  const { strokes, points, values, message } = await state(page);
  assert.deepEqual([strokes, points, values, message], [[], 0, null, null]);
});

test("a curve of clicks gives the distance of the command line", async () => {
  const places = await ring(page, 5);
  assert.ok(places.length >= 4);
  await page.click("#mode-curve");
  await clickAll(page, places);
  const { strokes, values } = await state(page);
  assert.deepEqual(strokes, [{ nodes: places.length, closed: false, signed: true }]);
  const { name, bytes } = await saved(page, "save-sources");
  assert.equal(name, "spot-sources.txt");
  assertClose(values, byProgram(spot, bytes), 1e-9);
});

test("quick previews come before the exact answer, and say so", async () => {
  await page.evaluate(() => {
    window.seen = [];
    const take = studio.take.bind(studio);
    studio.take = (answer, stamp) => {
      take(answer, stamp);
      studio.idle();
      seen.push([answer.preview, answer.report.options.metric ?? null, document.getElementById("status").textContent.split(":")[0]]);
    };
    studio.engine.lastWhole = Infinity; // as if exact distance took long
    studio.changed();
  });
  await settled(page);
  assert.deepEqual(await page.evaluate(() => seen), [
    [true, null, "fast-marching, preview of the curves as drawn, not completed yet"],
    [true, "fast-marching", "auto, preview by metric fast-marching"], [false, "exact", "auto"],
  ]);
  assert.doesNotMatch((await state(page)).status, /preview/);
});

test("the saved field holds the same numbers", async () => {
  const { bytes } = await saved(page, "save-field", ".txt");
  assertClose(bytes.toString().trim().split("\n").map(Number), (await state(page)).values, 1e-300);
});

test("a click on the first node closes the curve, and inside becomes negative to its right", async () => {
  const [first] = await ring(page, 5);
  await page.mouse.click(first.x, first.y);
  const { strokes, values } = await state(page);
  assert.equal(strokes[0].closed, true);
  assert.ok(Math.min(...values) < 0 && Math.max(...values) > 0);
  const { bytes } = await saved(page, "save-sources");
  assertClose(values, byProgram(spot, bytes), 1e-9);
});

test("reversing turns the sign, undo and redo go back and forth", async () => {
  const before_ = (await state(page)).values;
  await page.click("#reverse");
  assertClose((await state(page)).values, before_.map((x) => -x), 1e-6);
  await page.keyboard.press("Control+z");
  assertClose((await state(page)).values, before_, 1e-12);
  await page.keyboard.press("Control+Shift+z");
  assertClose((await state(page)).values, before_.map((x) => -x), 1e-6);
  await page.click("#close");
  assert.equal((await state(page)).strokes[0].closed, false);
  await page.click("#undo");
  assert.equal((await state(page)).strokes[0].closed, true);
});

test("a node that is dragged moves, as one step", async () => {
  const at = await page.evaluate(() => studio.stage.project(studio.layout.nodes[0][1]));
  const { values } = await state(page);
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  for (let i = 1; i <= 5; ++i) await page.mouse.move(at.x - 4 * i, at.y + 3 * i);
  await page.mouse.up();
  await settled(page);
  const moved = await page.evaluate(() => studio.stage.project(studio.layout.nodes[0][1]));
  assert.ok(Math.hypot(moved.x - at.x + 20, moved.y - at.y - 15) < 4, JSON.stringify([at, moved]));
  assert.notDeepEqual((await state(page)).values, values);
  await page.click("#undo");
  assertClose((await state(page)).values, values, 1e-12);
});

test("an unsigned curve has distance to both sides", async () => {
  await page.click("#signed");
  const { strokes, values } = await state(page);
  assert.equal(strokes[0].signed, false);
  assert.ok(Math.min(...values) > -1e-9);
  await page.click("#undo");
});

test("a freehand stroke that ends where it began is a closed curve of many nodes", async () => {
  await page.click("#mode-turn");
  await page.keyboard.press("Escape");
  await page.click("#mode-freehand");
  const places = await ring(page, 40, 0.1), [first] = places;
  assert.equal(places.length, 40);
  await page.mouse.move(first.x, first.y);
  await page.mouse.down();
  for (const { x, y } of places) await page.mouse.move(x, y);
  await page.mouse.move(first.x, first.y);
  await page.mouse.up();
  const { strokes, values } = await state(page);
  assert.equal(strokes.length, 2);
  assert.equal(strokes[1].closed, true);
  assert.ok(strokes[1].nodes > 15);
  const { bytes } = await saved(page, "save-sources");
  assertClose(values, byProgram(spot, bytes), 1e-9);
});

test("regions of the closed curve", async () => {
  await page.selectOption("#task", "regions");
  const { values, method } = await state(page);
  assert.equal(method, "surface-winding");
  assert.ok(new Set(values.map(Math.round)).size >= 2);
  await page.selectOption("#task", "distance");
  await settled(page);
});

test("points, snapped to vertices", async () => {
  await page.click("#mode-point");
  await page.click("#snap");
  const [{ x, y }] = await ring(page, 3, 0.05);
  await page.mouse.click(x, y);
  await settled(page);
  const node = await page.evaluate(() => studio.history.drawing.points[0]);
  assert.ok(Number.isInteger(node.vertex));
  assert.ok(Math.abs((await state(page)).values[node.vertex]) < 1e-6);
  await page.click("#snap");
});

test("deleting everything leaves the plain surface", async () => {
  assert.ok(await changedPixels(page, async () => {
    for (const id of ["#curves li:nth-child(3) button", "#curves li:nth-child(2) button", "#curves li:nth-child(1) button"]) {
      await page.click(id);
      await page.keyboard.press("Delete");
    }
  }) > 1000);
  const { strokes, points, values } = await state(page);
  assert.deepEqual([strokes, points, values], [[], 0, null]);
});
