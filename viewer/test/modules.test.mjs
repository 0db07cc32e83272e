// What needs no browser: numbers, colours, fields, meshes, rays, isosurfaces, scenes.
import assert from "node:assert/strict";
import { test } from "node:test";
import { base64, field, load, scene, square, torus } from "./scenes.mjs";

const [numbers, colours, fields, mesh, pick, march, lines, scenes, descents, sky] = await Promise.all(
  ["numbers.ts", "colours.ts", "field.ts", "mesh.ts", "pick.ts", "march.ts", "isolines.ts", "scene.ts", "descent.ts", "openness.ts"].map(load));

const surfaceOf = ({ positions, triangles }) => ({
  positions: Float32Array.from(positions), triangles: Uint32Array.from(triangles), innerSides: null, faces: null, nodes: "faces",
});

test("spacing and ticks are the library's", () => {
  assert.equal(numbers.niceSpacing(0, 1, 10), 0.1);
  assert.equal(numbers.niceSpacing(-3, 3, 20), 0.25);
  assert.equal(numbers.niceSpacing(1, 1, 10), 0);
  assert.deepEqual(numbers.niceTicks(-0.5, 1, 0.5), [-0.5, 0, 0.5, 1]);
  assert.equal(numbers.numberText(0.1 + 0.2), "0.3");
  assert.equal(numbers.numberText(Infinity), "infinite");
  assert.equal(numbers.numberText(1.5e-7), "1.5e-7");
});

test("numbers have the digits that tell them apart", () => {
  const ticks = (low, high, step) => numbers.niceTicks(low, high, step).map((x) => numbers.numberText(x, 0.1 * step));
  assert.deepEqual(ticks(99999, 100000.5, 0.5), ["99999", "99999.5", "100000", "100000.5"]);
  assert.deepEqual(ticks(999999, 1000001, 1), ["999999", "1000000", "1000001"]);
  assert.deepEqual(ticks(1e9, 1e9 + 1000, 500), ["1000000000", "1000000500", "1000001000"]);
  assert.deepEqual(ticks(0, 1, 0.25), ["0", "0.25", "0.5", "0.75", "1"]);
  assert.deepEqual(ticks(0, 2e6, 1e6), ["0", "1e+6", "2e+6"]);
  assert.equal(numbers.numberText(4000001.25, numbers.fineOf(0, 100)), "4000001.25");
  assert.equal(numbers.numberText(1 / 3, numbers.fineOf(0, 1)), "0.33333");
  assert.equal(numbers.numberText(4.3368e-19, numbers.fineOf(0, 1)), "4.3368e-19");
  assert.equal(numbers.numberText(100000.125, numbers.fineOfLevels([100000, 100000.125, 100001])), "100000.125");
  assert.equal(numbers.fineOfLevels([3]), 0);
});

test("two hues meet at 0, wherever the ends of the map are", () => {
  const at = (value, low, high, map = "diverging") => colours.placeInMap((value - low) / (high - low), colours.middleOf(map, low, high));
  for (const [low, high] of [[-1, 1], [-0.2, 0.6], [-5, 0.01]])
    assert.deepEqual([low, low / 2, 0, high / 2, high].map((x) => Number(at(x, low, high).toFixed(9))), [0, 0.25, 0.5, 0.75, 1]);
  assert.deepEqual([-1, 0, 0.2, 0.4, 0.6, 9].map((x) => Number(at(x, 0.2, 0.6).toFixed(9))), [0.5, 0.5, 0.5, 0.75, 1, 1]);
  assert.deepEqual([-9, -3, -1, 1].map((x) => at(x, -3, -1)), [0, 0, 0.5, 0.5]);
  assert.equal(at(0.2, -0.2, 0.6, "viridis"), 0.5);
});

