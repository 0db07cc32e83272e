// Scenes made here: every kind of field, two results side by side, the controls, what is saved, and what goes wrong.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, test } from "node:test";
import { assertAlone, changed, chromiumOnly, firefox, frames } from "./browser.mjs";
import { base64, field, scene, show, square, torus } from "./scenes.mjs";

const flat = square(4), corners = (f) => Array.from({ length: flat.triangles.length }, (_, c) => f(Math.floor(c / 3), c % 3, flat.triangles[c]));
const x = (v) => flat.positions[3 * v], small = { viewport: { width: 760, height: 420 } };
const kinds = [
  field("distance", Array.from({ length: 25 }, (_, v) => x(v) + 1)),
  field("by face", Array.from({ length: 32 }, (_, t) => t / 31), { at: "face", spacing: 0 }),
  field("by corner", corners((t, k, v) => x(v) + (t % 2 ? 3 : 0)), { at: "corner" }),
  field("quadratic", Array.from({ length: 32 }, (_, t) => {
    const at = [0, 1, 2].map((k) => x(flat.triangles[3 * t + k]));
    return [...at.map((a) => a * a), ...[0, 1, 2].map((k) => ((at[(k + 1) % 3] + at[(k + 2) % 3]) / 2) ** 2)];
  }).flat(), { at: "p2" }),
  field("region", Array.from({ length: 32 }, (_, t) => (t < 16 ? -1 : 2)), { at: "face", discrete: true, spacing: 0, labels: [["2", "the upper half"]] }),
  field("cut off", Array.from({ length: 25 }, (_, v) => (x(v) > 0.3 ? Infinity : x(v)))),
];
const shown = await show(scene(flat, kinds, { warnings: ["first of all"], options: [["one", "1"]] }), small);
const { page } = shown;
after(() => shown.close());

const choose = (name) => page.selectOption("#field", name);
const value = (px, py) => page.evaluate(([a, b]) => {
  const at = littoral.view.project([a, b, 0]);
  return littoral.pick(at.x, at.y)?.value;
}, [px, py]);
const colour = (px, py) => page.evaluate(([a, b]) => {
  const at = littoral.view.project([a, b, 0]), gl = littoral.view.renderer.getContext(), bytes = littoral.pixels();
  const i = 4 * (Math.floor(at.x) + gl.drawingBufferWidth * (gl.drawingBufferHeight - 1 - Math.floor(at.y)));
  return Array.from(bytes.slice(i, i + 3));
}, [px, py]);
const close = (a, b, by = 1e-3) => assert.ok(Math.abs(a - b) < by, `${a} is not ${b}`);

test("fields at vertices, faces, corners and of degree two are read and drawn exactly", async () => {
  close(await value(0.3, 0.1), 1.3);
  await choose("by face");
  close(await value(-0.7, -0.9), 0);
  assert.notDeepEqual(await colour(-0.7, -0.9), await colour(-0.9, -0.7));
  await choose("by corner");
  close(await value(0.3, 0.4) - 0.3, 3);  // of the upper triangles
  close(await value(0.3, 0.1) - 0.3, 0);
  assert.ok(await page.isChecked("#isolines"), "lines are back after a field without");
  await choose("quadratic");
  close(await value(0.3, 0.1), 0.09);
  close(await value(0.25, 0.1), 0.0625);  // in the middle of a side a linear field would have 0.125
  await page.uncheck("#isolines");
  const [middle, same] = [await colour(0.25, 0.13), await colour(-0.25, 0.37)];
  middle.forEach((c, k) => close(c, same[k], 4));
  await page.check("#isolines");
});

test("the gradient of a distance is one more field", async () => {
  await choose("|∇ distance| − 1");
  close(await value(0.3, 0.1), 0);
});

test("regions have colours and a legend of their own", async () => {
  await choose("region");
  assert.equal(await value(0, 0.5), 2);
  assert.match(await page.getAttribute("#legend", "aria-label"), /region: -1 {2}· {2}50 %; the upper half {2}· {2}50 %/);
  assert.ok(await page.isHidden("#isolines-row"));
  assert.notDeepEqual(await colour(0, 0.5), await colour(0, -0.5));
});

test("unreachable parts are hatched and named", async () => {
  await choose("cut off");
  assert.equal(await value(0.9, 0), Infinity);
  assert.match(await page.getAttribute("#legend", "aria-label"), /hatched where unreachable/);
  const seen = new Set();
  for (let i = 0; i < 10; ++i) seen.add(String(await colour(0.8, -0.5 + 0.07 * i)));
  assert.ok(seen.size >= 2, "stripes");
  await choose("distance");
});

