// Scenes made here: white is 0, numbers tell values apart, and what is hidden has no lines and no numbers.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { assertAccessible, assertAlone, chromiumOnly, drag, frames } from "./browser.mjs";
import { base64, field, scene, show, square } from "./scenes.mjs";

const flat = square(8), small = { viewport: { width: 760, height: 420 } };
const each = (f, { positions: p } = flat) => Array.from({ length: p.length / 3 }, (_, v) => f(p[3 * v], p[3 * v + 1], v));

/// All texts that are drawn on canvases, in order.
const prepare = (page) => page.addInitScript(() => {
  window.texts = [];
  const { fillText } = CanvasRenderingContext2D.prototype;
  CanvasRenderingContext2D.prototype.fillText = function (text, ...rest) {
    window.texts.push(text);
    return fillText.call(this, text, ...rest);
  };
});
/// Runs something with a page that shows a scene and complains about nothing.
async function withPage(made, options, act) {
  const shown = await show(made, { ...small, prepare, ...options });
  try {
    await act(shown.page, shown);
    assertAlone(shown);
  } finally {
    await shown.close();
  }
}
/// The texts that something has drawn.
async function drawn(page, act) {
  await page.evaluate(() => { window.texts = []; });
  await act();
  return page.evaluate(() => window.texts);
}
const written = (page) => page.waitForFunction(() => littoral.written() > 0);
const colour = (page, x, y, pane = 0) => page.evaluate(([a, b, which]) => {
  const at = littoral.view.project([a, b, 0], which), gl = littoral.view.renderer.getContext(), bytes = littoral.pixels();
  const i = 4 * (Math.floor(at.x) + gl.drawingBufferWidth * (gl.drawingBufferHeight - 1 - Math.floor(at.y)));
  return Array.from(bytes.slice(i, i + 3));
}, [x, y, pane]);
const isWhite = (rgb) => Math.max(...rgb) - Math.min(...rgb) < 25 && Math.min(...rgb) > 215;
const assertWhite = (rgb) => assert.ok(isWhite(rgb), `${rgb} is not white`);
const assertColoured = (rgb) => assert.ok(!isWhite(rgb), `${rgb} is white`);

test("of a signed and an unsigned result side by side white is 0, whichever comes first", async () => {
  const signed = field("distance", each((x) => x)), unsigned = field("distance", each((x) => 2 * (x + 1)));
  for (const [left, right] of [[signed, unsigned], [unsigned, signed]]) {
    const made = scene(flat, [left], { title: "one", beside: scene(flat, [right], { title: "other" }) });
    await withPage(made, { hash: "#isolines=0" }, async (page) => {
      assert.equal(await page.inputValue("#map"), "diverging");
      const zero = (one) => (one === signed ? 0.01 : -0.97);
      assertWhite(await colour(page, zero(left), 0.07, 0));
      assertWhite(await colour(page, zero(right), 0.07, 1));
      for (const pane of [0, 1]) assertColoured(await colour(page, 0.6, 0.07, pane));
    });
  }
});

test("of ends that are not as far from it 0 stays white, in the picture and in the legend", async () => {
  const asked = { ...field("signed", each((x) => x)), colourLow: -0.2, colourHigh: 0.6 };
  await withPage(scene(flat, [asked]), { hash: "#isolines=0" }, async (page) => {
    assertWhite(await colour(page, 0.01, 0.07));
    for (const x of [-0.15, 0.3, 0.5]) assertColoured(await colour(page, x, 0.07));
    assert.deepEqual(await colour(page, -0.3, 0.07), await colour(page, -0.9, 0.07), "beyond the end its colour");
    const bar = await page.evaluate(() => {
      const context = document.getElementById("legend").getContext("2d"), { from, length } = littoral.controls.legend.along;
      const at = (value) => Math.round(from + (length * (1 - value)) / 2);
      return [0, 0.2].map((value) => Array.from(context.getImageData(12 + 34 + 9, at(value), 1, 1).data.slice(0, 3)));
    });
    assertWhite(bar[0]);
    assertColoured(bar[1]);
  });
});