test("fields side by side have one map, with 0 in its middle if one of them has signs", () => {
  const signed = fields.makeField({ name: "d", values: [-1, 2] }), unsigned = fields.makeField({ name: "d", values: [0, 5] });
  for (const pair of [[signed, unsigned], [unsigned, signed]]) {
    const { map, diverging, low, high, colourLow, colourHigh } = fields.commonField(pair);
    assert.deepEqual([map, diverging, low, high, colourLow, colourHigh], ["diverging", true, -1, 5, -5, 5]);
  }
  const asked = fields.commonField([{ ...signed, colourLow: -0.2, colourHigh: 0.6 }, { ...signed, colourLow: -0.2, colourHigh: 0.6 }]);
  assert.deepEqual([asked.colourLow, asked.colourHigh], [-0.2, 0.6]);
  const positive = fields.commonField([unsigned, fields.makeField({ name: "d", values: [0, 7] })]);
  assert.deepEqual([positive.map, positive.colourLow, positive.colourHigh], ["sequential", 0, 7]);
  assert.equal(fields.commonField([]), null);
});

test("sequential maps get steadily lighter or darker, regions have colours of their own", () => {
  for (const name of colours.mapNames.filter((n) => n !== "diverging")) {
    const map = colours.colourMap(name), light = Array.from({ length: 256 }, (_, i) => colours.lightness(map.slice(3 * i, 3 * i + 3)));
    const way = Math.sign(light[255] - light[0]);
    assert.ok(Math.abs(light[255] - light[0]) > 0.5, name);
    for (let i = 8; i < 256; i += 8) assert.ok(way * (light[i] - light[i - 8]) > 0, `${name} at ${i}`);
  }
  assert.equal(new Set([-4, -3, -2, -1, 0, 1, 2, 3, 4].map((n) => String(colours.regionColour(n)))).size, 9);
});

test("values inside triangles: linear, weighted, quadratic", () => {
  const surface = surfaceOf(square(2));
  const linear = fields.makeField({ name: "f", values: Array.from({ length: 9 }, (_, v) => surface.positions[3 * v]) });
  assert.ok(Math.abs(fields.valueAt(linear, surface, 0, [1 / 3, 1 / 3, 1 / 3]) - (-1 - 0 + 0) / 3) < 1e-6);
  // x^2 on P2 triangles is exact everywhere.
  const p2 = [];
  for (let t = 0; t < surface.triangles.length / 3; ++t) {
    const x = [0, 1, 2].map((k) => surface.positions[3 * surface.triangles[3 * t + k]]);
    p2.push(...x.map((c) => c * c), ...[0, 1, 2].map((k) => ((x[(k + 1) % 3] + x[(k + 2) % 3]) / 2) ** 2));
  }
  const quadratic = fields.makeField({ name: "q", values: p2, at: "p2" });
  for (const b of [[0.2, 0.3, 0.5], [0.7, 0.2, 0.1]]) {
    const x = b.reduce((sum, w, k) => sum + w * surface.positions[3 * surface.triangles[3 + k]], 0);
    assert.ok(Math.abs(fields.valueAt(quadratic, surface, 1, b) - x * x) < 1e-6);
  }
  const weighted = { ...linear, weights: Uint8Array.from([255, 0, 255, 255, 255, 255, 255, 255, 255]) };
  assert.ok(Math.abs(fields.valueAt(weighted, surface, 0, [0.01, 0.99, 0]) - -1) < 1e-6, "a corner without weight does not count");
});

test("| grad | - 1 of a distance is 0, of twice a distance 1; differences are exact", () => {
  const surface = surfaceOf(square(4)), x = Array.from({ length: 25 }, (_, v) => 3 * surface.positions[3 * v]);
  const one = fields.makeField({ name: "distance", values: x }), two = fields.makeField({ name: "distance", values: x.map((c) => 2 * c) });
  const of = (f) => fields.gradientField(f, surface, 3);  // the page's unit is 3 of the field's
  assert.ok(Math.abs(fields.valueAt(of(one), surface, 5, [1, 0, 0])) < 1e-5);
  assert.ok(Math.abs(fields.valueAt(of(two), surface, 5, [1, 0, 0]) - 1) < 1e-5);
  const difference = fields.differenceField(two, one);
  assert.ok(Math.abs(fields.valueAt(difference, surface, 0, [0, 1, 0]) - x[1]) < 1e-5);
  const shares = fields.histogram(one, surface, 4);
  assert.ok(Math.abs(shares.reduce((a, b) => a + b) - 1) < 1e-9);
});