test("colour map, lines, numbers and range change the picture; the address remembers", async () => {
  const recoloured = await changed(page, () => page.selectOption("#map", "viridis"));
  assert.ok(recoloured > 5000, `${recoloured} pixels`);
  await page.check("#labels");
  await page.waitForFunction(() => littoral.written() > 3);
  assert.ok((await changed(page, () => page.fill("#range-high", "1.2").then(() => page.press("#range-high", "Enter")))) > 5000);
  await page.waitForFunction(() => /map=viridis/.test(location.hash) && /range=0,1.2/.test(location.hash) && /labels=1/.test(location.hash));
  const pale = await colour(0.8, 0.07), kept = await colour(-0.8, 0.07);
  assert.ok(Math.max(...pale) - Math.min(...pale) < 40 && Math.max(...kept) - Math.min(...kept) > 40);
  const box = await page.locator("#legend").boundingBox();
  // Firefox takes two clicks of a tool for one each.
  const twice = () => (firefox ? page.dispatchEvent("#legend", "dblclick") : page.mouse.dblclick(box.x + 50, box.y + box.height / 2));
  await twice();
  assert.equal(await page.inputValue("#range-high"), "2");
  await page.mouse.move(box.x + 55, box.y + box.height - 15);
  await page.mouse.down();
  await page.mouse.move(box.x + 55, box.y + box.height / 2, { steps: 3 });
  await page.mouse.up();
  const low = Number(await page.inputValue("#range-low"));
  assert.ok(low > 0.7 && low < 1.3, `the lower end was dragged to ${low}`);
  await twice();
});

test("an address opens the page as it was", async () => {
  const again = await show(scene(flat, kinds), { ...small, hash: "#field=quadratic&map=cividis&theme=dark&shading=flat&camera=0,0.5,3,0,0,0&isolines=0&range=0.2,0.7" });
  try {
    const state = await again.page.evaluate(() => ({
      field: document.getElementById("field").value, map: document.getElementById("map").value, shading: document.getElementById("shading").value,
      lines: document.getElementById("isolines").checked, theme: document.documentElement.dataset.theme, camera: littoral.view.orbit.toText(),
      range: document.getElementById("range-low").value,
    }));
    await frames(again.page, 4);
    assert.equal(await again.page.evaluate(() => littoral.frames()), 1, "one frame opens it");
    assert.deepEqual(state, { field: "quadratic", map: "cividis", shading: "flat", lines: false, theme: "dark", camera: "0,0.5,3,0,0,0", range: "0.2" });
    assertAlone({ ...again, url: again.url });
  } finally {
    await again.close();
  }
});

test("the theme can be chosen", async () => {
  const corner = () => page.evaluate(() => Math.max(...littoral.pixels().slice(0, 3)));
  await page.selectOption("#theme", "dark");
  assert.ok((await corner()) < 60);
  await page.selectOption("#theme", "light");
  assert.ok((await corner()) > 200);
});

const saved = async (act) => {
  const [download] = await Promise.all([page.waitForEvent("download"), act()]);
  return readFileSync(await download.path());
};

test("pictures of any size, isolines as SVG and the surface as OBJ can be saved", chromiumOnly, async () => {
  await page.click("#more summary");
  await page.fill("#save-width", "333");
  await page.fill("#save-height", "222");
  const png = await saved(() => page.click("#save"));
  assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [333, 222]);
  const svg = String(await saved(() => page.click("#save-svg")));
  assert.match(svg, /^<svg /);
  assert.ok((svg.match(/<path /g) ?? []).length >= 8, "a path for each line in sight");
  const obj = String(await saved(() => page.click("#save-obj")));
  assert.equal((obj.match(/^v /gm) ?? []).length, 25);
  assert.equal((obj.match(/^f /gm) ?? []).length, 32);
  const u = [...obj.matchAll(/^vt (\S+)/gm)].map((m) => Number(m[1]));
  u.forEach((t, v) => close(t, x(v) + 1, 1e-5));
});