test("a map of two hues that is chosen has 0 in its middle", async () => {
  await withPage(scene(flat, [field("height", each((x) => x + 1))]), { hash: "#isolines=0&map=diverging" }, async (page) => {
    assertWhite(await colour(page, -0.98, 0.07));
    assertColoured(await colour(page, 0.01, 0.07));
  });
});

for (const middle of [100000, 1000000]) test(`values about ${middle} are told apart`, async () => {
  const values = field("distance", each((x) => middle + x), { spacing: 0.25 });
  const far = { frame: { centre: [500000, 4000000, 0], radius: 10, towardsEye: [0, 0, 1], up: [0, 1, 0] } };
  await withPage(scene(flat, [values], far), {}, async (page) => {
    const ticks = (await drawn(page, () => page.selectOption("#map", "viridis"))).filter((text) => /^\d/.test(text));
    assert.ok(ticks.length >= 5 && new Set(ticks).size === ticks.length, `${ticks}`);
    const ends = await Promise.all(["#range-low", "#range-high"].map((id) => page.inputValue(id)));
    assert.deepEqual(ends, [`${middle - 1}`, `${middle + 1}`]);
    assert.match(await page.getAttribute("#legend", "aria-label"), new RegExp(`from ${middle - 1} to ${middle + 1}`));
    assert.match(await page.getAttribute("#view", "aria-label"), new RegExp(`from ${middle - 1} to ${middle + 1}`));
    const lines = new Set(await drawn(page, () => page.check("#labels").then(() => written(page))));
    for (const x of [-0.75, 0.5]) assert.ok(lines.has(String(middle + x)), `${[...lines]}`);
    const stage = await page.locator("#stage").boundingBox();
    const at = await page.evaluate(() => littoral.view.project([0.35, 0.07, 0]));
    await page.mouse.click(stage.x + at.x, stage.y + at.y);
    const [value, place] = (await page.textContent("#pin-text")).split("\n");
    assert.ok(Math.abs(Number(value.split(" ")[1]) - middle - 0.35) < 0.01, value);
    const [x, y] = place.split("  ").map(Number);
    assert.ok(Math.abs(x - 500003.5) < 0.1 && Math.abs(y - 4000000.7) < 0.1, place);
    await page.fill("#range-low", String(middle - 0.25));
    await page.press("#range-low", "Enter");
    assert.equal(await page.inputValue("#range-low"), String(middle - 0.25));
    await page.waitForFunction((range) => location.hash.includes(range), `range=${middle - 0.25},${middle + 1}`);
  });
});

test("numbers stay on their lines when the panel is folded and the window changes", async () => {
  const made = scene(flat, [field("distance", each((x) => x + 1))]), moved = "#labels=1&camera=0.3,0.2,4,0,0,0";
  await withPage(made, { hash: moved }, async (page) => {
    const fits = () => page.waitForFunction(() => {
      const canvas = document.getElementById("numbers"), { clientWidth, clientHeight } = document.getElementById("stage");
      return littoral.written() > 0 && canvas.width === clientWidth && canvas.height === clientHeight;
    }, null, { timeout: 5000 });
    await fits();
    await page.focus("#view");
    await page.keyboard.press("p");
    await fits();
    await page.setViewportSize({ width: 700, height: 460 });
    await fits();
    await page.click("#fold");
    await fits();
  });
});

const saved = async (page, id) => {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(id)]);
  return readFileSync(await download.path());
};

/// Ends of the lines of a drawing.
const places = (svg) => [...svg.matchAll(/[ML]([\d.-]+) ([\d.-]+)/g)].map((m) => [Number(m[1]), Number(m[2])]);

