// VOLUME_PAGE=page.html npm test: a page of a volume made by the library (littoral_tests writes a
// suitable one to LITTORAL_VOLUME_PAGE_OUT): the distance from a sphere of radius 0.6 in [-1, 1]^3.
import assert from "node:assert/strict";
import { after, test } from "node:test";
import { assertAccessible, assertAlone, changed, drag as dragOn, openResult } from "./browser.mjs";

const shown = await openResult("VOLUME_PAGE");
const { page } = shown;
after(() => shown.close());

const drag = (id, value) => dragOn(page, id, value);

// Least and greatest distance of the surface's points from the origin, in the volume's unit.
const radii = () => page.evaluate(() => {
  const p = littoral.volume.positions;
  let low = Infinity, high = 0;
  for (let i = 0; i < p.length; i += 3) {
    const r = Math.hypot(p[i], p[i + 1], p[i + 2]) * Math.sqrt(3);  // the page's unit is half the diagonal
    low = Math.min(low, r);
    high = Math.max(high, r);
  }
  return { low, high, triangles: littoral.volume.triangleCount };
});

test("the surface is the sphere", async () => {
  const { low, high, triangles } = await radii();
  assert.ok(Math.abs(low - 0.6) < 0.01 && Math.abs(high - 0.6) < 0.01, `radii ${low} to ${high}`);
  assert.ok(triangles > 1000);
  assert.equal(await page.textContent("#level-text"), "0");
});

test("the level slider moves the surface", async () => {
  const pixels = await changed(page, () => drag("level", 600));
  assert.ok(pixels > 200, `${pixels} pixels changed`);
  const level = Number(await page.textContent("#level-text"));
  const { low, high } = await radii();
  assert.ok(Math.abs(low - 0.6 - level) < 0.02 && Math.abs(high - 0.6 - level) < 0.02);
});

test("slice, axis, cut and surface change the picture", async () => {
  assert.ok((await changed(page, () => drag("slice", 300))) > 200);
  assert.equal(await page.textContent("#slice-text"), "-0.4");
  assert.ok((await changed(page, () => page.selectOption("#axis", "x"))) > 200);
  assert.ok((await changed(page, () => page.click("#cut"))) > 200);
  assert.ok((await changed(page, () => page.click("#shell"))) > 200);
  assert.ok((await changed(page, () => page.click("#isolines"))) > 200);
  await page.click("#isolines");
  await page.click("#shell");
  await page.click("#cut");
});

test("the read-out gives the distance on the slice", async () => {
  await page.selectOption("#axis", "z");
  await drag("slice", 500);
  const value = await page.evaluate(() => {
    const box = document.getElementById("view").getBoundingClientRect();
    return littoral.pick(box.width / 2 - 40, box.height / 2)?.value ?? null;
  });
  assert.ok(value !== null && value >= -0.61 && value < 1.2, `${value}`);
});

test("the slice can be tilted, and dragged by its handles", async () => {
  await page.selectOption("#axis", "tilted");
  const state = () => page.evaluate(() => ({ normal: littoral.volume.normal, offset: littoral.volume.offset }));
  const error = () => page.evaluate(() => {
    // The slice holds the field: its values are the distances of its points.
    const g = littoral.volume.slice.geometry, p = g.getAttribute("position").array, t = g.getAttribute("t").array;
    const { low, high } = littoral.view.scene.fields[0];
    let worst = 0;
    for (let i = 0; i < t.length; ++i) {
      const q = [0, 1, 2].map((k) => p[3 * i + k] * Math.sqrt(3));
      if (q.some((x) => Math.abs(x) > 1)) continue;
      worst = Math.max(worst, Math.abs(low + t[i] * (high - low) - (Math.hypot(...q) - 0.6)));
    }
    return worst;
  });
  const before = await state();
  assert.ok(before.normal.filter((x) => Math.abs(x) > 0.1).length === 3);
  assert.ok((await error()) < 0.02, "the tilted slice shows the field");
  const pull = async (id, dx, dy) => {
    const box = await page.locator(id).boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2 + dx, box.y + box.height / 2 + dy, { steps: 3 });
    await page.mouse.up();
  };
  await pull("#slice-tilt", 40, -30);
  const tilted = await state();
  assert.ok(Math.hypot(...tilted.normal.map((x, k) => x - before.normal[k])) > 0.05, "the handle tilts");
  const [from, to] = await Promise.all(["#slice-move", "#slice-tilt"].map((id) => page.locator(id).boundingBox()));
  await pull("#slice-move", 0.5 * (to.x - from.x), 0.5 * (to.y - from.y));
  assert.ok(Math.abs((await state()).offset - tilted.offset) > 0.03, "the other moves");
  assert.ok((await error()) < 0.02);
  await page.focus("#slice-move");
  const at = (await state()).offset;
  await page.keyboard.press("ArrowLeft");
  assert.notEqual((await state()).offset, at);
  await page.waitForFunction(() => /slice=/.test(location.hash));
});

