// Surfaces of every kind, what is measured on them, and the program that says what is right.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateSync } from "node:zlib";

export const root = fileURLToPath(new URL("../../", import.meta.url));
export const program = process.env.LITTORAL ?? join(root, "build/release/littoral");
export const folder = mkdtempSync(join(tmpdir(), "littoral-web-"));
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));

/** A file's bytes in the folder of the tests. */
export function file(name, content) {
  writeFileSync(join(folder, name), content);
  return name;
}

/** Vertices and faces, counted from 0, as an OBJ file. */
export const obj = (points, faces) => [
  ...points.map((p) => `v ${p.join(" ")}`),
  ...faces.map((f) => `f ${f.map((v) => v + 1).join(" ")}`),
].join("\n") + "\n";

/** A strip of squares, rows x columns, placed by a function of two numbers. */
function grid(rows, columns, place, before = 0) {
  const points = [], faces = [];
  for (let j = 0; j <= rows; ++j) for (let i = 0; i <= columns; ++i) points.push(place(i / columns, j / rows));
  for (let j = 0; j < rows; ++j) {
    for (let i = 0; i < columns; ++i) {
      const a = before + i + j * (columns + 1);
      faces.push([a, a + 1, a + columns + 2, a + columns + 1]);
    }
  }
  return { points, faces };
}

/** Three pages that meet at one edge, each vertex of which is one. */
function book() {
  const points = [], faces = [], number = new Map();
  for (let page = 0; page < 3; ++page) {
    const angle = (2 * Math.PI * page) / 3;
    const sheet = grid(12, 12, (s, t) => [s * Math.cos(angle), s * Math.sin(angle), t]);
    const here = sheet.points.map((p) => {
      const key = p.map((x) => x.toFixed(9)).join();
      if (!number.has(key)) number.set(key, points.push(p) - 1);
      return number.get(key);
    });
    for (const face of sheet.faces) {
      const [a, b, c, d] = face.map((v) => here[v]);
      faces.push([a, b, c], [a, c, d]);
    }
  }
  return obj(points, faces);
}

const spot = readFileSync(join(root, "examples/data/spot.obj"));
const jersey = readFileSync(join(root, "examples/data/spot-jersey.txt"), "utf8");
const wave = grid(20, 30, (s, t) => [s, t, 0.1 * Math.sin(7 * s) * Math.cos(5 * t)]);
const sphere = Array.from({ length: 600 }, (_, i) => {
  const z = 1 - (2 * i + 1) / 600, a = i * 2.399963229728653, r = Math.sqrt(1 - z * z);
  return [r * Math.cos(a), r * Math.sin(a), z];
});
const ball = Buffer.alloc(24 ** 3);
for (let at = 0; at < ball.length; ++at) {
  const d = [at % 24, Math.floor(at / 24) % 24, Math.floor(at / 576)].map((x) => x - 11.5);
  ball[at] = d[0] ** 2 + d[1] ** 2 + d[2] ** 2 < 81 ? 1 : 0;
}
const header = Buffer.from("X: 24\nY: 24\nZ: 24\nVoxel-Size: 1\nInt-Endian: 0123\nVersion: 3\n.\n");

export const files = {
  "spot.obj": spot,
  "wave.obj": obj(wave.points, wave.faces),
  "book.obj": book(),
  "sphere.xyz": sphere.map((p) => [...p, ...p].join(" ")).join("\n") + "\n",
  "ball.vol": Buffer.concat([header, deflateSync(ball)]),
};
for (const name of Object.keys(files)) {
  files[name] = Buffer.from(files[name]);
  file(name, files[name]);
}

const through = (...vertices) => `signed_curve\n${vertices.map((v) => `v ${v}`).join("\n")}\n`;
const broken = through(3, 40, 90) + through(200, 240);

/** What is measured: a surface, the text of its sources, a method. */
export const cases = [
  ["spot.obj", jersey, "signed-heat"],
  ["spot.obj", jersey, "auto"],
  ["spot.obj", "unsigned_point\nv 100\nf 20 0.1 0.2 0.7\n", "unsigned-heat"],
  ["spot.obj", "unsigned_point\nv 100\nf 20 0.1 0.2 0.7\n", "exact"],
  ["spot.obj", jersey, "signed-heat", { discontinuous: true }],
  ["wave.obj", through(10, 11, 42, 73), "signed-heat"],
  ["book.obj", broken, "auto"],
  ["book.obj", through(7, 20, 33), "signed-heat"],
  ["sphere.xyz", "unsigned_point\nv 5\nv 77\n", "unsigned-heat"],
  ["ball.vol", "unsigned_point\nv 5\n", "unsigned-heat"],
].map(([surface, sources, method, options = {}], k) => ({ surface, sources, method, options, name: `sources${k}.txt` }));
for (const { name, sources } of cases) file(name, sources);

/** Points about Spot. */
export const queries = Array.from({ length: 60 }, (_, i) => [Math.sin(i), 0.9 * Math.cos(1.7 * i), Math.sin(2.3 * i + 1)]);
export const regionSources = { surface: "spot.obj", name: "regions.txt", text: jersey };
file(regionSources.name, regionSources.text);
file("queries.csv", "x,y,z\n" + queries.map((q) => q.join()).join("\n") + "\n");

/** The values of a .npy file of doubles or integers. */
function npy(path) {
  const bytes = readFileSync(path);
  const length = bytes[6] === 1 ? bytes.readUInt16LE(8) : bytes.readUInt32LE(8);
  const begin = (bytes[6] === 1 ? 10 : 12) + length;
  const kind = /'descr': '([^']+)'/.exec(bytes.toString("latin1", 0, begin))[1];
  if (kind !== "<f8") throw new Error(`${path} holds ${kind}`);
  return Array.from(new Float64Array(bytes.buffer.slice(bytes.byteOffset + begin, bytes.byteOffset + bytes.length)));
}

/** Runs the program in the folder of the tests, and reads what it wrote. */
export function native(...args) {
  execFileSync(program, [...args, "-o", "out.npy", "--quiet"], { cwd: folder, stdio: ["ignore", "ignore", "inherit"] });
  return npy(join(folder, "out.npy"));
}
export const nativeDistance = ({ surface, name, method, options }) => native("distance", surface, "-s", name, "--method", method,
  ...Object.entries(options).map(([key, value]) => (value === true ? `--${key}` : `--${key}=${value}`)));