test("each key does what the help says", async () => {
  await page.focus("#view");
  for (const [key, id] of [["i", "isolines"], ["n", "labels"], ["w", "wireframe"]]) {
    const was = await page.isChecked(`#${id}`);
    for (const now of [!was, was]) {
      await page.keyboard.press(key);
      assert.equal(await page.isChecked(`#${id}`), now, key);
      assert.match(await page.textContent("#status"), now ? /shown$/ : /hidden$/);
    }
  }
  const camera = () => page.evaluate(() => littoral.view.orbit.toText()), first = await camera();
  for (const key of ["ArrowUp", "ArrowRight", "Shift+ArrowLeft", "+"]) {
    const before = await camera();
    await page.keyboard.press(key);
    assert.notEqual(await camera(), before, key);
  }
  await page.keyboard.press("r");
  assert.equal(await camera(), first);
  await page.keyboard.press("Enter");
  assert.ok(await page.isVisible("#pin"));
  await page.click("#pin-close");
  assert.ok(await page.isHidden("#pin"));
  await page.focus("#view");
  await page.keyboard.press("p");
  assert.ok(await page.isHidden("#panel"));
  await page.click("#fold");
  assert.ok(await page.isVisible("#panel"));
  await page.focus("#view");
  if (!firefox) assert.equal((await saved(() => page.keyboard.press("s"))).toString("latin1", 1, 4), "PNG");
});

test("a finger turns the view, a tap pins what is there", chromiumOnly, async () => {
  const touch = await show(scene(flat, kinds.slice(0, 1)), { ...small, hasTouch: true, hash: "#panel=0" });
  try {
    const camera = () => touch.page.evaluate(() => littoral.view.orbit.toText()), first = await camera();
    const session = await touch.page.context().newCDPSession(touch.page), stage = await touch.page.locator("#stage").boundingBox();
    const at = (x) => [{ x: stage.x + x, y: stage.y + 200 }], send = (type, touchPoints) => session.send("Input.dispatchTouchEvent", { type, touchPoints });
    await send("touchStart", at(150));
    for (const x of [170, 190, 210]) await send("touchMove", at(x));
    await send("touchEnd", []);
    assert.notEqual(await camera(), first);
    assert.ok(await touch.page.isHidden("#pin"));
    const middle = await touch.page.evaluate(() => littoral.view.project([0, 0, 0]));
    await touch.page.touchscreen.tap(stage.x + middle.x, stage.y + middle.y);
    await touch.page.waitForSelector("#pin:not([hidden])");
    assert.match(await touch.page.textContent("#pin-text"), /^distance 1\b/);
    assertAlone(touch);
  } finally {
    await touch.close();
  }
});

test("a lost graphics context gives a message, and the picture comes back", async () => {
  await page.evaluate(() => {
    window.loser = littoral.view.renderer.getContext().getExtension("WEBGL_lose_context");
    loser.loseContext();
  });
  await page.waitForSelector("#message:not([hidden])");
  assert.match(await page.textContent("#message"), /graphics context/);
  await page.evaluate(() => loser.restoreContext());
  await page.waitForSelector("#message", { state: "hidden" });
  await frames(page);
  const seen = await colour(-0.5, 0.07);
  assert.ok(Math.max(...seen) - Math.min(...seen) > 20, "the surface is back");
});

test("warnings come first, options are folded away, all in order", async () => {
  assert.equal(await page.textContent("#warnings li"), "first of all");
  assert.equal(await page.locator("#options-box[open]").count(), 0);
  assertAlone(shown);
});

test("from 360 to 2560 pixels panels and model stand side by side", async () => {
  for (const [width, height] of [[360, 640], [420, 800], [1400, 900], [2560, 1440]]) {
    await page.setViewportSize({ width, height });
    await frames(page, 3);
    const boxes = await Promise.all(["#stage", "#panel"].map((id) => page.locator(id).boundingBox()));
    const [stage, panel] = boxes, apart = stage.x >= panel.x + panel.width - 1 || panel.y >= stage.y + stage.height - 1;
    assert.ok(apart, `${width} x ${height}`);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width);
    const legend = await page.locator("#legend").boundingBox();
    const ends = await page.evaluate(() => [[-1, -1, 0], [1, 1, 0]].map((p) => littoral.view.project(p)));
    const [a, b] = ends.map((p) => ({ x: p.x + stage.x, y: p.y + stage.y }));
    const clear = b.x <= legend.x + 2 || a.y <= legend.y + 2;
    assert.ok(clear && a.x >= stage.x && b.y >= stage.y, `${width} x ${height}: the legend is beside the model`);
  }
});