test("the clipping box cuts", async () => {
  await page.click("#box summary");
  assert.ok((await changed(page, () => drag("box-x-high", 55))) > 200);
  assert.ok((await changed(page, () => drag("box-x-high", 100))) > 200);
});

// How bright the sphere is, seen from the eye, at a height above the slice z = 0.
const brightness = (height) => page.evaluate((z) => {
  const eye = littoral.view.orbit.camera.position, r = Math.sqrt(0.36 - z * z) / Math.hypot(eye.x, eye.y);
  const at = littoral.view.project([r * eye.x, r * eye.y, z].map((x) => x / Math.sqrt(3))), bytes = littoral.pixels(), gl = littoral.view.renderer.getContext();
  return bytes[4 * (Math.floor(at.x) + gl.drawingBufferWidth * (gl.drawingBufferHeight - 1 - Math.floor(at.y)))];
}, height);
const settled = () => page.waitForFunction(() => littoral.settled());

test("occluded shading: dark in the corner between surface and slice, once both rest", async () => {
  await page.selectOption("#axis", "z");
  await drag("level", 0);
  await page.evaluate(() => { const v = littoral.volume, { low, high } = littoral.view.scene.fields[0]; v.setLevel(-low / (high - low)); });
  await drag("slice", 500);
  await page.uncheck("#isolines");
  const smooth = [await brightness(0.05), await brightness(0.55)];
  await page.selectOption("#shading", "occluded");
  await settled();
  const dark = [await brightness(0.05), await brightness(0.55)], part = dark.map((x, i) => x / smooth[i]);
  // Of the sky about a wall that stands on a plane half is seen: 0.3 + 0.7 / 2. The slice ends soon, so it is more.
  assert.ok(part[0] > 0.6 && part[0] < 0.85, `${part[0]} beside the slice`);
  assert.ok(part[1] > 0.93, `${part[1]} on top`);
  await drag("slice", 100);
  await settled();
  assert.ok(await brightness(0.05) / smooth[0] > 0.93, "the slice has gone elsewhere");
  await page.waitForFunction(() => /shading=occluded/.test(location.hash));
  await page.selectOption("#shading", "smooth");
  await page.check("#isolines");
});

test("the surface has no specks: what lies beside each other looks alike", async () => {
  await page.selectOption("#axis", "z");
  await drag("slice", 0);
  await drag("level", 500);
  const specks = await page.evaluate(() => {
    for (const id of ["isolines"]) if (document.getElementById(id).checked) document.getElementById(id).click();
    littoral.volume.slice.visible = false;
    const bytes = littoral.pixels(), gl = littoral.view.renderer.getContext(), w = gl.drawingBufferWidth, h = gl.drawingBufferHeight;
    littoral.volume.slice.visible = true;
    let count = 0;
    const at = (x, y) => bytes[4 * (x + w * y)];
    for (let y = 1; y + 1 < h; ++y) for (let x = 1; x + 1 < w; ++x) {
      const around = [at(x - 1, y), at(x + 1, y), at(x, y - 1), at(x, y + 1)];
      if (Math.max(...around) - Math.min(...around) < 6 && Math.abs(at(x, y) - around[0]) > 14) ++count;
    }
    return count;
  });
  assert.equal(specks, 0);
});

test("labels, no errors, no requests", async () => {
  assert.match(await page.getAttribute("#view", "aria-label"), /volume of .* nodes, distance from/);
  await assertAccessible(page);
  assertAlone(shown);
});