test("slopes at vertices: exact for linear fields, not cancelled where a field turns", () => {
  const surface = surfaceOf(square(6)), { positions, triangles } = surface;
  const tensor = (f) => mesh.slopeTensors(positions, triangles, mesh.gradients(positions, triangles, (t, k) => f(3 * triangles[3 * t + k])));
  const linear = tensor((v) => positions[v] + 2 * positions[v + 1]), kink = tensor((v) => Math.abs(positions[v]));
  for (let v = 0; v < 49; ++v) {
    for (const [k, x] of [1, 4, 0, 2, 0, 0].entries()) assert.ok(Math.abs(linear[6 * v + k] - x) < 1e-4);
    assert.ok(Math.abs(kink[6 * v] - 1) < 1e-4);
  }
});

test("rays meet the nearest triangle that is kept; places become lines of a source file", () => {
  const { positions, triangles } = surfaceOf(square(2)), ray = { origin: [0.25, -0.5, 5], direction: [0, 0, -1] };
  const hit = pick.pickTriangle(positions, triangles, ray);
  assert.equal(hit.distance, 5);
  assert.equal(pick.pickTriangle(positions, triangles, ray, () => false), null);
  const place = [0, 1].map((c) => hit.b.reduce((sum, w, k) => sum + w * positions[3 * triangles[3 * hit.triangle + k] + c], 0));
  assert.ok(Math.abs(place[0] - 0.25) < 1e-6 && Math.abs(place[1] + 0.5) < 1e-6);
  const line = (b, options) => pick.nodeLine({ triangle: 1, distance: 1, b }, triangles, options);
  assert.equal(line([0.99, 0.005, 0.005]), "v 0");
  assert.equal(line([0.005, 0.4, 0.595]), "e 4 3 0.59799");
  assert.equal(line([0.2, 0.3, 0.5]), "f 1 0.2 0.3 0.5");
  assert.equal(line([0.2, 0.3, 0.5], { vertexOnly: true }), "v 3");
});

test("isosurfaces close, with the field's normals; slivers do no harm", () => {
  const n = [21, 21, 21], values = new Float32Array(21 ** 3);
  for (let v = 0; v < values.length; ++v) values[v] = Math.hypot(v % 21 - 10, Math.floor(v / 21) % 21 - 10, Math.floor(v / 441) - 10) / 10;
  const shell = march.march({ n, origin: [-1, -1, -1], spacing: [0.1, 0.1, 0.1], values }, 0.6);  // through nodes
  const sides = new Map();
  for (let t = 0; t < shell.triangles.length; t += 3) for (let k = 0; k < 3; ++k) {
    const a = shell.triangles[t + k], b = shell.triangles[t + (k + 1) % 3], key = `${Math.min(a, b)},${Math.max(a, b)}`;
    sides.set(key, (sides.get(key) ?? 0) + 1);
  }
  assert.ok([...sides.values()].every((count) => count === 2));
  for (let i = 0; i < shell.positions.length; i += 3) {
    const r = Math.hypot(...shell.positions.slice(i, i + 3));
    assert.ok(Math.abs(r - 0.6) < 0.01);
    const facing = [0, 1, 2].reduce((sum, k) => sum + (shell.positions[i + k] / r) * shell.normals[i + k], 0);
    assert.ok(facing > 0.99, `normal ${facing}`);
  }
});

