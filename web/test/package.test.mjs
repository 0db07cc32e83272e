// The package in Node: the same numbers as the program, errors, memory, cancelling. DIST names it.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { pathToFileURL } from "node:url";
import { assertSameAsProgram, difference } from "./compare.mjs";
import { cases, file, files, folder, obj, program, queries, regionSources, root } from "./inputs.mjs";
import { measured } from "./measured.mjs";

const dist = process.env.DIST ?? join(root, "dist");
const { open, ...errors } = await import(pathToFileURL(join(dist, "littoral.js")).href);
const littoral = await open();
after(() => littoral.close());
const spot = await littoral.loadSurface(files["spot.obj"], "spot.obj");
const square = await littoral.makeSurface({ positions: [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], corners: [0, 1, 2, 0, 2, 3] });

const failure = (kind, message) => (error) => {
  assert.ok(error instanceof errors[kind], `${error?.constructor?.name}: ${error?.message}`);
  assert.ok(error instanceof errors.LittoralError && error instanceof Error);
  assert.match(error.message, message);
  return true;
};

test("every kind of surface and method gives what the program gives", async () => {
  assertSameAsProgram(await measured(littoral, { files, cases, queries, regionSources }));
});

test("the module in one piece gives the same", async () => {
  const inline = await import(pathToFileURL(join(dist, "inline.js")).href);
  const other = await inline.open();
  const surface = await other.loadSurface(files["book.obj"], "book.obj");
  assert.equal(surface.counts.faces, 3 * 288);
  other.close();
});

test("a surface says what it is", async () => {
  assert.equal(spot.kind, "triangle mesh");
  assert.deepEqual(spot.counts, { vertices: 2930, faces: 5856, edges: 8784, components: 1 });
  assert.equal(spot.up, "y");
  assert.deepEqual([...spot.triangles], [...spot.corners]);
  assert.deepEqual([...spot.triangleFaces.subarray(0, 3)], [0, 1, 2]);
  assert.deepEqual([...spot.warnings], []);
  assert.equal((await spot.info()).euler_characteristic, 2);
  const quads = await littoral.loadSurface(files["wave.obj"], "wave.obj");
  assert.deepEqual([...quads.triangleFaces.subarray(0, 4)], [0, 0, 1, 1]);
  assert.match(quads.warnings.join(), /100 edges lie on a boundary/);
  const book = await littoral.loadSurface(files["book.obj"], "book.obj");
  assert.match(book.warnings.join(), /12 edges have more than two faces/);
});

test("methods have tables to make forms of", () => {
  assert.ok(littoral.families.length >= 4);
  const [{ methods }] = littoral.families;
  assert.equal(methods[0].name, "auto");
  const heat = methods.find(({ name }) => name === "signed-heat");
  const option = (name) => heat.options.find((o) => o.name === name);
  assert.deepEqual(option("constraint").choices, ["none", "zero-set", "level-sets"]);
  assert.equal(option("preserve-normals").kind, "toggle");
  assert.equal(option("preserve-normals").default, false);
  assert.ok(option("time-scale").kind === "number" && option("time-scale").low === 0 && option("time-scale").high > 0);
  assert.ok(littoral.extensions.surfaces.includes(".obj") && littoral.extensions.volumes.includes(".nrrd"));
  assert.match(littoral.version, /^\d+\.\d+/);
});

test("sources come and go as the text of source files", async () => {
  const sources = {
    curves: [{ nodes: [{ vertex: 1 }, { face: 7, barycentric: [0.25, 0.5, 0.25] }, { vertex: 9 }], closed: true, signed: false }],
    points: [{ vertex: 4 }],
    spaceCurves: [], chains: [],
  };
  const text = await spot.writeSources(sources, "drawn.txt");
  assert.equal(text, "unsigned_curve\nv 1\nf 7 0.25 0.5 0.25\nv 9\nv 1\nunsigned_point\nv 4\n");
  assert.deepEqual(await spot.readSources(await spot.writeSources(sources, "drawn.json"), "drawn.json"), sources);
  const edge = await spot.readSources("unsigned_point\ne 17 0.1\n", "p.txt");
  assert.match(await spot.writeSources(edge, "p.txt"), /^unsigned_point\ne \d+ \d+ 0\.1\n$/);
  const space = { spaceCurves: [{ positions: [0, 0, 0, 1, 0, 1e-7, 1, 1 / 3, 0] }] };
  const again = await spot.readSources(await spot.writeSources(space, "s.json"), "s.json");
  assert.deepEqual([...again.spaceCurves[0].positions], space.spaceCurves[0].positions);
  await assert.rejects(spot.writeSources(space, "s.txt"), failure("UnsupportedError", /\.json does/));
  assert.equal(await square.writeSources({ chains: [[0, 1]] }, "c.txt"), "#offset 0\nc 0 1\n");
});

