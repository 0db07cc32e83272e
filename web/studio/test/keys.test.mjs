// Every key of the list, the buttons that no other test presses, and files that are dropped.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { openStudio, changedPixels, clickAll, closeQuietly, dropFiles, folder, ring, root, settled, state } from "./helpers.mjs";

const spot = join(root, "examples/data/spot.obj"), jersey = join(root, "examples/data/spot-jersey.txt");

const mode = (page) => page.evaluate(() => studio.tools.mode);
const camera = (page) => page.evaluate(() => [...studio.stage.camera.position, studio.stage.camera.zoom].join(" "));

test("each key does what the list says", async () => {
  const shown = await openStudio({ example: "ring" }), { page } = shown, press = (key) => page.keyboard.press(key);
  await page.focus("#view");
  for (const [key, name] of [["c", "curve"], ["f", "freehand"], ["p", "point"], ["v", "turn"], ["C", "curve"]]) {
    await press(key);
    assert.equal(await mode(page), name);
    assert.equal(await page.getAttribute(`#mode-${name}`, "aria-pressed"), "true");
  }
  await clickAll(page, await ring(page, 5, 0.3));
  await press("Enter"); // the next click would begin another
  assert.equal(await page.evaluate(() => studio.tools.open), -1);
  const drawn = async () => (await state(page)).strokes.at(-1);
  const { nodes } = await drawn();
  assert.ok(nodes >= 3);
  for (const now of [true, false, true]) {
    await press("l");
    assert.equal((await drawn()).closed, now);
  }
  const before = (await state(page)).values;
  await press("r");
  const after = (await state(page)).values;
  assert.ok(before.some((x) => x < 0) && before.every((x, i) => Math.abs(x + after[i]) < 1e-9), "the other side is positive");
  for (const now of [false, true]) {
    await press("u");
    assert.equal((await drawn()).signed, now);
  }
  for (const now of [true, false]) {
    await press("s");
    assert.equal(await page.evaluate(() => studio.tools.snap), now);
  }
  await press("Delete");
  const left = (await state(page)).strokes;
  assert.ok(left.length === 0 || left[0].nodes === nodes - 1);
  await press("Control+z");
  assert.equal((await drawn()).nodes, nodes);
  await press("Control+y");
  assert.deepEqual((await state(page)).strokes, left);
  await press("Control+z");

  for (const [key, id] of [["i", "lines"], ["w", "wires"], ["o", "marks"]]) {
    const was = await page.isChecked(`#${id}`);
    for (const now of [!was, was]) {
      assert.ok(await changedPixels(page, () => press(key)) > 20, `the picture after ${key}`);
      assert.equal(await page.isChecked(`#${id}`), now, key);
    }
  }
  await press("h");
  const first = await camera(page);
  for (const key of ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "Shift+ArrowLeft", "Shift+ArrowDown", "+", "-"]) {
    const was = await camera(page);
    await press(key);
    await settled(page);
    assert.notEqual(await camera(page), was, key);
  }
  await press("ArrowLeft");
  await page.click("#home");
  await settled(page);
  assert.equal(await camera(page), first, "the button is the key");
  await page.focus("#view");
  for (const now of [true, false]) {
    await press("?");
    assert.equal(await page.evaluate(() => document.getElementById("keys").open), now);
  }
  const [download] = await Promise.all([page.waitForEvent("download"), press("Control+s")]);
  assert.match(readFileSync(await download.path(), "utf8"), /^(un)?signed_curve/m);
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), press("Control+o")]);
  assert.equal(chooser.isMultiple(), false);
  await page.selectOption("#examples", "spot"); // whose middle is no hole
  await page.waitForFunction(() => studio.files.example === "spot");
  await page.focus("#view");
  await press("c");
  const strokes = (await state(page)).strokes.length;
  await press("Space");
  assert.equal((await state(page)).strokes.length, strokes + 1, "a node at the middle of the picture");
  await press("Escape"); // one node is no curve
  assert.equal((await state(page)).strokes.length, strokes);
  await closeQuietly(shown);
});