const openness = (positions, triangles) => {
  const steps = sky.opennessSteps(Float32Array.from(positions), Uint32Array.from(triangles));
  for (;;) {
    const { done, value } = steps.next();
    if (done) return (v, n) => value[4 * v + 3] / 255 + [0, 1, 2].reduce((sum, k) => sum + (1.5 * value[4 * v + k] / 255 - 0.75) * n[k], 0) / 1.5;
  }
};

// As in tests/scene_looks_test.cpp.
test("openness: of a ball, of the floor of a ditch as wide as it is deep twice, of a sheet", () => {
  const ball = march.march({ n: [21, 21, 21], origin: [-1, -1, -1], spacing: [0.1, 0.1, 0.1], values: Float32Array.from({ length: 21 ** 3 }, (_, v) =>
    Math.hypot(v % 21 - 10, Math.floor(v / 21) % 21 - 10, Math.floor(v / 441) - 10) / 10) }, 0.7);
  const round = openness(ball.positions, ball.triangles);
  for (let v = 0; v < ball.positions.length / 3; ++v) {
    const out = Array.from(ball.normals.subarray(3 * v, 3 * v + 3));
    assert.ok(round(v, out) > 0.9, `${round(v, out)} of the sky from vertex ${v}`);
    assert.ok(round(v, out.map((c) => -c)) < 0.2, "and nothing from inside");
  }
  const positions = [], triangles = [], n = 20;
  const add = (a, u, w) => {
    const first = positions.length / 3;
    for (let j = 0; j <= n; ++j) for (let i = 0; i <= n; ++i) positions.push(...a.map((c, k) => c + (i * u[k] + j * w[k]) / n));
    for (let j = 0; j < n; ++j) for (let i = 0; i < n; ++i) {
      const v = first + i + (n + 1) * j;
      triangles.push(v, v + 1, v + n + 2, v, v + n + 2, v + n + 1);
    }
  };
  add([-0.5, -4, 0], [1, 0, 0], [0, 8, 0]);
  add([-0.5, -4, 0], [0, 0, 0.5], [0, 8, 0]);
  add([0.5, -4, 0], [0, 0, 0.5], [0, 8, 0]);
  const middle = 10 + 21 * 10, tilt = 3 * (-0.25 + Math.SQRT2 / 8), near = (x, y) => assert.ok(Math.abs(x - y) < 0.03, `${x} is not ${y}`);
  const ditch = openness(positions, triangles);
  near(ditch(middle, [0, 0, 1]), 0.75 + (2 * tilt) / 3);
  near(ditch(middle, [0, 0, -1]), 0.75 - (2 * tilt) / 3);
  const sheet = openness(positions, triangles.slice(0, 2400));
  for (const z of [1, -1]) assert.ok(sheet(middle, [0, 0, z]) > 0.97);
  assert.equal(Math.round(sheet(positions.length / 3 - 1, [0, 0, 1])), 1, "a vertex of no triangle is open");
});

test("openness goes from vertices to the nodes about them", () => {
  const grid = { n: [4, 3, 3], origin: [0, 0, 0], spacing: [1, 1, 1] }, open = sky.onGrid(grid, Float32Array.from([0.25, 1, 1, 2, 2, 2]), Uint8Array.from([10, 20, 30, 40, 100, 110, 120, 130]));
  const at = (x, y, z) => Array.from(open.subarray(4 * (x + 4 * y + 12 * z), 4 * (x + 4 * y + 12 * z) + 4));
  assert.deepEqual([at(0, 1, 1), at(1, 1, 1), at(2, 2, 2)], [[10, 20, 30, 40], [10, 20, 30, 40], [100, 110, 120, 130]]);
  assert.deepEqual(at(3, 1, 2), [100, 110, 120, 130], "and one node on");
  assert.deepEqual(at(3, 0, 0), [128, 128, 128, 255], "open, where nothing is near");
});