test("points are joined along the surface", async () => {
  const path = await square.path([{ vertex: 1 }, { vertex: 3 }], false);
  assert.ok(Math.abs(path.length - Math.SQRT2) < 1e-12);
  assert.deepEqual(path.nodes.map((n) => Object.keys(n)[0]), ["vertex", "edge", "vertex"]);
  assert.deepEqual([...path.positions].map((x) => Math.round(x * 1e9) / 1e9), [1, 0, 0, 0.5, 0.5, 0, 0, 1, 0]);
  const ring = await spot.path([{ vertex: 0 }, { vertex: 900 }, { vertex: 1800 }], true);
  assert.deepEqual(ring.nodes[0], ring.nodes.at(-1));
  assert.deepEqual([...await square.locate([{ face: 0, barycentric: [0.5, 0.5, 0] }, { vertex: 2 }])], [0.5, 0, 0, 1, 1, 0]);
});

test("lines, offsets and files of a field", async () => {
  const solver = await square.prepare({ name: "exact" });
  const field = await solver.solve({ points: [{ vertex: 0 }] });
  assert.deepEqual([...field.values], [0, 1, Math.SQRT2, 1]);
  const lines = await square.isolines(field, { spacing: 0.5 });
  assert.deepEqual([...lines.levels], [0.5, 1]);
  assert.equal(lines.offsets.at(-1), lines.positions.length / 3);
  const text = (bytes) => new TextDecoder().decode(bytes);
  assert.equal(text(await square.writeField(field, "d.csv")), `vertex,distance\n0,0\n1,1\n2,${Math.SQRT2}\n3,1\n`);
  assert.match(text(await square.write("s.obj")), /^v 0 0 0\n/);
  assert.match(text(await square.writeLines(lines, "l.obj")), /\nl 1 2/);
  await assert.rejects(square.write("s.xyz"), failure("UnsupportedError", /possible/));
  const curve = { curves: [{ nodes: [{ vertex: 0 }, { vertex: 900 }, { vertex: 1800 }], closed: true }] };
  const around = await (await spot.prepare({ name: "signed-heat" })).offsets(curve, [0.05, -0.05]);
  assert.ok(around.levels.includes(0.05) && around.levels.includes(-0.05));
});

test("space: slices, gradients, volumes, isosurfaces, offsets", async () => {
  const sdf = await spot.signedDistance({ name: "winding" });
  const slice = { origin: [-1, -1, 0], u: [2, 0, 0], v: [0, 2, 0], n: [5, 3] };
  const values = await sdf.slice(slice);
  assert.equal(values.length, 15);
  const here = [-0.5, -1, 0];
  assert.equal((await sdf.at(here))[0], values[1]);
  const { gradients } = await sdf.withGradients(here);
  assert.ok(Math.abs(Math.hypot(...gradients) - 1) < 1e-6);
  const near = await sdf.closest(here);
  assert.ok(Math.abs(Math.abs(values[1]) - near.distances[0]) < 1e-12);
  assert.ok(Math.abs((await sdf.windingNumber([0, 0, 0]))[0] - 1) < 0.01);
  assert.ok((await sdf.confidence([0, 0, 0]))[0] > 0.9);
  const volume = await sdf.sample({ resolution: 24 });
  assert.equal((await volume.values()).length, volume.grid.n[0] * volume.grid.n[1] * volume.grid.n[2]);
  assert.ok(Number.isNaN((await volume.at([99, 0, 0]))[0]));
  assert.equal((await volume.slice(slice)).length, 15);
  const surface = await volume.isosurface();
  assert.ok(surface.counts.faces > 500);
  const [inner, outer] = await volume.offsets([-0.05, 0.05]);
  assert.ok(inner.counts.vertices < outer.counts.vertices);
  const again = await littoral.loadVolume(await volume.write("v.npz"), "v.npz");
  assert.deepEqual(await again.values(), await volume.values());
  const made = await littoral.makeVolume(volume.grid, await volume.values());
  assert.ok(Math.abs((await (await made.signedDistance("distance")).at([0, 0, 0]))[0] - (await volume.at([0, 0, 0]))[0]) < 1e-12);
});

