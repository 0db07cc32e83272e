// PAGE=page.html npm test: a page made by the library (littoral_tests writes a suitable one to
// LITTORAL_PAGE_OUT) in a real browser. Its field is the x coordinate, with facts "vertex" (a number)
// and "value" (the field there); its title tries to smuggle in a script.
import assert from "node:assert/strict";
import { after, test } from "node:test";
import { assertAlone, changed as changedPixels, openPage, openResult } from "./browser.mjs";

const shown = await openResult("PAGE");
const { page } = shown;
after(() => shown.close());

const changed = (act) => changedPixels(page, act);
const fact = (name) =>
  page.evaluate((key) => [...document.querySelectorAll("#facts tr")].find((r) => r.cells[0].textContent === key)?.cells[1].textContent, name);

test("the surface is drawn in many colours", async () => {
  const colours = await page.evaluate(() => {
    const bytes = littoral.pixels(), seen = new Set();
    for (let i = 0; i < bytes.length; i += 4) seen.add((bytes[i] << 16) | (bytes[i + 1] << 8) | bytes[i + 2]);
    return seen.size;
  });
  assert.ok(colours > 100, `${colours} colours`);
});

test("title and facts are plain text", async () => {
  assert.match(await page.textContent("#title"), /<script>/);
  assert.match(await page.title(), /<script>/);
  assert.equal(await page.evaluate(() => window.smuggled), undefined);
  assert.equal(await page.locator("#facts script, #title script, #facts img").count(), 0);
});

test("the read-out gives the value under the cursor", async () => {
  const vertex = Number(await fact("vertex")), value = Number(await fact("value"));
  const at = await page.evaluate((v) => littoral.project(v), vertex);
  const picked = await page.evaluate(({ x, y }) => littoral.pick(x, y), at);
  assert.ok(Math.abs(picked - value) < 2e-3, `${picked} is not ${value}`);
  await page.mouse.move(at.x, at.y);
  await page.waitForSelector("#readout:not([hidden])");
  const text = await page.textContent("#readout");
  assert.ok(Math.abs(Number(text.split(" ").at(-1)) - value) < 0.01, text);
  await page.mouse.move(2, 320);
  await page.waitForSelector("#readout", { state: "hidden" });
});

test("toggles and slider change the picture and back", async () => {
  for (const id of ["isolines", "sources", "wireframe"]) {
    const count = await changed(() => page.click(`#${id}`));
    assert.ok(count > 20, `${id} changed ${count} pixels`);
    assert.equal(await changed(async () => { await page.click(`#${id}`); await page.click(`#${id}`); }), 0);
    await page.click(`#${id}`);
  }
  const before = await page.textContent("#spacing-text");
  const count = await changed(async () => { await page.focus("#spacing"); await page.keyboard.press("ArrowRight"); });
  assert.ok(count > 20, `the slider changed ${count} pixels`);
  assert.notEqual(await page.textContent("#spacing-text"), before);
  await page.keyboard.press("ArrowLeft");
});

test("mouse, wheel and keys move the view; reset brings it back", async () => {
  await page.evaluate(() => { window.start = littoral.pixels(); });
  const moves = {
    drag: async () => {
      await page.mouse.move(450, 300);
      await page.mouse.down();
      await page.mouse.move(520, 330, { steps: 4 });
      await page.mouse.up();
    },
    wheel: () => page.mouse.wheel(0, -200),
    arrow: async () => { await page.focus("#view"); await page.keyboard.press("ArrowLeft"); },
    "shift arrow": () => page.keyboard.press("Shift+ArrowUp"),
    minus: () => page.keyboard.press("-"),
  };
  for (const [name, move] of Object.entries(moves)) {
    assert.ok((await changed(move)) > 500, `${name} moves the view`);
  }
  await page.click("#reset");
  await page.waitForTimeout(200);
  const off = await page.evaluate(() => littoral.pixels().reduce((n, b, i) => n + (Math.abs(b - start[i]) > 8), 0));
  assert.ok(off < 200, `${off} bytes differ after a reset`);
});

test("nothing is drawn while nothing changes", async () => {
  await page.mouse.move(2, 320);
  await page.waitForTimeout(300);
  const before = await page.evaluate(() => littoral.frames());
  await page.waitForTimeout(400);
  assert.equal(await page.evaluate(() => littoral.frames()), before);
});

test("the picture can be saved", async () => {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("#save")]);
  assert.match(download.suggestedFilename(), /^[\w.-]+\.png$/);
});

test("labels for those who cannot see", async () => {
  assert.match(await page.getAttribute("#view", "aria-label"), /triangles/);
  assert.match(await page.getAttribute("#legend", "aria-label"), /Legend: .* from .* to /);
  await page.focus("#view");
  await page.keyboard.press("v");
  assert.match(await page.textContent("#status"), /at the centre/);
});

test("dark scheme darkens the page", async () => {
  await page.emulateMedia({ colorScheme: "dark" });
  await page.waitForTimeout(200);
  const corner = await page.evaluate(() => littoral.pixels().slice(0, 3));
  assert.ok(Math.max(...Object.values(corner)) < 60);
  await page.emulateMedia({ colorScheme: "light" });
});

test("no errors, and no request but the page itself", () => {
  assertAlone(shown);
});

test("without WebGL the page says so", async () => {
  const bare = await openPage(shown.url, { extraFlags: ["--disable-webgl", "--disable-3d-apis"] });
  try {
    assert.match(await bare.page.textContent("#message"), /WebGL/);
    assert.ok(await bare.page.isVisible("#message"));
  } finally {
    await bare.close();
  }
});
