// TRACE_PAGE=page.html npm test: a page of traced tori made by the library (littoral_tests writes a
// suitable one to LITTORAL_TRACE_PAGE_OUT, and beside it what the library's own tracer sees): 2000
// points on a torus of radii 0.8 and 0.3.
import assert from "node:assert/strict";
import { after, test } from "node:test";
import { readFileSync } from "node:fs";
import { assertAlone, changed, drag as dragOn, openResult, whenShown } from "./browser.mjs";
import { load, show } from "./scenes.mjs";

const { kth, makeTree } = await load("tori-tree.ts");

const shown = await openResult("TRACE_PAGE", { viewport: { width: 720, height: 200 } }, 60000);
const { page } = shown;
const reference = JSON.parse(readFileSync(`${process.env.TRACE_PAGE}.json`, "utf8"));
after(() => shown.close());

const settled = () => page.waitForFunction(() => window.littoral.settled(), null, { timeout: 60000 });
const drag = (id, value) => dragOn(page, id, value);

test("the k-th smallest is that", () => {
  const numbers = Float32Array.from({ length: 101 }, (_, i) => (i * 37) % 101);
  for (const k of [0, 1, 11, 50, 100]) assert.equal(kth(numbers, k), k);
  assert.equal(kth(Float32Array.from([2, 2, 1, 2]), 2), 2);
});

test("leaves list the nearest points", () => {
  const tori = new Float32Array(16 * 300);
  for (let i = 0; i < 300; ++i) {
    const a = 2.399963 * i, z = 1 - (2 * i + 1) / 300, r = Math.sqrt(1 - z * z);
    tori.set([0.6 * r * Math.cos(a), 0.6 * r * Math.sin(a), 0.6 * z, 0.1], 16 * i);
  }
  const tree = makeTree(tori, [-1, -1, -1], [1, 1, 1]);
  let checked = 0;
  for (let q = 0; q < 200; ++q) {
    const x = [0, 1, 2].map((a) => 0.62 * tori[16 * q + a] / 0.6);  // on and beside the surface
    let node = 0, h = tree.half;
    const c = [...tree.centre];
    while (tree.nodes[2 * node + 1] < 0) {
      let k = 0;
      h /= 2;
      for (let a = 0; a < 3; ++a) if (x[a] >= c[a]) { k |= 1 << a; c[a] += h; } else c[a] -= h;
      node = tree.nodes[2 * node] + k;
    }
    const listed = tree.lists.subarray(tree.nodes[2 * node], tree.nodes[2 * node] + tree.nodes[2 * node + 1]);
    const away = (i) => Math.hypot(...[0, 1, 2].map((a) => tori[16 * i + a] - x[a]));
    const nearest = Array.from({ length: 300 }, (_, i) => i).sort((a, b) => away(a) - away(b)).slice(0, 12);
    for (const i of nearest) assert.ok(listed.includes(i), `point ${i} near query ${q}`);
    ++checked;
  }
  assert.equal(checked, 200);
});

/** Rays of the page beside those of the library, of a page and what it must see. */
async function compareRays(page, { n, frame, t }, most) {
  const seen = await page.evaluate(([f, size]) => Array.from(littoral.tracer.traceRays(...f.slice(0, 4), size)), [frame, n]);
  let hits = 0, differ = 0, worst = 0, sum = 0;
  for (let i = 0; i < n * n; ++i) {
    const here = seen[4 * i];
    if ((here < 0) !== (t[i] < 0)) { ++differ; continue; }
    if (here < 0) continue;
    ++hits;
    const apart = Math.abs(here - t[i]);
    worst = Math.max(worst, apart);
    sum += apart;
    assert.ok(Math.abs(Math.hypot(seen[4 * i + 1], seen[4 * i + 2], seen[4 * i + 3]) - 1) < 1e-3);
  }
  console.log(`${hits} hits of ${n * n} rays, ${differ} silhouettes differ, depth apart ${(sum / hits).toExponential(1)} on average, ${worst.toExponential(1)} at most`);
  assert.ok(hits > 400 && hits < most, `${hits} hits`);
  assert.ok(differ <= 0.005 * n * n, `${differ} rays see another silhouette`);
  assert.ok(sum / hits < 2e-3, `mean ${sum / hits}`);
  assert.ok(worst < 0.05, `worst ${worst}`);
}

test("rays meet what the library's rays meet", () => compareRays(page, reference, 1000));

test("clouds united, rounded, fattened and bitten are what the library combines", async () => {
  const path = process.env.CLOUDS_PAGE = `${process.env.TRACE_PAGE}.clouds.html`;
  const several = await openResult("CLOUDS_PAGE", { viewport: { width: 360, height: 200 } }, 60000);
  try {
    await compareRays(several.page, JSON.parse(readFileSync(`${path}.json`, "utf8")), 2000);
    assert.match(await several.page.getAttribute("#view", "aria-label"), /6000 points/);
    assertAlone(several);
  } finally {
    await several.close();
  }
});

