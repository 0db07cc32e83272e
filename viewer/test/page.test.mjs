// PAGE=page.html npm test: a page made by the library (littoral_tests writes a suitable one to
// LITTORAL_PAGE_OUT) in a real browser. Its field is the x coordinate, with facts "vertex" (a number)
// and "value" (the field there); its title tries to smuggle in a script.
import assert from "node:assert/strict";
import { after, test } from "node:test";
import { readFileSync } from "node:fs";
import { assertAccessible, assertAlone, changed as changedPixels, chromiumOnly, firefox, frames, openPage, openResult } from "./browser.mjs";

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
  const picked = await page.evaluate(({ x, y }) => littoral.pick(x, y).value, at);
  assert.ok(Math.abs(picked - value) < 2e-4, `${picked} is not ${value}`);
  const view = await page.locator("#view").boundingBox();
  at.x += view.x;
  at.y += view.y;
  await page.mouse.move(at.x, at.y);
  await page.waitForSelector("#readout:not([hidden])");
  const text = await page.textContent("#readout");
  assert.ok(Math.abs(Number(text.split(" ").at(-1)) - value) < 0.01, text);
  await page.mouse.move(2, 320);
  await page.waitForSelector("#readout", { state: "hidden" });
});

test("a click pins the place and copies it as a line of a source file", chromiumOnly, async () => {
  const vertex = Number(await fact("vertex")), at = await page.evaluate((v) => littoral.project(v), vertex);
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await page.click("#view", { position: { x: at.x, y: at.y } });
  await page.waitForSelector("#pin:not([hidden])");
  await page.waitForFunction(() => /copied/.test(document.getElementById("pin-text").textContent));
  assert.equal(await page.evaluate(() => navigator.clipboard.readText()), `v ${vertex}`);
  assert.match(await page.textContent("#pin-text"), new RegExp(`^x .*\\nv ${vertex}`, "s"));
  await page.focus("#view");
  await page.keyboard.press("Escape");
  assert.ok(await page.isHidden("#pin"));
});

const pictured = JSON.parse(readFileSync(`${process.env.PAGE}.json`, "utf8"));

async function assertPictured(page, kind) {
  const seen = pictured[kind];
  await page.click("#sources");
  const drawn = await page.evaluate((places) => {
    const gl = littoral.view.renderer.getContext(), bytes = littoral.pixels(), width = gl.drawingBufferWidth, { centre, radius } = littoral.view.scene;
    return places.map((p) => {
      const place = littoral.view.project(p.map((c, k) => (c - centre[k]) / radius)), at = 4 * (Math.floor(place.x) + width * (gl.drawingBufferHeight - 1 - Math.floor(place.y)));
      return Array.from(bytes.slice(at, at + 3));
    });
  }, seen.map((one) => one.slice(0, 3)));
  await page.click("#sources");
  const apart = seen.map((one) => one.slice(3)).map((rgb, i) => Math.max(...rgb.map((c, k) => Math.abs(c - drawn[i][k])))).sort((a, b) => a - b);
  console.log(`${kind}, ${apart.length} places: colours apart by ${apart[apart.length >> 1]} in the middle, ${apart[Math.floor(0.7 * apart.length)]} for seven of ten`);
  assert.ok(apart.length > 60 && apart[apart.length >> 1] <= 2, `${apart[apart.length >> 1]}`);
  assert.ok(apart[Math.floor(0.7 * apart.length)] <= 12, "seven of ten are alike; lines fall on the others");
}

test("the page has the colours of the picture", () => assertPictured(page, "smooth"));

