// Scenes made here: the way to the source, kinds of shading, and clouds as discs.
import assert from "node:assert/strict";
import { test } from "node:test";
import { assertAlone, changed, frames } from "./browser.mjs";
import { base64, field, scene, show, sky, square, torus, torusNormal } from "./scenes.mjs";

const small = { viewport: { width: 760, height: 420 } };
const floats = (list) => base64(Float32Array.from(list));
const close = (a, b, by) => assert.ok(Math.abs(a - b) < by, `${a} is not ${b}`);

test("from the pin the way to the source is drawn and measured", async () => {
  const shape = square(60), source = [0.213, -0.117, 0], n = shape.positions.length / 3;
  const far = Array.from({ length: n }, (_, v) => 3 * Math.hypot(shape.positions[3 * v] - source[0], shape.positions[3 * v + 1] - source[1]));
  const made = scene(shape, [field("distance", far), field("other", far)], { frame: { centre: [0, 0, 0], radius: 3, towardsEye: [0, 0, 1], up: [0, 1, 0] } });
  made.sources.points = floats(source);
  const shown = await show(made, small), { page } = shown;
  try {
    const at = await page.evaluate(() => littoral.view.project([-0.71, 0.63, 0])), stage = await page.locator("#stage").boundingBox();
    assert.ok(await changed(page, () => page.mouse.click(stage.x + at.x, stage.y + at.y)) > 300, "the line and the pin's place");
    const { way, value, spot } = await page.evaluate(() => ({ way: littoral.way(), ...littoral.readout.pinnedNow }));
    assert.ok(way.reached);
    close(3 * way.length, value, 0.01 * value);
    way.places.slice(-3).forEach((c, k) => close(c, source[k], 1e-6));
    way.places.slice(0, 3).forEach((c, k) => close(c, spot[k], 1e-5));
    const text = await page.textContent("#pin-text"), [, length] = text.match(/\nway ([\d.]+)\n/);
    close(Number(length), value, 0.01 * value);
    // All along the line there is white, on a picture that has none.
    const white = (away) => page.evaluate(([p, by]) => {
      const bytes = littoral.pixels(), gl = littoral.view.renderer.getContext(), w = gl.drawingBufferWidth, h = gl.drawingBufferHeight;
      let all = 0, seen = 0;
      for (let i = 0; i < p.length; i += 3) {
        const at = littoral.view.project([p[i] + by, p[i + 1] + by, p[i + 2]]), j = 4 * (Math.floor(at.x) + w * (h - 1 - Math.floor(at.y)));
        ++all;
        if (Math.min(bytes[j], bytes[j + 1], bytes[j + 2]) > 215) ++seen;
      }
      return seen / all;
    }, [way.places, away]);
    assert.ok(await white(0) > 0.8 && await white(0.05) < 0.1, `${await white(0)} of it, ${await white(0.05)} beside it`);
    await page.selectOption("#field", "other");
    assert.equal(await page.evaluate(() => littoral.way()), null);
    assert.ok(await page.isHidden("#path-row"));
    await page.selectOption("#field", "distance");
    assert.ok(await page.evaluate(() => littoral.way().reached));
    await page.focus("#view");
    assert.ok(await changed(page, () => page.keyboard.press("g")) > 200, "taken away by a key");
    assert.doesNotMatch(await page.textContent("#pin-text"), /way/);
    await page.waitForFunction(() => /path=0/.test(location.hash));
    await page.keyboard.press("g");
    assert.ok(await changed(page, () => page.keyboard.press("Escape")) > 200, "and with the pin");
    assertAlone(shown);
  } finally {
    await shown.close();
  }
});