test("lines that the range of values hides have no numbers, and are not drawn", chromiumOnly, async () => {
  const made = scene(flat, [field("distance", each((x) => x + 1), { spacing: 0.25 })]);
  await withPage(made, { hash: "#labels=1&range=0.6,1.3" }, async (page) => {
    await written(page);
    const again = () => page.uncheck("#labels").then(() => page.check("#labels")).then(() => written(page));
    const numbers = new Set(await drawn(page, again));
    assert.deepEqual([...numbers].sort(), ["0.75", "1", "1.25"]);
    await page.click("#more summary");
    const titles = [...String(await saved(page, "#save-svg")).matchAll(/<title>([\d.]+)<\/title>/g)].map((m) => m[1]);
    assert.deepEqual(titles, ["0.75", "1", "1.25"]);
  });
});

/// The distance from the middle of [-1, 1]^3, with a slice at z = 0.
function ball() {
  const n = 24, step = 2 / (n - 1), far = Math.sqrt(3), values = new Uint16Array(n ** 3);
  for (let v = 0; v < values.length; ++v) {
    const place = [v % n, Math.floor(v / n) % n, Math.floor(v / n / n)].map((i) => i * step - 1);
    values[v] = Math.round((65534 * Math.hypot(...place)) / far);
  }
  const box = { positions: [-1, -1, -1, 1, -1, -1, 1, 1, 1, -1, 1, 1], triangles: [0, 1, 2, 0, 2, 3] };
  return scene(box, [{ ...field("distance", [0, far]), spacing: 0.2, values: undefined }], {
    frame: { centre: [10, 0, 0], radius: 5, towardsEye: [0, 0, 1], up: [0, 1, 0] },
    volume: {
      n: [n, n, n], origin: [-1, -1, -1], spacing: [step, step, step], low: [5, -5, -5], high: [15, 5, 5],
      values: base64(values), axis: 2, position: 0.5, level: 0.1, isosurface: false,
    },
  });
}

test("the clipping box cuts lines and their numbers, says where it is, and is in the address", chromiumOnly, async () => {
  const sides = (page) => page.evaluate(() => {
    const at = (x) => littoral.view.project([x, 0, 0]).x;
    return [at(-0.5), at(0.5), at(1)];
  });
  await withPage(ball(), { hash: "#labels=1" }, async (page) => {
    await page.click("#box summary");
    await page.click("#more summary");
    const svg = async () => places(String(await saved(page, "#save-svg"))).map(([x]) => x);
    const [low, high, border] = await sides(page), whole = await svg();
    assert.ok(Math.min(...whole) < low - 20 && Math.max(...whole) > high + 20 && Math.max(...whole) < border + 1);
    await written(page);
    await drag(page, "box-x-low", 25);
    await drag(page, "box-x-high", 75);
    await frames(page);
    await written(page);
    const ink = await page.evaluate(() => {
      const canvas = document.getElementById("numbers"), across = [];
      const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 0) across.push((i / 4) % canvas.width);
      return [across.reduce((a, b) => Math.min(a, b)), across.reduce((a, b) => Math.max(a, b))];
    });
    assert.ok(ink[0] > low - 20 && ink[1] < high + 20, `numbers from ${ink}, the box from ${low} to ${high}`);
    const kept = await svg();
    const [least, most] = [Math.min(...kept), Math.max(...kept)];
    assert.ok(kept.length > 20 && least > low - 1 && most < high + 1, `lines from ${least} to ${most}`);
    assert.ok(least < low + 1 && most > high - 1, "up to the box");
    assert.deepEqual(await page.locator("#box output").allTextContents(), ["7.5", "12.5", "-5", "5", "-5", "5"]);
    await page.waitForFunction(() => /box=0.25,0,0,0.75,1,1/.test(location.hash));
    await assertAccessible(page);
    await drag(page, "box-x-low", 0);
    await drag(page, "box-x-high", 100);
    await page.waitForFunction(() => !/box=/.test(location.hash));
  });
  await withPage(ball(), { hash: "#box=0.25,0,0,0.75,1,1" }, async (page) => {
    const [low, high, border] = await sides(page);
    assert.ok(await page.isVisible("#box-x-low"), "it is open where it cuts");
    assert.deepEqual([await page.inputValue("#box-x-low"), await page.inputValue("#box-x-high")], ["25", "75"]);
    const seen = await page.evaluate((xs) => {
      const { y } = littoral.view.project([0, 0.1, 0]);
      return xs.map((x) => littoral.pick(x, y) !== null);
    }, [low - 5, low + 5, high - 5, (high + border) / 2]);
    assert.deepEqual(seen, [false, true, true, false]);
  });
});

