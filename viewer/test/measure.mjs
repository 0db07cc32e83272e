// node test/measure.mjs [TRIANGLES ...]: how long a page takes to its first picture, and a frame: what the browser takes
// to read the file, what the page's own code takes, and what is left to the graphics. Chromium draws in software unless
// GPU=1 is set and the machine has one. Processor time is that of the page's process and of the one that draws, all
// their threads together: it says what a machine can do that is busy with something else.
import { field, scene, show, torus } from "./scenes.mjs";

for (const wanted of process.argv.length > 2 ? process.argv.slice(2).map(Number) : [500000, 2000000]) {
  const side = Math.round(Math.sqrt(wanted / 2)), shape = torus(side, side);
  const values = Array.from({ length: side * side }, (_, v) => shape.positions[3 * v]);
  const less = { ...shape, positions: Float32Array.from(shape.positions), triangles: Uint32Array.from(shape.triangles) };
  const made = scene(less, [{ ...field("distance", values.slice(0, 4)), ...range(values) }], { title: "torus" });
  let own;  // processor time of the page's own thread
  const prepare = async (page) => {
    own = await page.context().newCDPSession(page);
    await own.send("Performance.enable", { timeDomain: "threadTicks" });
  };
  const shown = await show(made, { wait: false, viewport: { width: 1286, height: 720 }, prepare });
  const session = await shown.page.context().browser().newBrowserCDPSession();
  const spent = async () => (await session.send("SystemInfo.getProcessInfo")).processInfo
    .reduce((sum, { type, cpuTime }) => sum + (type === "renderer" || type === "GPU" ? 1000 * cpuTime : 0), 0);
  try {
    await shown.page.waitForFunction(() => window.littoral?.frames() > 0, null, { timeout: 300000 });
    const first = await spent(), { metrics } = await own.send("Performance.getMetrics");
    const thread = (name) => 1000 * metrics.find((one) => one.name === name).value;
    const times = await shown.page.evaluate(() => {
      const { view } = littoral, gl = view.renderer.getContext(), one = new Uint8Array(4), frames = [], asked = [];
      const finish = () => gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, one);
      finish();
      const opened = performance.now(), { began, read, built, firstFrame } = littoral.times();
      for (let i = 0; i < 8; ++i) {
        view.orbit.turn(0.1, 0);
        const from = performance.now();
        view.render();
        asked.push(performance.now() - from);
        finish();
        frames.push(performance.now() - from);
      }
      const from = performance.now(), middle = (list) => list.sort((a, b) => a - b)[4];
      littoral.pick(500, 360);
      return { opened, began, read: read - began, built: built - read, drawn: firstFrame - built, graphics: opened - firstFrame,
        frame: middle(frames), asked: middle(asked), pick: performance.now() - from,
        renderer: gl.getParameter(gl.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER) };
    });
    const frame = (await spent() - first) / 8;
    const ms = (x) => `${x < 10 ? x.toFixed(1) : Math.round(x)} ms`;
    console.log(`${2 * side * side} triangles, first picture by ${ms(times.opened)}: file read by the browser ${ms(times.began)}, scene ${ms(times.read)}, ` +
      `geometry and controls ${ms(times.built)}, first frame asked for ${ms(times.drawn)}, drawn ${ms(times.graphics)}; processor ${ms(first)}, ` +
      `of which the page's thread ${ms(thread("TaskDuration"))}, its code ${ms(thread("ScriptDuration"))}\n` +
      `  a frame ${ms(times.frame)}, of which the page's code ${ms(times.asked)}; processor ${ms(frame)}; place under the cursor ${ms(times.pick)}; ${times.renderer}`);
  } finally {
    await shown.close();
  }
}

function range(values) {
  let low = Infinity, high = -Infinity;
  for (const x of values) {
    low = Math.min(low, x);
    high = Math.max(high, x);
  }
  const parts = Float32Array.from(values, (x) => (x - low) / (high - low));
  return { low, high, colourLow: low, colourHigh: high, spacing: (high - low) / 20, values: Buffer.from(parts.buffer).toString("base64") };
}