test("confidence is a field with its own values, in colours from 0 to 1 as in the picture", async () => {
  await page.selectOption("#field", "confidence");
  const seen = await page.evaluate((places) => places.map((p) => {
    const { centre, radius } = littoral.view.scene, { x, y } = littoral.view.project(p.map((c, k) => (c - centre[k]) / radius));
    const { value, place } = littoral.pick(x, y);
    return { value, y: place[1] };
  }), pictured.confidence.map((one) => one.slice(0, 3)));
  for (const { value, y } of seen) assert.ok(Math.abs(value - 0.3 - 0.6 * y * y) < 0.01, `${value} at ${y}`);
  assert.ok(Math.max(...seen.map(({ value }) => value)) > 0.6 && Math.min(...seen.map(({ value }) => value)) < 0.35);
  assert.match(await page.getAttribute("#legend", "aria-label"), /^Legend: confidence from 0\.3 to 0\.9/);
  assert.deepEqual(await page.evaluate(() => littoral.view.panes[0].look.uniforms.colourMap.value.toArray().map((x) => +x.toFixed(3))), [0.3, 0.6]);
  assert.equal(await page.isChecked("#isolines"), false, "no lines between what is sure and what is not");
  await assertPictured(page, "confidence");
  await page.selectOption("#field", "x");
  assert.ok(await page.isChecked("#isolines"));
});

for (const [kind, file] of [["flat", "dented"], ["occluded", "dented"], ["discs", "discs"]])
  test(`the page has the colours of the picture: ${kind}`, async () => {
    process.env.OTHER_PAGE = `${process.env.PAGE}.${file}.html`;
    const other = await openResult("OTHER_PAGE", { viewport: { width: 900, height: 640 } });
    try {
      if (kind !== "discs") await other.page.selectOption("#shading", kind);
      await assertPictured(other.page, kind);
      assertAlone(other);
    } finally {
      await other.close();
    }
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
      await page.mouse.move(550, 300);
      await page.mouse.down();
      await page.mouse.move(620, 330, { steps: 4 });
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
  await frames(page);
  const off = await page.evaluate(() => littoral.pixels().reduce((n, b, i) => n + (Math.abs(b - start[i]) > 8), 0));
  assert.ok(off < 200, `${off} bytes differ after a reset`);
});

test("nothing is drawn while nothing changes", async () => {
  await page.mouse.move(2, 320);
  await frames(page);
  const before = await page.evaluate(() => littoral.frames());
  await page.waitForTimeout(400);
  assert.equal(await page.evaluate(() => littoral.frames()), before);
});

test("the picture can be saved", chromiumOnly, async () => {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("#save")]);
  assert.match(download.suggestedFilename(), /^[\w.-]+\.png$/);
});

test("warnings stand before all else, as text", async () => {
  assert.match(await page.textContent("#warnings"), /a <b>warning<\/b>/);
  const [warning, controls] = await Promise.all(["#warnings", "#controls"].map((id) => page.locator(id).boundingBox()));
  assert.ok(warning.y < controls.y);
});

test("labels for those who cannot see", async () => {
  assert.match(await page.getAttribute("#view", "aria-label"), /triangles/);
  assert.match(await page.getAttribute("#legend", "aria-label"), /Legend: .* from .* to /);
  await page.focus("#view");
  await page.keyboard.press("v");
  assert.match(await page.textContent("#status"), /at the centre/);
  await page.evaluate(() => { for (const box of document.querySelectorAll("details")) box.open = true; });
  await assertAccessible(page);
});

test("dark scheme darkens the page", async () => {
  const assertDark = async (dark) => {
    const corner = await dark.evaluate(() => littoral.pixels().slice(0, 3));
    assert.ok(Math.max(...Object.values(corner)) < 60);
    await assertAccessible(dark);
  };
  if (firefox) {
    const dark = await openResult("PAGE", { colorScheme: "dark" });
    await assertDark(dark.page);
    return dark.close();
  }
  await page.emulateMedia({ colorScheme: "dark" });
  await frames(page, 3);
  await assertDark(page);
  await page.emulateMedia({ colorScheme: "light" });
});

test("no errors, and no request but the page itself", () => {
  assertAlone(shown);
});

test("without WebGL the page says so", chromiumOnly, async () => {
  const bare = await openPage(shown.url, { extraFlags: ["--disable-webgl", "--disable-3d-apis"] });
  try {
    assert.match(await bare.page.textContent("#message"), /WebGL/);
    assert.ok(await bare.page.isVisible("#message"));
  } finally {
    await bare.close();
  }
});