test("files are opened by the button and by letting them go over the picture", async () => {
  const shown = await openStudio({ example: "ring" }), { page } = shown;
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.click("#open")]);
  await chooser.setFiles(spot);
  await page.waitForFunction(() => studio.files.example === null);
  assert.match(await page.textContent("#facts"), /2,?930/);
  assert.deepEqual((await state(page)).strokes, []);
  await dropFiles(page, jersey);
  await page.waitForFunction(() => studio.history.drawing.strokes.length > 0);
  const { values, message } = await state(page);
  assert.equal(message, null);
  assert.ok(Math.min(...values) < 0 && Math.max(...values) > 0, "the curves of the file have two sides");
  writeFileSync(join(folder, "notes.docx"), "no mesh");
  await dropFiles(page, join(folder, "notes.docx"));
  await page.waitForSelector("#message:not([hidden])");
  assert.match(await page.textContent("#message"), /notes\.docx/);
  assert.equal((await state(page)).values.length, values.length, "the surface stays");

  // A surface and what is drawn on it, whichever is named first; never two surfaces.
  const point = join(folder, "dropped-point.txt"), other = join(folder, "other.obj");
  writeFileSync(point, "unsigned_point\nv 7\n");
  writeFileSync(other, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  await dropFiles(page, jersey, spot, point);
  await page.waitForFunction(() => studio.history.drawing.points.length === 1);
  const both = await state(page);
  assert.deepEqual([both.message, both.values.length], [null, values.length]);
  assert.ok(both.strokes.length > 0 && Math.abs(both.values[7]) < 1e-9);
  await dropFiles(page, other, spot);
  await page.waitForSelector("#message:not([hidden])");
  assert.match(await page.textContent("#message"), /One surface at a time: other\.obj, spot\.obj/);
  await closeQuietly(shown);
});

test("what can be saved stands within its menu, which Escape and a click beside it close", async () => {
  for (const width of [800, 390, 320]) {
    const shown = await openStudio({ viewport: { width, height: 640 } }), { page } = shown;
    const open = () => page.evaluate(() => document.getElementById("save-menu").open);
    await page.click("#save-menu > summary");
    const out = await page.evaluate(() => {
      const menu = document.querySelector(".drop").getBoundingClientRect();
      const boxes = [...document.querySelectorAll(".drop button, .drop select, .drop input")].map((e) => e.getBoundingClientRect());
      return boxes.filter((b) => b.left < menu.left || b.right > menu.right || b.left < 0 || b.right > innerWidth).length;
    });
    assert.equal(out, 0, `${width} pixels wide`);
    await page.keyboard.press("Escape");
    assert.equal(await open(), false);
    await page.click("#save-menu > summary");
    await page.mouse.click(width / 2, 500);
    assert.equal(await open(), false);
    await closeQuietly(shown);
  }
});

test("on a narrow page the options are behind a button", async () => {
  const shown = await openStudio({ viewport: { width: 420, height: 800 } }), { page } = shown;
  const inside = () => page.evaluate(() => {
    const box = document.getElementById("panel").getBoundingClientRect();
    return box.width > 100 && box.left < innerWidth - 100 && box.top < innerHeight - 100;
  });
  assert.equal(await inside(), false);
  await page.click("#panel-toggle");
  await page.waitForTimeout(400);
  assert.equal(await page.getAttribute("#panel-toggle", "aria-expanded"), "true");
  assert.equal(await inside(), true);
  await page.selectOption("#task", "regions");
  await settled(page);
  await page.click("#panel-toggle");
  await page.waitForTimeout(400);
  assert.equal(await page.getAttribute("#panel-toggle", "aria-expanded"), "false");
  assert.equal(await inside(), false);
  await closeQuietly(shown);
});
