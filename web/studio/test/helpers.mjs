// Opens the studio and acts on it as a person would.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { openPage } from "../../../viewer/test/browser.mjs";

export const root = resolve(dirname(fileURLToPath(import.meta.url)), "../../..");
export const folder = mkdtempSync(join(tmpdir(), "littoral-studio-"));
const file = process.env.STUDIO ?? join(root, "dist/studio.html");
export const program = process.env.LITTORAL ?? join(root, "build/release/littoral");

/** The page, with an example or a link, once it has computed all it was asked for. */
export async function openStudio({ url = pathToFileURL(file).href, hash = "", example, ...options } = {}) {
  const shown = await openPage(url + hash, { colorScheme: "light", viewport: { width: 800, height: 560 }, ...options });
  await shown.page.waitForFunction(() => window.studio, null, { timeout: 60000 });
  await settled(shown.page);
  if (example) {
    await shown.page.selectOption("#examples", example);
    await shown.page.waitForFunction((id) => studio.files.example === id, example);
    await settled(shown.page);
  }
  return { ...shown, url };
}

/** Nothing is being computed and the last picture is drawn. */
export async function settled(page) {
  await page.waitForFunction(() => !studio.engine.busy && studio.stage.settled, null, { timeout: 60000 });
  await page.waitForTimeout(60);
  await page.waitForFunction(() => !studio.engine.busy && studio.stage.settled, null, { timeout: 60000 });
}

export async function closeQuietly({ page, errors, requests, url, close }) {
  const left = requests.filter((r) => !/^(data|blob):/.test(r) && r.split("#")[0] !== url);
  await close();
  assert.deepEqual(errors, [], "nothing on the console");
  assert.deepEqual(left, [], "no request leaves the page");
}

/** Places on the screen where the surface is, in a ring about the middle of the picture. */
export const ring = (page, count, part = 0.14) => page.evaluate(([n, r]) => {
  const box = document.getElementById("view").getBoundingClientRect(), out = [];
  const { right, bottom } = studio.stage.insets;
  const cx = box.left + (box.width - right) / 2, cy = box.top + (box.height - bottom) / 2;
  for (let i = 0; i < n; ++i) {
    const a = (2 * Math.PI * i) / n;
    out.push({ x: cx + r * box.height * Math.cos(a), y: cy + r * box.height * Math.sin(a) });
  }
  return out.filter(({ x, y }) => studio.stage.pick(x, y));
}, [count, part]);

export async function clickAll(page, places) {
  for (const { x, y } of places) await page.mouse.click(x, y);
}

/** What is drawn and what is answered, once nothing is being computed. */
export async function state(page) {
  await settled(page);
  return page.evaluate(() => ({
    strokes: studio.history.drawing.strokes.map((s) => ({ nodes: s.nodes.length, closed: s.closed, signed: s.signed })),
    points: studio.history.drawing.points.length,
    values: studio.answer ? Array.from(studio.answer.values) : null,
    method: studio.answer?.report.method, status: document.getElementById("status").textContent,
    message: document.getElementById("message").hidden ? null : document.getElementById("message").textContent,
    warnings: [...document.querySelectorAll("#warnings li")].map((li) => li.textContent),
  }));
}

/** What a button gives to save, in a format of the list beside it: its bytes and name. */
export async function saved(page, id, format) {
  await page.evaluate(() => { document.getElementById("save-menu").open = true; });
  if (format) await page.selectOption(`#${id.slice(5)}-format`, format);
  const asked = (file) => file.suggestedFilename().endsWith(format ?? ""); // samples come with their card, in any order
  const [download] = await Promise.all([page.waitForEvent("download", asked), page.click(`#${id}`)]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

export const run = (...args) => execFileSync(program, [...args, "--quiet"], { stdio: ["ignore", "ignore", "inherit"] });

/** The command line's confidence at the vertices, for a mesh and a source file. */
export function confidenceByProgram(mesh, sources) {
  const to = join(folder, "sure.ply");
  run("distance", mesh, "-s", sources, "--confidence", "-o", to);
  const bytes = readFileSync(to), head = bytes.subarray(0, bytes.indexOf("end_header\n") + 11).toString();
  const [, count] = head.match(/element vertex (\d+)/), doubles = [...head.matchAll(/property double (\w+)/g)].map(([, name]) => name);
  const stride = 8 * doubles.length + 3, at = head.length + 8 * doubles.indexOf("confidence"); // and three bytes of colour
  return Array.from({ length: Number(count) }, (_, v) => bytes.readDoubleLE(at + stride * v));
}

/** The command line's distance at the vertices, for a mesh and the bytes of a source file. */
export function byProgram(mesh, sources, ...options) {
  const from = join(folder, "sources.txt"), to = join(folder, "out.txt");
  writeFileSync(from, sources);
  run("distance", mesh, "-s", from, "-o", to, ...options);
  return readFileSync(to, "utf8").trim().split("\n").map(Number);
}

export function assertClose(a, b, tolerance) {
  assert.equal(a.length, b.length);
  let worst = 0;
  for (let i = 0; i < a.length; ++i) if (a[i] !== b[i]) worst = Math.max(worst, Math.abs(a[i] - b[i]));
  assert.ok(worst < tolerance, `they differ by up to ${worst}`);
}

/** How many pixels an action changes. */
export async function changedPixels(page, act) {
  await page.evaluate(() => { window.was = studio.stage.pixels(); });
  await act();
  await settled(page);
  return page.evaluate(() => {
    const now = studio.stage.pixels();
    let count = 0;
    if (now.length !== was.length) return Infinity;
    for (let i = 0; i < now.length; i += 4)
      if (Math.abs(now[i] - was[i]) + Math.abs(now[i + 1] - was[i + 1]) + Math.abs(now[i + 2] - was[i + 2]) > 12) ++count;
    return count;
  });
}

export const pickFile = async (page, name, bytes) =>
  page.setInputFiles("#file", { name, mimeType: "application/octet-stream", buffer: Buffer.from(bytes) });

/** Drags files from the desktop over the picture and lets them go there, as the browser itself does it. */
export async function dropFiles(page, ...paths) {
  const session = await page.context().newCDPSession(page), box = await page.locator("#stage").boundingBox();
  const data = { items: [], files: paths, dragOperationsMask: 1 };
  const send = (type) => session.send("Input.dispatchDragEvent", { type, x: box.x + box.width / 2, y: box.y + box.height / 2, data });
  const over = () => page.evaluate(() => document.getElementById("stage").classList.contains("over"));
  await send("dragEnter");
  await send("dragOver");
  assert.equal(await over(), true, "it shows where it goes");
  await send("drop");
  assert.equal(await over(), false);
  await session.detach();
}
