// littoral view --edit: the studio with the program behind it, and who may talk to that.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { readFileSync, writeFileSync } from "node:fs";
import { request } from "node:http";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { assertClose, byProgram, clickAll, dropFiles, folder, openStudio, program, ring, root, saved, settled, state } from "./helpers.mjs";

const spot = join(root, "examples/data/spot.obj");

/** The program with a surface, once it has said where. */
async function serve(...given) {
  const child = spawn(program, ["view", ...given, "--edit"], { stdio: ["ignore", "pipe", "inherit"] });
  const [line] = await once(child.stdout, "data");
  const address = String(line).trim();
  const end = async () => {
    child.kill("SIGINT");
    if (child.exitCode === null) await once(child, "exit");
    return child.exitCode;
  };
  return { address, here: new URL(address), end };
}

let served;
before(async () => { served = await serve(spot); });
after(() => served.end());

/** What comes back: status, and the body as text and as bytes. */
function ask(path, { method = "GET", headers = {}, body } = {}) {
  const { hostname, port } = served.here;
  return new Promise((resolve, reject) => {
    const sent = request({ hostname, port, path, method, headers }, async (answer) => {
      const bytes = Buffer.concat(await answer.toArray());
      resolve({ status: answer.statusCode, text: bytes.toString(), bytes });
    });
    sent.on("error", reject).end(body);
  });
}
const token = () => served.here.searchParams.get("token");
const own = () => ({ Authorization: `Bearer ${token()}` });

function message(text) {
  const json = Buffer.from(text.padEnd(Math.ceil(text.length / 8) * 8));
  const head = Buffer.from([0, 0, 0, 0, 0x4c, 0x54, 0x4c, 0x31]);
  head.writeUInt32LE(json.length);
  return Buffer.concat([head, json]);
}
async function call(number, asked, page = "raw") {
  const body = message(typeof asked === "string" ? asked : JSON.stringify(asked));
  const { status, bytes } = await ask(`/call?page=${page}&call=${number}`, { method: "POST", headers: own(), body });
  assert.equal(status, 200);
  return JSON.parse(bytes.subarray(8, 8 + bytes.readUInt32LE(0)).toString());
}

test("a curve of clicks gives the distance of the command line; no request goes anywhere else", async () => {
  const shown = await openStudio({ url: served.address }), { page } = shown;
  assert.equal(await page.evaluate(() => studio.engine.surface.name), "spot.obj");
  assert.equal((await state(page)).values, null);
  await page.click("#mode-curve");
  const places = await ring(page, 5);
  await clickAll(page, places);
  const { strokes, values } = await state(page);
  assert.equal(strokes[0].nodes, places.length);
  const { bytes } = await saved(page, "save-sources");
  assertClose(values, byProgram(spot, bytes), 1e-12);
  assert.match((await saved(page, "save-field", ".csv")).bytes.toString(), /^vertex,distance\n0,/);
  await page.selectOption("#task", "regions");
  assert.equal((await state(page)).method, "surface-winding");
  assert.deepEqual(shown.errors, []);
  const elsewhere = shown.requests.filter((url) => !/^(data|blob):/.test(url) && new URL(url).origin !== served.here.origin);
  assert.deepEqual(elsewhere, []);
  assert.ok(shown.requests.some((url) => url.includes("/call?")), "the program computes");
  await shown.close();
});

test("a link that is copied carries no token, and the address keeps it", async () => {
  const shown = await openStudio({ url: served.address }), { page } = shown;
  await page.click("#mode-point");
  await clickAll(page, (await ring(page, 5)).slice(0, 1));
  await settled(page);
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await page.click("#link");
  await page.waitForSelector("#toast:not([hidden])");
  const copied = await page.evaluate(() => navigator.clipboard.readText()), here = await page.evaluate(() => location.href);
  assert.ok(!copied.includes(token()) && copied.startsWith(`${served.here.origin}/#`), copied);
  assert.ok(here.startsWith(`${served.address}#`), here);
  const hash = copied.slice(copied.indexOf("#")), again = await openStudio({ url: served.address, hash });
  assert.equal((await state(again.page)).points, 1);
  await again.close();
  await shown.close();
});

test("an example is computed by the program too", async () => {
  const shown = await openStudio({ url: served.address, example: "ring" }), { page } = shown;
  await page.click("#mode-point");
  const [place] = await ring(page, 12, 0.3);
  await page.mouse.click(place.x, place.y);
  const { values, points } = await state(page);
  assert.equal(points, 1);
  assert.ok(values.length > 3000 && Math.min(...values) >= 0);
  assert.deepEqual(shown.errors, []);
  await shown.close();
});

