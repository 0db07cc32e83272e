// Controls, saving, links, bad input, a lost context, touch and sizes.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { assertAccessible, whenShown } from "../../../viewer/test/browser.mjs";
import {
  assertClose, byProgram, changedPixels, clickAll, closeQuietly, confidenceByProgram, folder, openStudio, pickFile, ring, root, run,
  saved, settled, state,
} from "./helpers.mjs";

const spot = join(root, "examples/data/spot.obj"), jersey = join(root, "examples/data/spot-jersey.txt");

test("the page opens on a field; each control changes what it should", async () => {
  const shown = await openStudio(), { page } = shown;
  const { values, method, message } = await state(page);
  assert.equal(method, "auto");
  assert.equal(message, null);
  assert.ok(Math.min(...values) < 0 && Math.max(...values) > 0);
  assert.ok(await changedPixels(page, () => page.click("#lines")) > 300, "isolines");
  await page.click("#lines");
  assert.ok(await changedPixels(page, () => page.locator("#spacing").fill("0")) > 100, "their spacing");
  assert.ok(await changedPixels(page, () => page.click("#wires")) > 500, "sides of faces");
  await page.click("#wires");
  assert.ok(await changedPixels(page, () => page.click("#marks")) > 30, "curves");
  await page.click("#marks");
  assert.equal(await page.evaluate(() => document.querySelector("#shown [value=confidence]").disabled), true, "nobody asked for it");
  assert.ok(await changedPixels(page, () => page.selectOption("#shown", "slope")) > 500, "the slope");
  const middle = await page.evaluate(() => {
    const { values, low, high } = studio.stage.skin.field;
    return low + (high - low) * Array.from(values).sort((a, b) => a - b)[values.length >> 1];
  });
  assert.ok(Math.abs(middle) < 0.02, `exact distance has slope 1, not ${1 + middle}`);
  await page.evaluate(() => { document.getElementById("options-box").open = true; });
  await page.check("#option-confidence");
  await settled(page);
  assert.ok(await changedPixels(page, () => page.selectOption("#shown", "confidence")) > 500, "confidence");
  const seen = await page.evaluate(() => {
    const { values, low, high, colourLow, colourHigh } = studio.stage.skin.field;
    return { values: Array.from(values, (t) => low + (high - low) * t), ends: [colourLow, colourHigh], legend: document.getElementById("legend").ariaLabel };
  });
  assert.deepEqual(seen.ends, [0, 1]);
  assert.match(seen.legend ?? await page.getAttribute("#legend", "aria-label"), /^Legend: confidence/);
  assertClose(seen.values, confidenceByProgram(spot, jersey), 1e-6); // single precision
  assert.ok(Math.min(...seen.values) < 0.5 && Math.max(...seen.values) > 0.9, "doubtful about the gaps, sure elsewhere");
  await page.uncheck("#option-confidence");
  await settled(page);
  assert.equal(await page.evaluate(() => studio.shown), "field", "gone with what it shows");
  await page.selectOption("#shown", "field");
  await page.focus("#view");
  assert.ok(await changedPixels(page, () => page.keyboard.press("ArrowLeft")) > 500, "arrows turn");
  assert.ok(await changedPixels(page, () => page.keyboard.press("h")) > 500, "first view");
  assert.ok(await changedPixels(page, () => page.click("#theme")) > 1000, "dark");
  await page.click("#theme");

  await page.selectOption("#method", "signed-heat");
  const heat = await state(page);
  assert.equal(heat.method, "signed-heat");
  await page.fill("#option-time-scale", "30");
  await page.locator("#option-time-scale").blur();
  assert.notDeepEqual((await state(page)).values, heat.values);
  assert.equal(await page.evaluate(() => studio.answer.report.options["time-scale"] == 30), true);
  await page.fill("#option-time-scale", "-3"); // out of range: nothing happens
  await page.locator("#option-time-scale").blur();
  await settled(page);
  assert.equal(await page.evaluate(() => studio.answer.report.options["time-scale"] == 30), true);
  await closeQuietly(shown);
});

test("the cursor reads value and node, a click copies the node", async () => {
  const shown = await openStudio(), { page } = shown;
  const places = await ring(page, 24, 0.12); // one away from the curves
  const { x, y } = places[await page.evaluate((all) => all.findIndex((p) => !studio.tools.strokeNear(p.x, p.y, 14)), places)];
  await page.mouse.move(x, y);
  await page.waitForSelector("#readout:not([hidden])");
  assert.match(await page.textContent("#readout"), /^distance -?[\d.e-]+\nf \d+ [\d.]+ [\d.]+ [\d.]+$/);
  const toast = await whenShown(page, "toast");
  await page.mouse.click(x, y);
  assert.match(await toast(), /f \d+ /);
  await closeQuietly(shown);
});