test("numbers on lines move with the slice", async () => {
  await withPage(ball(), { hash: "#labels=1" }, async (page) => {
    await written(page);
    const before = new Set(await page.evaluate(() => texts));
    assert.ok(before.has("0.2"));
    const move = () => drag(page, "slice", 750).then(() => page.waitForFunction(() => texts.includes("0.6")));
    const after = new Set(await drawn(page, move));
    assert.ok(!after.has("0.2") && !after.has("0.4"), "half a box away nothing is nearer than 0.5");
  });
});

test("a saved picture has the numbers on lines", chromiumOnly, async () => {
  const made = scene(flat, [field("distance", each((x) => x + 1), { spacing: 0.2 })]);
  await withPage(made, {}, async (page) => {
    const without = await drawn(page, () => saved(page, "#save"));
    await page.check("#labels");
    await written(page);
    const shown = await page.evaluate(() => littoral.written()), texts = await drawn(page, () => saved(page, "#save"));
    assert.ok(!without.includes("1.2") && texts.filter((text) => /^[\d.]+$/.test(text)).length >= shown);
    assert.ok(texts.includes("1.2"), `${texts}`);
    // Of any size, on the lines: pictures with and without numbers differ there.
    await page.click("#more summary");
    await page.fill("#save-width", "1600");
    await page.fill("#save-height", "900");
    const picture = async () => (await saved(page, "#save")).toString("base64"), numbered = await picture();
    await page.uncheck("#labels");
    const [differ, off] = await page.evaluate(async (both) => {
      const [one, two] = await Promise.all(both.map(async (text) => {
        const image = new Image();
        image.src = `data:image/png;base64,${text}`;
        await image.decode();
        const { width, height } = image, canvas = Object.assign(document.createElement("canvas"), { width, height });
        const context = canvas.getContext("2d");
        context.drawImage(image, 0, 0);
        return context.getImageData(0, 0, width, height).data;
      }));
      const { clientWidth, clientHeight } = document.getElementById("stage"), scale = 900 / clientHeight;
      const [middle, next] = [0, 0.2].map((x) => littoral.view.project([x, 0, 0]).x), counts = [0, 0];
      const zero = middle - clientWidth / 2, step = scale * (next - middle);
      for (let i = 0; i < one.length; i += 4) {
        if (Math.abs(one[i] - two[i]) < 9) continue;
        const x = ((i / 4) % 1600) - 800 - scale * zero, away = Math.abs(x / step - Math.round(x / step)) * step;
        ++counts[away < 12 * scale ? 0 : 1];
      }
      return counts;
    }, [numbered, await picture()]);
    assert.ok(differ > 500 && off === 0, `${differ} pixels on lines, ${off} beside them`);
  });
});

test("boxes of values hold what they say", async () => {
  const cases = [[4.3368e-19, 0.010415], [-1.2346e-10, 1.2346e-10], [99999.1234, 99999.8765], [-2.4296, 0.48101]];
  for (const [low, high] of cases) {
    const values = each((x, y, v) => (v === 0 ? low : low + ((high - low) * (x + 1)) / 2));
    await withPage(scene(flat, [field("distance", values)]), {}, async (page) => {
      for (const id of ["range-low", "range-high"]) {
        const { room, needed, text } = await page.evaluate((name) => {
          const box = document.getElementById(name);
          return { room: box.clientWidth, needed: box.scrollWidth, text: box.value };
        }, id);
        assert.ok(needed <= room, `${text} needs ${needed} of ${room} pixels`);
      }
      const ends = await page.evaluate(() => ["range-row", "range-low", "range-high"].map((id) =>
        document.getElementById(id).getBoundingClientRect().right));
      assert.ok(ends[1] <= ends[0] + 1 && ends[2] <= ends[0] + 1, `${ends}`);
    });
  }
});