test("isolines lie where the field has their level", () => {
  const { positions, triangles } = torus(40, 24), corner = (t, k) => positions[3 * triangles[3 * t + k]];
  for (const { level, ends } of lines.isolines({ positions, triangles, corner }, [-0.5, 0, 0.3])) {
    assert.ok(ends.length > 60);
    for (let i = 0; i < ends.length; i += 3) assert.ok(Math.abs(ends[i] - level) < 1e-6);
  }
});

const noMarks = { signed: new Float32Array(0), unsigned: new Float32Array(0), points: new Float32Array(0) };
const lengthOf = (places) => {
  let sum = 0;
  for (let i = 3; i < places.length; i += 3) sum += Math.hypot(...[0, 1, 2].map((k) => places[i + k] - places[i + k - 3]));
  return sum;
};
/// The way down from inside of each of some triangles of a shape, with distances at its vertices: ends at `marks`, within `part` of the value.
function descend(shape, values, marks, part, check = () => undefined) {
  const surface = surfaceOf(shape), count = surface.triangles.length / 3, field = fields.makeField({ name: "distance", values });
  const descent = new descents.Descent(surface), b = [0.5, 0.3, 0.2];
  for (let i = 0; i < 40; ++i) {
    const triangle = Math.floor(((i + 0.5) * count) / 40), { places, length, reached } = descent.path(field, 1, { ...noMarks, ...marks }, { triangle, b });
    const value = Math.abs(fields.valueAt(field, surface, triangle, b));
    assert.ok(reached, `from triangle ${triangle}`);
    assert.ok(Math.abs(length - lengthOf(places)) < 1e-9);
    assert.ok(Math.abs(length - value) < part * Math.max(value, 0.1), `from triangle ${triangle}: ${length} for ${value}`);
    check(places.slice(-3), places);
  }
}

