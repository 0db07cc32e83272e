// VOLUME_PAGE=page.html npm test: a page of a volume made by the library (littoral_tests writes a
// suitable one to LITTORAL_VOLUME_PAGE_OUT): the distance from a sphere of radius 0.6 in [-1, 1]^3.
import assert from "node:assert/strict";
import { after, test } from "node:test";
import { assertAlone, changed, drag as dragOn, openResult } from "./browser.mjs";

const shown = await openResult("VOLUME_PAGE");
const { page } = shown;
after(() => shown.close());

const drag = (id, value) => dragOn(page, id, value);

// Least and greatest distance of the surface's points from the origin, in the volume's unit.
const radii = () => page.evaluate(() => {
  const { shell } = littoral.volume, p = shell.geometry.getAttribute("position").array;
  let low = Infinity, high = 0;
  for (let i = 0; i < p.length; i += 3) {
    const r = Math.hypot(p[i], p[i + 1], p[i + 2]) * Math.sqrt(3);  // the page's unit is half the diagonal
    low = Math.min(low, r);
    high = Math.max(high, r);
  }
  return { low, high, triangles: littoral.volume.triangleCount() };
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
});

test("the read-out gives the distance on the slice", async () => {
  await page.selectOption("#axis", "z");
  await drag("slice", 500);
  const value = await page.evaluate(() => {
    const box = document.getElementById("view").getBoundingClientRect();
    return littoral.pick(box.width / 2, box.height / 2);
  });
  assert.ok(value !== null && value >= -0.61 && value < 1.2, `${value}`);
});

test("labels, no errors, no requests", async () => {
  assert.match(await page.getAttribute("#view", "aria-label"), /volume of .* nodes, distance from/);
  assertAlone(shown);
});