test("a broken surface is repaired, and a shape sampled, as the program does it", async () => {
  const lines = files["spot.obj"].toString().split("\n");
  let faces = 0;
  const broken = lines.filter((line) => !line.startsWith("f ") || ++faces > 40)  // a hole; and then some faces turned round
    .map((line, i) => (line.startsWith("f ") && i % 5 === 0 ? ["f", ...line.split(" ").slice(1).reverse()].join(" ") : line)).join("\n");
  file("broken.obj", broken);
  const surface = await littoral.loadSurface(new TextEncoder().encode(broken), "broken.obj");
  const { surface: made, report } = await surface.repair({ resolution: 32 });
  const run = (...args) => execFileSync(program, [...args, "--quiet"], { cwd: folder, stdio: ["ignore", "ignore", "inherit"] });
  run("repair", "broken.obj", "--resolution", "32", "-o", "repaired.obj");
  const read = (text) => ({ v: [...text.matchAll(/^v (\S+) (\S+) (\S+)/gm)].flatMap((m) => m.slice(1).map(Number)), f: [...text.matchAll(/^f .*$/gm)].map(([f]) => f) });
  const here = read(new TextDecoder().decode(await made.write("repaired.obj"))), there = read(readFileSync(join(folder, "repaired.obj"), "utf8"));
  assert.deepEqual(here.f, there.f);
  assert.ok(there.f.length > 1000 && difference(here.v, there.v) < 1e-9);
  assert.equal(report.status, "converged");
  assert.match(JSON.stringify(await made.info()), /"closed":\s*true/);

  const options = { resolution: 24, surface: 300, space: 300, seed: 7 }, samples = await surface.samples("s.npz", options);
  run("samples", "broken.obj", "--resolution", "24", "--surface", "300", "--space", "300", "--seed", "7", "-o", "s.npz");
  assert.ok(readFileSync(join(folder, "s.npz")).equals(samples.file), "the same bytes");
  assert.deepEqual([samples.surfacePoints.length, samples.distances.length, samples.kinds.length], [900, 300, 300]);
  assert.ok(samples.points.every((x) => Math.abs(x) <= 1) && samples.distances.some((d) => d < 0));
  assert.equal(JSON.parse(samples.card).input, "broken.obj");
  await assert.rejects(surface.samples("s.zarr", options), failure("UnsupportedError", /folder/));
  await assert.rejects(surface.samples("s.npz", { points: 3 }), failure("InputError", /no option 'points'/));
  await assert.rejects(surface.repair({ resolution: 2.5 }), failure("InputError", /whole number/));
  await assert.rejects(surface.repair({ thicken: -1 }), failure("InputError", /thicken/));
});