test("a field that is as small as it gets all over has no lines there", async () => {
  // 0 but for rounding on the left, where triangles go up and down; a slope on the right.
  const shape = square(40), noise = (v) => 1e-17 + 4e-5 * ((v * 7919) % 3 === 0);
  const values = each((x, y, v) => (x < 0 ? noise(v) : x), shape);
  await withPage(scene(shape, [field("distance", values, { spacing: 0.05 })]), {}, async (page) => {
    const differ = await page.evaluate(async () => {
      const before = littoral.pixels();
      document.getElementById("isolines").click();
      const after = littoral.pixels(), w = littoral.view.renderer.getContext().drawingBufferWidth;
      const middle = littoral.view.project([-0.03, 0, 0]).x, counts = [0, 0];
      for (let i = 0; i < after.length; i += 4) if (Math.abs(before[i] - after[i]) > 4) ++counts[(i / 4) % w < middle ? 0 : 1];
      return counts;
    });
    assert.equal(differ[0], 0, "on the left");
    assert.ok(differ[1] > 1000, "on the right");
  });
});

test("beside a difference the other result has a legend of its own, and numbers on its own lines", async () => {
  const made = scene(flat, [field("distance", each((x) => x + 1), { spacing: 0.25 })], {
    title: "first", beside: scene(flat, [field("distance", each((x) => 3 * (x + 1)), { spacing: 0.7 })], { title: "second" }),
  });
  await withPage(made, {}, async (page) => {
    assert.ok(await page.isHidden("#legend-beside"), "one legend for one field");
    await page.selectOption("#field", "difference");
    assert.match(await page.getAttribute("#legend-beside", "aria-label"), /^Legend: distance from 0 to 6/);
    const boxes = await Promise.all(["#stage", "#legend", "#legend-beside"].map((id) => page.locator(id).boundingBox()));
    const [stage, left, right] = boxes, middle = stage.x + stage.width / 2;
    const off = [left.x - stage.x, left.x + left.width - middle, right.x - middle, right.x + right.width - stage.x - stage.width];
    assert.ok(off.every((x) => Math.abs(x) < 1.5), `${off}`);
    const texts = await drawn(page, () => page.check("#labels").then(() => written(page)));
    assert.ok(texts.includes("2.1") && texts.includes("3.5"), `${texts}`);
    await assertAccessible(page);
    await page.selectOption("#field", "distance");
    assert.ok(await page.isHidden("#legend-beside"));
  });
});

test("on a narrow screen the legend of regions goes from side to side", async () => {
  const numbers = Array.from({ length: 128 }, (_, t) => (t < 64 ? 0 : 1));
  const regions = field("region", numbers, { at: "face", discrete: true, spacing: 0 });
  await withPage(scene(flat, [regions]), { viewport: { width: 390, height: 844 } }, async (page) => {
    const [stage, legend] = await Promise.all(["#stage", "#legend"].map((id) => page.locator(id).boundingBox()));
    assert.deepEqual([legend.x, legend.width], [stage.x, stage.width]);
  });
});

test("a field that is one number all over has that number as legend, and no way to a source", async () => {
  for (const viewport of [{ width: 760, height: 420 }, { width: 390, height: 844 }]) {
    await withPage(scene(flat, [field("distance", each(() => 2.5))]), { viewport }, async (page) => {
      assert.equal(await page.getAttribute("#legend", "aria-label"), "Legend: distance: 2.5");
      const { height } = await page.locator("#legend").boundingBox();
      assert.ok(height < 80, `${height} pixels high`);
      assert.ok(await page.isHidden("#path-row"));
    });
  }
  const style = { low: 0, high: 0, colourLow: 0, colourHigh: 0, diverging: false, spacing: 0 };
  await withPage(scene(flat, [field("distance", each(() => Infinity), style)]), {}, async (page) => {
    assert.equal(await page.getAttribute("#legend", "aria-label"), "Legend: distance: unreachable");
  });
});