test("while it refines it says so, and nothing is black", async () => {
  await settled();
  assert.ok(await page.isHidden("#hint"));
  const refining = await whenShown(page, "hint", (hint) => {
    const bytes = littoral.pixels();
    let count = 0;
    for (let i = 0; i < bytes.length; i += 4) if (bytes[i] + bytes[i + 1] + bytes[i + 2] < 60) ++count;
    return { text: hint.textContent, black: count / (bytes.length / 4) };
  });
  await page.focus("#view");
  await page.keyboard.press("ArrowRight");
  const { text, black } = await refining();
  assert.match(text, /Tracing the cloud/);
  assert.ok(black < 0.01, `${black} of the picture`);
  await page.keyboard.press("r");
  await settled();
  assert.ok(await page.isHidden("#hint"));
});

test("at rest the whole picture is traced, with the hole", async () => {
  await settled();
  const counts = await page.evaluate(() => {
    const bytes = littoral.pixels(), seen = { grey: 0, all: bytes.length / 4 };
    for (let i = 0; i < bytes.length; i += 4)
      if (Math.abs(bytes[i] - bytes[i + 2]) < 30 && bytes[i] < 238 && bytes[i] > 60) ++seen.grey;
    return seen;
  });
  assert.ok(counts.grey > 0.05 * counts.all, `${counts.grey} of ${counts.all} pixels`);
});

test("offset and cut change the picture; it settles again", async () => {
  const low = await page.evaluate(() => littoral.volume.level);
  assert.ok(await changed(page, () => drag("level", Math.round(1000 * low + 60))) > 200);
  await settled();
  assert.ok(Number(await page.textContent("#level-text")) > 0.02);
  assert.ok(await changed(page, () => drag("slice", 500)) > 200);
  await settled();
  const click = () => page.evaluate(() => document.getElementById("shell").click());
  assert.ok(await changed(page, click) > 200);
  await click();
  await settled();
});

test("occluded shading: dark in the corner between surface and slice", async () => {
  await page.evaluate(() => {  // the torus itself, cut at z = 0
    const { volume, view } = littoral, { low, high } = view.scene.fields[0];
    volume.setLevel(-low / (high - low));
    volume.setSlice([0, 0, 1], -view.scene.centre[2] / view.scene.radius);
  });
  await settled();
  // How bright it is on the side of the eye, just above the slice and on top.
  const look = () => page.evaluate(() => [0.04, 0.299].map((z) => {
    const { centre, radius } = littoral.view.scene, eye = littoral.view.orbit.camera.position, r = (0.8 + Math.sqrt(0.09 - z * z)) / Math.hypot(eye.x, eye.y);
    const at = littoral.view.project([r * eye.x, r * eye.y, z].map((x, k) => (x - centre[k]) / radius)), bytes = littoral.pixels(), gl = littoral.view.renderer.getContext();
    return bytes[4 * (Math.floor(at.x) + gl.drawingBufferWidth * (gl.drawingBufferHeight - 1 - Math.floor(at.y)))];
  }));
  const smooth = await look();
  await page.selectOption("#shading", "occluded");
  await settled();
  const dark = await look(), part = dark.map((x, i) => x / smooth[i]);
  assert.ok(part[0] < 0.85 && part[0] > 0.6, `${part[0]} beside the slice`);
  assert.ok(part[1] > 0.93, `${part[1]} on top`);
  await page.selectOption("#shading", "smooth");
  await settled();
  assert.deepEqual(await look(), smooth);
});

test("turning asks for fewer pixels first, then all", async () => {
  await settled();
  const frames = await page.evaluate(() => littoral.frames());
  await page.focus("#view");
  await page.keyboard.press("ArrowLeft");
  await page.waitForFunction((f) => littoral.frames() > f, frames);
  await settled();
  const after = await page.evaluate(() => littoral.frames());
  await page.waitForTimeout(400);
  assert.equal(await page.evaluate(() => littoral.frames()), after);
});

test("two clouds are traced side by side, with one camera", async () => {
  const text = readFileSync(process.env.TRACE_PAGE, "utf8"), from = text.indexOf(">", text.indexOf('<script id="scene"')) + 1;
  const one = JSON.parse(text.slice(from, text.indexOf("</script>", from))), { format, version, ...part } = one;
  const both = await show({ ...one, beside: { ...part, title: "beside" } }, { viewport: { width: 620, height: 220 }, hash: "#panel=0" });
  try {
    await both.page.waitForFunction(() => littoral.settled(), null, { timeout: 60000 });
    const { sides, widths } = await both.page.evaluate(() => {
      const bytes = littoral.pixels(), gl = littoral.view.renderer.getContext(), w = gl.drawingBufferWidth, sides = [0, 0];
      for (let i = 0; i < bytes.length; i += 4)  // the surface's grey
        if (Math.abs(bytes[i] - bytes[i + 2]) < 30 && bytes[i] < 238 && bytes[i] > 60) ++sides[(i / 4) % w < w / 2 ? 0 : 1];
      return { sides, widths: littoral.view.panes.map((pane) => [pane.tracer.size.x, w / 2]) };
    });
    assert.ok(sides[0] > 1000 && Math.abs(sides[1] - sides[0]) < 0.03 * sides[0], `${sides}`);
    for (const [traced, half] of widths) assert.ok(Math.abs(traced - half) <= 1, "a ray for each pixel, no more");
    assertAlone(both);
  } finally {
    await both.close();
  }
});

test("labels, no errors, no requests", async () => {
  assert.match(await page.getAttribute("#view", "aria-label"), /2000 points/);
  assertAlone(shown);
});