test("bad input is a typed error with the library's message", async () => {
  const load = (text, name) => littoral.loadSurface(new TextEncoder().encode(text), name);
  await assert.rejects(load("v 0 0\n", "a.obj"), failure("InputError", /a\.obj:1: /));
  await assert.rejects(load("", "dir/a.foo"), failure("InputError", /\.foo.*\.obj/));
  await assert.rejects(load("", ""), failure("InputError", /extension/));
  await assert.rejects(load(obj([[0, 0, 0]], [[0, 1, 2]]), "a.obj"), failure("InputError", /a\.obj:2: /));
  const solver = await spot.prepare({ name: "signed-heat" });
  for (const [sources, message] of [
    [{}, /no sources/],
    [{ points: [{ vertex: 2930 }] }, /points\[0\].*2930/],
    [{ points: [{ vertex: -1 }] }, /points\[0\]/],
    [{ points: [{ vertex: 1.5 }] }, /points\[0\]/],
    [{ points: [{ vertex: 4294967296 }] }, /points\[0\]/],
    [{ points: [{ face: 3, barycentric: [NaN, 0, 1] }] }, /NaN/],
    [{ points: [{ face: 3, barycentric: [2, 0, 1] }] }, /points\[0\]/],
    [{ points: [{ edge: [0, 2929], t: 0.5 }] }, /points\[0\]/],
    [{ points: [{}] }, /a vertex, an edge or a face/],
    [{ curves: [{ nodes: [{ vertex: 0 }] }] }, /at least 2/],
    [{ spaceCurves: [{ positions: [1, 2] }] }, /three coordinates/],
  ]) await assert.rejects(solver.solve(sources), failure("InputError", message));
  await assert.rejects(spot.prepare({ name: "nonsense" }), failure("InputError", /signed-heat/));
  await assert.rejects(spot.prepare({ name: "signed-heat", options: { "time-scale": -1 } }), failure("InputError", /time-scale/));
  await assert.rejects(spot.prepare({ options: { soft: 1 } }), failure("InputError", /soft/));
  const quads = await littoral.loadSurface(files["wave.obj"], "wave.obj");
  await assert.rejects(quads.path([{ vertex: 0 }, { vertex: 5 }]), failure("UnsupportedError", /triangle/));
  await assert.rejects(littoral.makeSurface({ positions: [0, 0, 0, NaN, 0, 0, 1, 1, 0], corners: [0, 1, 2] })
    .then((s) => s.prepare()), failure("InputError", /vertex 1/));
  await assert.rejects(littoral.makeSurface({ positions: [0, 0, 0], corners: [0, 1, 2] }), failure("InputError", /face 0/));
  await assert.rejects(littoral.makeSurface({ positions: [0, 0] }), failure("InputError", /three coordinates/));
  const sdf = await spot.signedDistance();
  await assert.rejects(sdf.at([0, NaN, 0]), failure("InputError", /not finite/));
  await assert.rejects(sdf.sample({ resolution: 1200 }), failure("IoError", /memory/));
  await assert.rejects(square.isolines({ values: [0, 1, 2, 3] }, { spacing: 1e-9 }), failure("InputError", /levels/));
  await assert.rejects(square.isolines({ values: [0, 1] }, [0.5]), failure("InputError", /2 values for 4 vertices/));
});

test("no bytes of any format bring the library down", async () => {
  const corpus = join(root, "fuzz/corpus");
  const volumes = new Set(littoral.extensions.volumes);
  let refused = 0, read = 0;
  for (const extension of readdirSync(corpus)) {
    if (["methods", "tet", "mesh", "vtk", "sources"].includes(extension)) continue;
    for (const seed of readdirSync(join(corpus, extension)).slice(0, 6)) {
      const bytes = readFileSync(join(corpus, extension, seed));
      const flipped = Uint8Array.from(bytes);
      for (let k = 0; k < flipped.length; k += 7) flipped[k] ^= 0x41;
      for (const content of [bytes, bytes.subarray(0, bytes.length >> 1), flipped, new Uint8Array(0)]) {
        const name = `a.${extension}`;
        const made = volumes.has(`.${extension}`) ? littoral.loadVolume(content, name) : littoral.loadSurface(content, name);
        await made.then((thing) => { read += 1; thing.dispose(); }, (error) => {
          refused += 1;
          assert.ok(error instanceof errors.InputError || error instanceof errors.UnsupportedError || error instanceof errors.IoError,
            `${extension}/${seed}: ${error.constructor.name}: ${error.message}`);
        });
      }
    }
  }
  assert.ok(refused > 50 && read > 20, `${refused} refused, ${read} read`);
});