test("two results share a camera; on one surface their difference is a field", async () => {
  const t = torus(60, 30), values = Array.from({ length: t.positions.length / 3 }, (_, v) => t.positions[3 * v] + 1);
  const other = scene(t, [field("distance", values.map((d) => 1.1 * d))], { title: "second" });
  const both = await show(scene(t, [field("distance", values)], { title: "first", beside: other }), small);
  try {
    assert.deepEqual(await both.page.locator("#names span").allTextContents(), ["first", "second"]);
    const read = () => both.page.evaluate(() => {
      const { clientWidth, clientHeight } = document.getElementById("stage"), at = littoral.view.project([0.68, 0.3, 0]);
      return [0, clientWidth / 2].map((shift) => littoral.pick(at.x + shift, Math.min(clientHeight - 1, at.y + 3)));
    });
    const [a, b] = await read();
    assert.deepEqual([a.pane, b.pane], [0, 1]);
    close(b.value / a.value, 1.1, 0.002);
    await both.page.selectOption("#field", "difference");
    const [d] = await read();
    close(d.value, a.value - b.value, 0.002);
    assert.match(await both.page.getAttribute("#legend", "aria-label"), /^Legend: first − second from/);
    const kept = await both.page.evaluate(() => littoral.view.panes[1].look.uniforms.colourMap.value.toArray());
    assert.deepEqual(kept, [0, 1], "the other keeps its own colours");
    assert.ok((await changed(both.page, async () => { await both.page.focus("#view"); await both.page.keyboard.press("ArrowLeft"); })) > 2000);
    assertAlone(both);
  } finally {
    await both.close();
  }
});

test("large volumes get their surface, at every node, from a worker", async () => {
  const n = 80, values = new Uint16Array(n ** 3), step = 2 / (n - 1), far = Math.sqrt(3);
  for (let v = 0; v < values.length; ++v)
    values[v] = Math.round((65534 * Math.hypot(v % n * step - 1, (Math.floor(v / n) % n) * step - 1, Math.floor(v / n / n) * step - 1)) / far);
  const box = { positions: [-1, -1, -1, 1, -1, -1, 1, 1, 1, -1, 1, 1], triangles: [0, 1, 2, 0, 2, 3] };
  const distance = { ...field("distance", [0, far]), spacing: 0.2, values: undefined };
  const large = await show(scene(box, [distance], {
    volume: { n: [n, n, n], origin: [-1, -1, -1], spacing: [step, step, step], low: [-1, -1, -1], high: [1, 1, 1], values: base64(values), axis: 2, position: 0.5, level: 0.3, isosurface: true },
  }), small);
  try {
    const radii = async () => {
      await large.page.waitForFunction(() => littoral.settled() && littoral.volume.triangleCount > 0);
      return large.page.evaluate(() => {
        const p = littoral.volume.positions, r = [];
        for (let i = 0; i < p.length; i += 3) r.push(Math.hypot(p[i], p[i + 1], p[i + 2]));
        return [r.reduce((a, b) => Math.min(a, b)), r.reduce((a, b) => Math.max(a, b)), littoral.volume.triangleCount];
      });
    };
    const [low, high, triangles] = await radii();
    close(low, 0.3 * far, 2e-3);
    close(high, 0.3 * far, 2e-3);
    assert.ok(triangles > 20000, `${triangles} triangles`);
    const working = await large.page.evaluate(() => {
      const { worker } = littoral.volume.marcher, { onmessage } = worker, held = [];
      worker.onmessage = (message) => held.push(message);  // the surface is in the making until it is let through
      window.letThrough = () => {
        worker.onmessage = onmessage;
        for (const message of held) onmessage.call(worker, message);
      };
      const slider = document.getElementById("level");
      for (const value of [310, 350, 400]) {
        slider.value = String(value);
        slider.dispatchEvent(new Event("input"));
      }
      return littoral.volume.working;
    });
    assert.ok(working, "made beside the page");
    await large.page.waitForSelector("#hint:not([hidden])");
    await large.page.evaluate(() => letThrough());
    close((await radii())[0], 0.4 * far, 2e-3);
    assert.ok(await large.page.isHidden("#hint"));
    assertAlone(large);
  } finally {
    await large.close();
  }
});

test("damaged and foreign scenes give a message", async () => {
  const bad = { ...scene(flat, kinds), version: 7 }, empty = scene({ positions: [], triangles: [] }, []);
  for (const [what, pattern] of [[bad, /version 7/], ['{"format": ', /damaged/], [scene(flat, [{ ...kinds[0], values: base64(new Float32Array(2)) }]), /wrong length/], [empty, /no triangles/]]) {
    const broken = await show(what, { ...small, wait: false, colorScheme: what === bad ? "dark" : "light" });
    try {
      await broken.page.waitForSelector("#message:not([hidden])");
      assert.equal(await broken.page.evaluate(() => document.documentElement.dataset.theme), what === bad ? "dark" : "light");
      assert.match(await broken.page.textContent("#message"), pattern);
      assert.deepEqual(broken.errors, []);
    } finally {
      await broken.close();
    }
  }
});