test("isolines, pictures and fields are saved; nothing is kept from those who cannot see", async () => {
  const shown = await openStudio(), { page } = shown;
  const svg = await saved(page, "save-lines");
  assert.match(svg.bytes.toString(), /^<svg[^]*<path d="M[\d. ]+L[^]*<\/svg>\s*$/);
  assert.match((await saved(page, "save-lines", ".obj")).bytes.toString(), /^l \d+ \d+/m);
  const png = await saved(page, "save-picture");
  assert.equal(png.bytes.subarray(1, 4).toString(), "PNG");
  assert.ok(png.bytes.length > 20000);
  assert.match((await saved(page, "save-field", ".csv")).bytes.toString(), /^vertex,distance\n0,/);
  const npz = (await saved(page, "save-field", ".npz")).bytes;
  assert.ok(npz.subarray(0, 2).toString() === "PK" && npz.includes("distance.npy"));
  await page.evaluate(() => { document.getElementById("save-menu").open = true; });
  await page.fill("#offsets", "0.05, -0.03");
  const offsets = (await saved(page, "save-offsets", ".obj")).bytes.toString();
  assert.ok(offsets.match(/^l /gm).length >= 2, "a line at each distance");

  // Every control has a name, in both themes.
  const unnamed = await page.evaluate(() => [...document.querySelectorAll("button, select, input, summary, canvas, progress")]
    .filter((e) => !(e.ariaLabel || e.title || e.textContent.trim() || e.labels?.length)).map((e) => e.id || e.outerHTML));
  assert.deepEqual(unnamed, []);
  await page.evaluate(() => { for (const box of document.querySelectorAll("details")) box.open = true; });
  await assertAccessible(page);
  await page.click("#theme");
  await assertAccessible(page);
  await closeQuietly(shown);
});

test("a broken surface is repaired and sampled as the command line does it; both can be cancelled", async () => {
  const shown = await openStudio({ example: "spot" }), { page } = shown;
  await page.evaluate(() => { // at once, while it is repaired
    document.getElementById("save-menu").open = true;
    const bar = document.getElementById("progress");
    new MutationObserver((_, observer) => {
      if (bar.hidden) return;
      observer.disconnect();
      window.working = document.getElementById("status").textContent;
      document.getElementById("cancel").click();
    }).observe(bar, { attributes: true });
  });
  await page.click("#save-repaired");
  await page.waitForFunction(() => /Not saved: cancelled/.test(document.getElementById("toast").textContent));
  assert.match(await page.evaluate(() => working), /Repairing/);

  const broken = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 3 4\n", file = join(folder, "broken.obj"); // the last is turned round
  writeFileSync(file, broken);
  await pickFile(page, "broken.obj", broken);
  await page.waitForFunction(() => studio.engine.surface.name === "broken.obj");
  await settled(page);
  const { name, bytes } = await saved(page, "save-repaired", ".obj");
  assert.equal(name, "broken-repaired.obj");
  run("repair", file, "-o", join(folder, "repaired.obj"));
  const elements = (text) => text.match(/^[vf] .*$/gm);
  assert.deepEqual(elements(bytes.toString()), elements(readFileSync(join(folder, "repaired.obj"), "utf8")));
  await page.waitForFunction(() => /^broken-repaired\.obj saved, 4 faces/.test(document.getElementById("toast").textContent));
  const samples = (await saved(page, "save-samples", ".npz")).bytes;
  run("samples", file, "-o", join(folder, "samples.npz"));
  assert.ok(samples.equals(readFileSync(join(folder, "samples.npz"))), "the same bytes");
  await closeQuietly(shown);
});

test("polygon meshes and clouds: nodes at vertices, the numbers of the command line", async () => {
  const n = 14, quads = [], dots = [];
  for (let i = 0; i <= n; ++i) for (let j = 0; j <= n; ++j) {
    quads.push(`v ${i / n} ${j / n} ${(0.2 * Math.sin((3 * i) / n)).toFixed(6)}`);
    dots.push(`${i / n} ${j / n} ${(0.2 * Math.sin((3 * i) / n)).toFixed(6)}`);
  }
  for (let i = 0; i < n; ++i) for (let j = 0; j < n; ++j) {
    const a = i * (n + 1) + j + 1;
    quads.push(`f ${a} ${a + n + 1} ${a + n + 2} ${a + 1}`);
  }
  const shown = await openStudio(), { page } = shown;
  await page.click("#mode-point");
  for (const [name, text, kind] of [["quads.obj", quads, "polygon mesh"], ["dots.xyz", dots, "point cloud"]]) {
    await pickFile(page, name, `${text.join("\n")}\n`);
    await page.waitForFunction((file) => studio.engine.surface.name === file, name);
    await settled(page);
    assert.equal(await page.evaluate(() => studio.engine.surface.kind), kind);
    const [{ x, y }] = await ring(page, 8, 0.08);
    await page.mouse.click(x, y);
    const { values, points } = await state(page);
    assert.equal(points, 1, kind);
    writeFileSync(join(folder, name), `${text.join("\n")}\n`);
    assertClose(values, byProgram(join(folder, name), (await saved(page, "save-sources")).bytes), 1e-9);
  }
  await closeQuietly(shown);
});

test("a link carries sources, camera, method and options", async () => {
  const shown = await openStudio({ example: "spot" }), { page } = shown;
  await page.click("#mode-curve");
  await clickAll(page, (await ring(page, 4)).slice(0, 3));
  await page.selectOption("#method", "signed-heat");
  await page.keyboard.press("h");
  await page.focus("#view");
  await page.keyboard.press("ArrowUp");
  const here = await state(page), link = await page.evaluate(() => studio.files.linkText());
  const camera = await page.evaluate(() => studio.stage.cameraText);
  await closeQuietly(shown);

  const again = await openStudio({ hash: link.slice(link.indexOf("#")) });
  const there = await state(again.page);
  assert.deepEqual(there.strokes, here.strokes);
  assert.equal(there.method, "signed-heat");
  assertClose(there.values, here.values, 1e-9);
  assert.equal(await again.page.evaluate(() => studio.stage.cameraText), camera);
  await closeQuietly(again);

  const damaged = await openStudio({ hash: "#notalink" });
  assert.match((await state(damaged.page)).message, /link cannot be read/);
  await closeQuietly(damaged);
});

test("a link to a file asks for it and knows it by its content", async () => {
  const shown = await openStudio(), { page } = shown;
  const tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  await pickFile(page, "tetrahedron.obj", tetrahedron);
  await page.waitForFunction(() => studio.engine.surface.counts.faces === 4);
  let hash = 0xcbf29ce484222325n;
  for (const byte of Buffer.from(tetrahedron)) hash = BigInt.asUintN(64, (hash ^ BigInt(byte)) * 0x100000001b3n);
  assert.equal(await page.evaluate(() => studio.files.hash), hash.toString(16).padStart(16, "0"));
  await pickFile(page, "point.txt", "unsigned_point\nv 2\n");
  await page.waitForFunction(() => studio.history.drawing.points.length === 1);
  const { values } = await state(page), link = await page.evaluate(() => studio.files.linkText());
  await closeQuietly(shown);

  const again = await openStudio({ hash: link.slice(link.indexOf("#")) });
  assert.match((await state(again.page)).message, /belongs to the file tetrahedron\.obj/);
  await pickFile(again.page, "renamed.obj", tetrahedron);
  await again.page.waitForFunction(() => studio.history.drawing.points.length === 1);
  await settled(again.page);
  assertClose((await state(again.page)).values, values, 1e-12);
  await closeQuietly(again);
});

test("files that are damaged, unknown or huge get a message and leave the picture", async () => {
  const shown = await openStudio(), { page } = shown;
  const lit = () => page.evaluate(() => studio.stage.pixels().reduce((n, x, i) => n + (i % 4 === 0 && x < 200 ? 1 : 0), 0));
  const area = await lit();
  const bad = [
    ["nothing.obj", ""], ["broken.obj", "v 0 0 0\nf 1 2 3\n"], ["noise.ply", "ply\nformat ascii 1.0\nelement vertex 99999999999\n"],
    ["noise.stl", "\x00".repeat(83) + "\xff".repeat(40)], ["picture.jpeg", "\xff\xd8"],
  ];
  for (const [name, text] of bad) {
    await pickFile(page, name, Buffer.from(text, "latin1"));
    await page.waitForFunction((file) => document.getElementById("message").textContent.includes(file), name);
    assert.equal((await state(page)).message.split("\n")[0], `${name} cannot be opened.`);
    assert.ok(Math.abs(await lit() - area) < 0.02 * area, `${name} leaves the picture`);
  }
  await page.evaluate(() => {
    const file = new File(["x"], "huge.ply");
    Object.defineProperty(file, "size", { value: 4e9 });
    return studio.files.openFiles([file]);
  });
  assert.match((await state(page)).message, /huge\.ply has 4\.0 GB/);
  await pickFile(page, "tetrahedron.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  await page.waitForFunction(() => studio.engine.surface.counts.faces === 4);
  assert.equal((await state(page)).message, null);
  await pickFile(page, "wrong.txt", "signed_curve\nv 0\nv 77\n");
  await page.waitForFunction(() => document.getElementById("message").textContent.includes("wrong.txt"));
  await closeQuietly(shown);
});

test("a file that cannot be read stops no answer, and its message closes by a button or Escape", async () => {
  const shown = await openStudio(), { page } = shown, { values } = await state(page);
  await page.evaluate(() => {
    studio.engine.lastWhole = Infinity; // as if exact distance took long
    studio.changed();
  });
  await page.waitForFunction(() => studio.answer.preview);
  const close = [() => page.click("#message-close"), () => page.keyboard.press("Escape")];
  for (const act of close) {
    await pickFile(page, "nothing.obj", Buffer.from(""));
    await page.waitForSelector("#message:not([hidden])");
    const { status, warnings, values: after_ } = await state(page);
    assert.doesNotMatch(status, /preview/);
    assert.deepEqual(warnings, []);
    assertClose(after_, values, 1e-12);
    await act();
    assert.equal((await state(page)).message, null);
  }
  await closeQuietly(shown);
});

test("of a cloud the points are counted", async () => {
  const shown = await openStudio(), { page } = shown;
  const points = Array.from({ length: 64 }, (_, i) => `${i % 8} ${Math.floor(i / 8)} 0`);
  await pickFile(page, "grid.xyz", Buffer.from(points.join("\n")));
  await page.waitForFunction(() => studio.engine.surface.kind === "point cloud");
  assert.match((await state(page)).status, /^64 points\. Nothing/);
  assert.match(await page.textContent("#facts"), /Points64/);
  assert.doesNotMatch(await page.textContent("#facts"), /Faces|Components/);
  await closeQuietly(shown);
});

test("a lost graphics context: a message, then the picture again", async () => {
  const shown = await openStudio(), { page } = shown;
  const pixels = await changedPixels(page, async () => {
    await page.evaluate(() => { window.lose = studio.stage.renderer.getContext().getExtension("WEBGL_lose_context"); lose.loseContext(); });
    await page.waitForSelector("#message:not([hidden])");
    assert.match(await page.textContent("#message"), /graphics context/);
    await page.evaluate(() => lose.restoreContext());
    await page.waitForSelector("#message", { state: "hidden" });
  });
  assert.ok(pixels < 200, `${pixels} pixels differ`);
  await shown.close(); // three.js reports the loss on the console
});

test("one finger draws, two move the camera; nothing overflows from 360 to 2560 pixels", async () => {
  const shown = await openStudio({ example: "spot", viewport: { width: 360, height: 740 }, hasTouch: true }), { page } = shown;
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= 360));
  await page.click("#mode-freehand");
  const places = await ring(page, 30, 0.07), touch = await page.context().newCDPSession(page);
  const send = (type, points) => touch.send("Input.dispatchTouchEvent", { type, touchPoints: points });
  await send("touchStart", [places[0]]);
  for (const place of places.slice(1, 15)) await send("touchMove", [place]);
  await send("touchEnd", []);
  assert.equal((await state(page)).strokes.length, 1);
  assert.ok((await state(page)).strokes[0].nodes >= 4);
  const camera = () => page.evaluate(() => studio.stage.cameraText), first = await camera();
  const [a, b] = [places[0], places[15]];
  await send("touchStart", [a]);
  await send("touchStart", [a, b]);
  for (let i = 1; i < 6; ++i) await send("touchMove", [{ x: a.x + 8 * i, y: a.y }, { x: b.x - 8 * i, y: b.y }]);
  await send("touchEnd", []);
  await settled(page);
  assert.notEqual(await camera(), first);
  assert.equal((await state(page)).strokes.length, 1, "two fingers draw nothing");
  for (const [width, height] of [[420, 800], [1024, 700], [2560, 1300]]) {
    await page.setViewportSize({ width, height });
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    assert.ok(await page.evaluate(() => document.getElementById("view").clientHeight > 0.55 * innerHeight));
  }
  await closeQuietly(shown);
});
