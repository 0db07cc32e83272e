// node latency.mjs LITTORAL.JS [TRIANGLES ...]: processor time until something is shown of a curve that has changed: nodes
// joined along the surface, and each answer that the studio shows (src/engine.ts), by WebAssembly, prepared.
import { pathToFileURL } from "node:url";
import { resolve } from "node:path";

const littoral = await (await import(pathToFileURL(resolve(process.argv[2])).href)).open();
const wanted = process.argv.length > 3 ? process.argv.slice(3).map(Number) : [50000, 200000];

/** A torus with bumps. */
function bumpy(count) {
  const n = Math.round(Math.sqrt(count / 4)), m = 2 * n, lines = [];
  for (let i = 0; i < m; ++i) for (let j = 0; j < n; ++j) {
    const a = (2 * Math.PI * i) / m, b = (2 * Math.PI * j) / n, s = 0.4 * (1 + 0.15 * Math.cos(7 * a + 3 * b)), r = 1 + s * Math.cos(b);
    lines.push(`v ${r * Math.cos(a)} ${r * Math.sin(a)} ${s * Math.sin(b)}`);
  }
  const at = (i, j) => (i % m) * n + (j % n) + 1;
  for (let i = 0; i < m; ++i) for (let j = 0; j < n; ++j)
    lines.push(`f ${at(i, j)} ${at(i + 1, j)} ${at(i + 1, j + 1)}`, `f ${at(i, j)} ${at(i + 1, j + 1)} ${at(i, j + 1)}`);
  const nodes = (turn) => Array.from({ length: 12 }, (_, k) => {
    const a = 0.15 + turn + 0.1 * Math.cos((2 * Math.PI * k) / 12), b = 0.2 + 0.15 * Math.sin((2 * Math.PI * k) / 12);
    return { vertex: at(Math.round(m * a), Math.round(n * b)) - 1 };
  });
  return { text: lines.join("\n"), nodes };
}

async function spent(act, times = 5) {
  const all = [];
  for (let i = 0; i < times; ++i) {
    const { user, system } = process.cpuUsage();
    await act(i);
    const now = process.cpuUsage();
    all.push((now.user + now.system - user - system) / 1000);
  }
  return all.sort((a, b) => a - b)[times >> 1];
}

const methods = [
  ["fast-marching", { name: "fast-marching" }],
  ["auto, metric fast-marching", { name: "auto", options: { metric: "fast-marching" } }],
  ["auto", { name: "auto" }],
];
for (const count of wanted) {
  const { text, nodes } = bumpy(count), surface = await littoral.loadSurface(text, "torus.obj");
  console.log(`${surface.counts.faces} triangles [ms]`);
  console.log(`  nodes joined: ${(await spent((i) => surface.path(nodes(0.002 * i)))).toFixed(0)}`);
  for (const [name, method] of methods) for (const closed of [true, false]) {
    if (closed && name === "fast-marching") continue; // no preview of these
    const solver = await surface.prepare(method), solve = (i) => solver.solve({ curves: [{ nodes: nodes(0.002 * i), closed }] });
    const first = await spent(() => solve(-1), 1), next = await spent(solve, name === "auto" ? 1 : 5);
    console.log(`  ${closed ? "closed" : "open"} curve, ${name}: ${next.toFixed(0)}, the first ${first.toFixed(0)}`);
    solver.dispose();
  }
  surface.dispose();
}
littoral.close();