test("files that are dropped go to the program: a mesh, then curves on it, then what it cannot read", async () => {
  const n = 12, lines = [], mesh = join(folder, "hill.obj"), curve = join(folder, "hill-curve.txt"), bad = join(folder, "bad.ply");
  for (let i = 0; i <= n; ++i) for (let j = 0; j <= n; ++j) lines.push(`v ${i / n} ${j / n} ${(0.3 * Math.sin((3 * i) / n)).toFixed(6)}`);
  for (let i = 0; i < n; ++i) for (let j = 0; j < n; ++j) {
    const a = i * (n + 1) + j + 1;
    lines.push(`f ${a} ${a + n + 1} ${a + n + 2}`, `f ${a} ${a + n + 2} ${a + 1}`);
  }
  writeFileSync(mesh, `${lines.join("\n")}\n`);
  writeFileSync(curve, "signed_curve\nv 3\nv 60\nv 160\n");
  writeFileSync(bad, "ply\nformat ascii 1.0\nelement vertex 9\n");
  const shown = await openStudio({ url: served.address }), { page } = shown;
  const calls = () => shown.requests.filter((url) => url.includes("/call?")).length, before_ = calls();
  await dropFiles(page, mesh);
  await page.waitForFunction(() => studio.engine.surface.name === "hill.obj");
  assert.ok(calls() > before_, "the program reads it");
  assert.equal((await state(page)).values, null);
  await dropFiles(page, curve);
  await page.waitForFunction(() => studio.history.drawing.strokes.length === 1);
  const { values, message: said, strokes } = await state(page);
  assert.deepEqual([said, strokes], [null, [{ nodes: 3, closed: false, signed: true }]]);
  assertClose(values, byProgram(mesh, readFileSync(curve)), 1e-12);
  await dropFiles(page, bad);
  await page.waitForSelector("#message:not([hidden])");
  assert.match(await page.textContent("#message"), /^bad\.ply cannot be opened\./);
  assert.equal((await state(page)).values.length, (n + 1) ** 2, "the surface stays");
  assert.deepEqual(shown.errors, []);
  await shown.close();
});

test("source files that are named are drawn, all of them", async () => {
  const curve = join(folder, "curve.txt"), point = join(folder, "point.json");
  writeFileSync(curve, "signed_curve\nv 0\nv 900\nv 1800\n");
  writeFileSync(point, '{"curves": [], "points": [{"v": 5}]}');
  const other = await serve(spot, "-s", curve, "-s", point);
  const shown = await openStudio({ url: other.address });
  const { strokes, points } = await state(shown.page);
  assert.deepEqual([strokes, points], [[{ nodes: 3, closed: false, signed: true }], 1]);
  await shown.close();
  assert.equal(await other.end(), 130, "an interrupt ends it");
});

test("without the token, and for other hosts and sites, there is only a refusal", async () => {
  const { host } = served.here, page = `/?token=${token()}`;
  assert.equal((await ask(page)).status, 200);
  assert.equal((await ask(page, { headers: { Host: host.replace("127.0.0.1", "localhost") } })).status, 200);
  const about = { method: "POST", body: message('{"op":"about","args":[]}') };
  const refused = {
    "no token": ["/"],
    "a wrong token": [`/?token=${"0".repeat(32)}`],
    "a shorter token": [page.slice(0, -1)],
    "another host": [page, { headers: { Host: "littoral.example" } }],
    "another port": [page, { headers: { Host: "127.0.0.1:1" } }],
    "another site": [page, { headers: { Origin: "http://littoral.example" } }],
    "a file": [page, { headers: { Origin: "null" } }],
    "a call without the token": ["/call?page=a&call=1", about],
    "a call with it in the address": [`/call?page=a&call=1&token=${token()}`, about],
    "a call of another site": ["/call?page=a&call=1", { ...about, headers: { ...own(), Origin: "https://littoral.example" } }],
    "progress without the token": ["/progress?page=a"],
    "cancelling without the token": ["/cancel?page=a&call=1", { method: "POST" }],
  };
  for (const [what, [path, options]] of Object.entries(refused)) {
    const { status, text } = await ask(path, options);
    assert.equal(status, 403, what);
    assert.equal(JSON.parse(text).error, "Refused", what);
  }
  assert.equal((await ask("/elsewhere", { headers: own() })).status, 404);
  assert.equal((await ask("/call?page=a", { ...about, headers: own() })).status, 404);
});

test("requests that make no sense get errors of a kind", async () => {
  const failing = async (asked, kind, text) => {
    const { error, message: said } = await call(1, asked);
    assert.equal(error, kind, said);
    assert.match(said, text);
  };
  await failing({ op: "fly", args: [] }, "InputError", /no operation 'fly'/);
  await failing({ op: "about" }, "InputError", /list of arguments/);
  await failing({ op: "info", args: [{}] }, "InputError", /object by its number/);
  await failing({ op: "makeSurface", args: [{ $f64: [0, 9] }, null, null, null], as: [1] }, "InputError", /beyond the message/);
  await failing({ op: "makeSurface", args: [[0, 0, 0], [0.5, 0, 0], null, null], as: [1] }, "InputError", /whole numbers holds 0\.5/);
  await failing({ op: "makeSurface", args: [{ $f64: [-8, 3] }, null, null, null], as: [1] }, "InputError", /no place/);
  await failing('{"op"', "InputError", /cannot be read/);
  await failing("[".repeat(100000), "InputError", /too deeply/);
  await failing("[]", "InputError", /type/);
  const { fatal } = await call(1, { op: "info", args: [{ handle: 77 }] });
  assert.equal(fatal, true, "the page makes its objects again");
});

test("a call that is cancelled before it arrives does not run", async () => {
  const page = "cancelling";
  assert.ok((await call(1, { op: "loadGiven", args: [], as: [1] }, page)).value);
  const prepare = (as) => ({ op: "prepare", args: [{ handle: 1 }, "signed-heat", {}], as: [as] });
  assert.equal((await ask(`/cancel?page=${page}&call=2`, { method: "POST", headers: own() })).status, 200);
  assert.equal((await call(2, prepare(2), page)).error, "Cancelled");
  assert.ok((await call(3, prepare(3), page)).value);
});