test("the way down a distance ends at its source and is as long as the distance", () => {
  // To a place inside of a face of a square: 1 %.
  const flat = square(40), source = [0.213, -0.117, 0], to = (p) => Math.hypot(p[0] - source[0], p[1] - source[1]);
  const each = ({ positions }, f) => Array.from({ length: positions.length / 3 }, (_, v) => f(positions.slice(3 * v, 3 * v + 3)));
  const atSource = (end) => assert.ok(to(end) < 1e-6, `it ends at ${end}`);
  descend(flat, each(flat, to), { points: Float32Array.from(source) }, 0.01, atSource);
  // The same square in pieces that share no vertex.
  const soup = { positions: Array.from(flat.triangles, (v) => flat.positions.slice(3 * v, 3 * v + 3)).flat(), triangles: flat.triangles.map((_, c) => c) };
  descend(soup, each(soup, to), { points: Float32Array.from(source) }, 0.01, atSource);
  // From both sides of a line between vertices: straight, and to where the field is 0.
  descend(flat, each(flat, (p) => p[0] - 0.513), {}, 1e-4, (end) => assert.ok(Math.abs(end[0] - 0.513) < 1e-5));
  // On a sphere, round the pole as well: 1 %.
  const globe = { positions: [], triangles: [] }, m = 96, n = 48, at = (i, j) => (j <= 0 ? 0 : j >= n ? 1 : 2 + (j - 1) * m + (i % m));
  globe.positions.push(0, 0, 1, 0, 0, -1);
  for (let j = 1; j < n; ++j) for (let i = 0; i < m; ++i) {
    const a = (2 * Math.PI * i) / m, z = (Math.PI * j) / n;
    globe.positions.push(Math.sin(z) * Math.cos(a), Math.sin(z) * Math.sin(a), Math.cos(z));
  }
  for (let j = 0; j < n; ++j) for (let i = 0; i < m; ++i) {
    if (j > 0) globe.triangles.push(at(i, j), at(i, j + 1), at(i + 1, j));
    if (j < n - 1) globe.triangles.push(at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
  }
  const pole = globe.positions.slice(3 * at(7, 15), 3 * at(7, 15) + 3), round = (p) => Math.acos(Math.min(1, p[0] * pole[0] + p[1] * pole[1] + p[2] * pole[2]));
  descend(globe, each(globe, round), {}, 0.01, (end) => assert.ok(round(end) < 1e-3));
});

test("where nothing leads to a source the way down says so", () => {
  const surface = surfaceOf(square(10)), height = Array.from({ length: 121 }, (_, v) => (v % 11 > 6 ? Infinity : 0.5 + surface.positions[3 * v] ** 2));
  const field = fields.makeField({ name: "distance", values: height }), descent = new descents.Descent(surface);
  assert.equal(descent.path(field, 1, noMarks, { triangle: 0, b: [0.2, 0.3, 0.5] }).reached, false);
  const unreachable = descent.path(field, 1, noMarks, { triangle: 18, b: [0.2, 0.3, 0.5] });
  assert.deepEqual([unreachable.places.length, unreachable.length, unreachable.reached], [3, 0, false]);
});

test("scenes are read, and damaged ones refused in words", () => {
  const good = scene(square(2), [field("f", [1, 2, 3, 4, 5, 6, 7, 8, Infinity])]);
  const read = scenes.readScene(JSON.stringify(good));
  assert.equal(read.fields[0].high, 8);
  assert.equal(read.fields[0].values[8], Infinity);
  const refused = (spoil, pattern) => {
    const bad = structuredClone(good);
    spoil(bad);
    assert.throws(() => scenes.readScene(JSON.stringify(bad)), (error) => error instanceof scenes.SceneError && pattern.test(error.message));
  };
  refused((s) => { s.version = 1; }, /version 1, this page shows version 2/);
  refused((s) => { s.format = "other"; }, /no scene/);
  refused((s) => { s.surface.triangles = base64(Uint32Array.from([0, 1, 99])); }, /vertex 99/);
  refused((s) => { s.surface.positions = "AAA"; }, /positions/);
  refused((s) => { s.surface.positions = base64(Float32Array.from([NaN, 0, 0])); }, /finite/);
  refused((s) => { s.fields[0].values = base64(new Float32Array(3)); }, /values has the wrong length/);
  refused((s) => { s.fields[0].values = base64(new Float32Array(9).fill(NaN)); }, /not a number/);
  refused((s) => { s.fields[0].at = "nowhere"; }, /nowhere/);
  refused((s) => { delete s.sources; }, /sources is missing/);
  refused((s) => { s.volume = { n: [1, 2, 2] }; }, /integers from 2 on/);
  const volume = { n: [2, 2, 2], origin: [0, 0, 0], spacing: [1, 1, 1], low: [0, 0, 0], high: [1, 1, 1], axis: 2, position: 0, level: 0.5, values: base64(new Uint16Array(8)) };
  const cloud = { operation: "unite", tori: base64(new Float32Array(16)) }, trace = { clouds: [cloud], blend: 0, offset: 0, steepness: 1, low: 0, range: 1 };
  assert.equal(scenes.readScene(JSON.stringify({ ...good, volume, trace })).trace.clouds[0].samples.length, 8);
  refused((s) => { s.trace = trace; }, /needs a volume/);
  const damaged = (clouds, pattern) => refused((s) => { s.volume = volume; s.trace = { ...trace, clouds }; }, pattern);
  damaged([], /1 to 8 clouds/);
  damaged(Array(9).fill(cloud), /1 to 8 clouds/);
  damaged([{ ...cloud, operation: "mix" }], /united, intersected or subtracted/);
  damaged([{ ...cloud, tori: base64(new Float32Array(15)) }], /16 numbers/);
  damaged([{ ...cloud, low: 0, range: 1, values: base64(new Uint16Array(7)) }], /values has the wrong length/);
  assert.throws(() => scenes.readScene("{"), /cut off/);
});