test("counts that no file holds are refused before memory is asked for", async () => {
  const before = await littoral.memory();
  const ply = "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  await assert.rejects(littoral.loadSurface(new TextEncoder().encode(ply), "a.ply"), failure("InputError", /a\.ply/));
  for (const n of [[1e6, 1e6, 1e6], [65536, 65536, 1]]) {
    await assert.rejects(littoral.makeVolume({ n, origin: [0, 0, 0], spacing: [1, 1, 1] }, []), failure("IoError", /memory/));
  }
  // Sizes that are 0 in 32 bits.
  const npy = (shape) => {
    const text = `{'descr': '<f8', 'fortran_order': False, 'shape': (${shape}), }\n`;
    return Uint8Array.from([0x93, ...Buffer.from("NUMPY"), 1, 0, text.length, 0, ...Buffer.from(text)]);
  };
  await assert.rejects(littoral.loadVolume(npy("65536, 65536, 1"), "a.npy"), failure("InputError", /more numbers/));
  await assert.rejects(littoral.loadVolume(npy("4294967296, 1, 1"), "a.npy"), failure("InputError", /more numbers/));
  const nrrd = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 65536 65536 1\nencoding: raw\n\n";
  await assert.rejects(littoral.loadVolume(new TextEncoder().encode(nrrd), "a.nrrd"), failure("InputError", /more than the file holds/));
  const pcd = "VERSION .7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 536870912\nHEIGHT 1\nPOINTS 536870912\nDATA binary\n";
  await assert.rejects(littoral.loadSurface(new TextEncoder().encode(pcd), "a.pcd"), failure("InputError", /promises/));
  assert.ok(await littoral.memory() <= before + 1);
});

test("memory is freed", async () => {
  const round = async () => {
    const surface = await littoral.loadSurface(files["spot.obj"], "spot.obj");
    const solver = await surface.prepare({ name: "signed-heat" });
    await solver.solve({ points: [{ vertex: 3 }] });
    solver.dispose();
    surface.dispose();
  };
  for (let k = 0; k < 3; ++k) await round();
  const before = await littoral.memory();
  for (let k = 0; k < 25; ++k) await round();
  assert.equal(await littoral.memory(), before);
});

test("what was disposed of is refused, and what was made of it is not", async () => {
  const surface = await littoral.loadSurface(files["spot.obj"], "spot.obj");
  const solver = await surface.prepare();
  surface.dispose();
  await assert.rejects(surface.info(), failure("LittoralError", /disposed/));
  assert.ok(Math.abs((await solver.solve({ points: [{ vertex: 3 }] })).values[3]) < 1e-9);
});

for (const shared of [true, false]) {
  test(`a call is cancelled ${shared ? "by a flag" : "by ending the worker"}, and the next one works`, async () => {
    const kept = globalThis.SharedArrayBuffer;
    if (!shared) globalThis.SharedArrayBuffer = undefined;
    try {
      const own = await open();
      const surface = await own.loadSurface(files["spot.obj"], "spot.obj");
      const solver = await surface.prepare({ name: "signed-heat" });
      const sdf = await surface.signedDistance();
      const [first] = await sdf.at([0, 0, 0]);
      const stop = new AbortController();
      const began = Date.now();
      let aborted = 0;
      const long = sdf.sample({ resolution: 400 }, {
        signal: stop.signal,
        onProgress: () => { if (!aborted) { aborted = Date.now(); stop.abort(); } },
      });
      const waiting = new AbortController();
      const queued = solver.solve({ points: [{ vertex: 3 }] }, { signal: waiting.signal });
      waiting.abort();
      await assert.rejects(queued, failure("Cancelled", /cancelled/));
      await assert.rejects(long, failure("Cancelled", /cancelled/));
      assert.ok(Date.now() - aborted < 2000, `${Date.now() - aborted} ms after ${aborted - began}`);
      assert.equal((await sdf.at([0, 0, 0]))[0], first);
      assert.ok(Math.abs((await solver.solve({ points: [{ vertex: 3 }] })).values[3]) < 1e-9);
      await assert.rejects(surface.info({ signal: AbortSignal.abort() }), failure("Cancelled", /cancelled/));
      own.close();
      await assert.rejects(surface.info(), failure("InternalError", /closed/));
    } finally {
      globalThis.SharedArrayBuffer = kept;
    }
  });
}

for (const page of ["docs/guides/web.md", "web/package/README.md"]) {
  test(`the code of ${page} runs`, async () => {
    const text = readFileSync(join(root, page), "utf8");
    const code = [...text.matchAll(/```js\n([\s\S]*?)```/g)].map((match) => match[1]).join("\n");
    const url = JSON.stringify(pathToFileURL(join(dist, "littoral.js")).href);
    const body = code.replace(/^import (.*) from "littoral";$/m, `const $1 = await import(${url});`);
    const AsyncFunction = (async () => {}).constructor;
    await new AsyncFunction("bytes", "jersey", `${body}\nlittoral.close();`)(files["spot.obj"], regionSources.text);
  });
}