test("occluded shading darkens what sees less of the sky, on the side that sees less", async () => {
  const t = torus(72, 36), open = [], n = t.positions.length / 3;
  for (let v = 0; v < n; ++v) {
    const place = t.positions.slice(3 * v, 3 * v + 3);
    open.push(...sky(torusNormal(place), Math.hypot(place[0], place[2]) < 0.68 ? 0.2 : 1));  // the hole is dark
  }
  const made = scene(t, [], { frame: { centre: [0, 0, 0], radius: 1, towardsEye: [0, 1, 0], up: [0, 0, -1] } });
  made.surface.openness = base64(Uint8Array.from(open));
  const shown = await show(made, small), { page } = shown;
  const light = () => page.evaluate(() => [0.5, 0.9].map((r) => {
    const at = littoral.view.project([r, Math.sqrt(0.09 - (r - 0.68) ** 2), 0]), bytes = littoral.pixels(), gl = littoral.view.renderer.getContext();
    return bytes[4 * (Math.floor(at.x) + gl.drawingBufferWidth * (gl.drawingBufferHeight - 1 - Math.floor(at.y))) + 1];
  }));
  try {
    const [inner, outer] = await light();
    await page.selectOption("#shading", "occluded");
    const [dark, bright] = await light();
    assert.ok(Math.abs(bright - outer) <= 4, `${bright} for ${outer}: nothing hides it`);
    close(dark / inner, 0.3 + 0.7 * 0.2, 0.03);
    await page.waitForFunction(() => /shading=occluded/.test(location.hash));
    await page.focus("#view");
    assert.ok(await changed(page, () => page.keyboard.press("f")) > 1000, "a key goes on");
    assert.equal(await page.inputValue("#shading"), "smooth");
    assertAlone(shown);
  } finally {
    await shown.close();
  }
});

test("a scene says how it is shaded; without its occlusion there is no such choice", async () => {
  const shown = await show(scene(square(4), [], { shading: "flat" }), small);
  try {
    assert.equal(await shown.page.inputValue("#shading"), "flat");
    assert.deepEqual(await shown.page.locator("#shading option").allTextContents(), ["smooth", "flat"]);
  } finally {
    await shown.close();
  }
});

test("clouds are discs, of the field's colours and lines, that can be pointed at", async () => {
  const shape = square(8), n = shape.positions.length / 3, discs = [];
  for (let v = 0; v < n; ++v) discs.push(0, 0, 1, v === 40 ? 0.24 : 0.1);  // a large one in the middle
  const made = scene(shape, [field("distance", Array.from({ length: n }, (_, v) => shape.positions[3 * v] + 1), { spacing: 0.25 })]);
  Object.assign(made.surface, { discs: floats(discs), nodes: "vertices" });
  const shown = await show(made, small), { page } = shown;
  const look = (x, y) => page.evaluate(([a, b]) => {
    const at = littoral.view.project([a, b, 0]), bytes = littoral.pixels(), gl = littoral.view.renderer.getContext();
    const i = 4 * (Math.floor(at.x) + gl.drawingBufferWidth * (gl.drawingBufferHeight - 1 - Math.floor(at.y)));
    return { colour: Array.from(bytes.slice(i, i + 3)), picked: littoral.pick(at.x, at.y) };
  }, [x, y]);
  try {
    const paper = (await look(0.125, 0.875)).colour;  // between discs
    assert.equal((await look(0.125, 0.875)).picked, null);
    assert.ok(Math.min(...paper) > 240);
    for (const [x, y] of [[0.05, 0.78], [0.16, 0.16], [-0.2, 0.1]]) {  // in the large one, up to its rim
      const { colour, picked } = await look(x, y);
      assert.notDeepEqual(colour, paper);
      assert.ok(picked.node?.startsWith("v "));
    }
    assert.deepEqual([(await look(0.16, 0.16)).picked.node, (await look(0.16, 0.16)).picked.value], ["v 40", 1]);
    // The field goes on across the disc: x = 0.2 and -0.2 have the colours of those values.
    const [low, high] = [(await look(-0.2, 0.05)).colour, (await look(0.2, 0.05)).colour];
    assert.ok(Math.hypot(...low.map((c, k) => c - high[k])) > 40, `${low} and ${high}`);
    assert.ok(await changed(page, () => page.click("#discs")) > 5000);
    assert.notDeepEqual((await look(0.125, 0.875)).colour, paper);
    await frames(page);
    close((await look(0.16, 0.16)).picked.value, 1.16, 1e-3);
    assertAlone(shown);
  } finally {
    await shown.close();
  }
});

test("headings without anything below them are left out", async () => {
  for (const facts of [[], [["method", "auto"]]]) {
    const shown = await show({ ...scene(square(4), []), facts }, small), { page } = shown;
    try {
      assert.equal(await page.isVisible("#facts-box"), facts.length > 0);
      assert.equal(await page.isVisible("#options-box"), false);
      assertAlone(shown);
    } finally {
      await shown.close();
    }
  }
});
