// node build.mjs BUILD DIST: checks the TypeScript of src/, bundles it with the WebAssembly module in
// BUILD/web, and lays out the npm package in DIST. BUILD/node_modules holds the tools.
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const here = dirname(fileURLToPath(import.meta.url));
const build = resolve(process.argv[2]), dist = resolve(process.argv[3]);
const modules = join(build, "node_modules");
const library = join(build, "web/littoral_wasm.js"), wasm = join(build, "web/littoral_wasm.wasm");
const tools = createRequire(join(modules, "any.js"));
const esbuild = tools("esbuild");

try {
  execFileSync(process.execPath, [tools.resolve("typescript/bin/tsc"), "-p", here, "--typeRoots", join(modules, "@types")],
               { stdio: ["ignore", "pipe", "inherit"] });
} catch (error) {
  console.error(String(error.stdout ?? error));
  process.exit(1);
}

/** What the sources import by a name that begins with "littoral:". */
const provided = (texts) => ({
  name: "littoral",
  setup(bundle) {
    bundle.onResolve({ filter: /^littoral:/ }, ({ path }) =>
      path === "littoral:library" ? { path: library } : { path, namespace: "text" });
    bundle.onLoad({ filter: /.*/, namespace: "text" }, ({ path }) => ({ contents: texts[path], loader: "text" }));
  },
});

async function bundled(entry, format, texts = {}) {
  const made = await esbuild.build({
    entryPoints: [join(here, "src", entry)],
    bundle: true,
    minify: true,
    keepNames: true,
    write: false,
    format,
    target: "es2022",
    charset: "ascii",
    legalComments: "inline",
    external: ["node:*"],
    plugins: [provided(texts)],
    logLevel: "warning",
  });
  return made.outputFiles[0].text;
}

const worker = await bundled("worker.ts", "iife");
const bytes = readFileSync(wasm);
const texts = { "littoral:worker": worker, "littoral:wasm": gzipSync(bytes, { level: 9 }).toString("base64") };

rmSync(dist, { recursive: true, force: true });
mkdirSync(dist, { recursive: true });
const put = (name, text) => writeFileSync(join(dist, name), text);
put("worker.js", worker);
put("littoral.wasm", bytes);
put("littoral.js", await bundled("index.ts", "esm"));
put("inline.js", await bundled("inline.ts", "esm", texts));
for (const name of ["littoral.d.ts", "errors.d.ts", "space.d.ts", "inline.d.ts", "README.md"]) copyFileSync(join(here, "package", name), join(dist, name));
copyFileSync(join(here, "../LICENSE"), join(dist, "LICENSE"));
const { version } = JSON.parse(readFileSync(join(here, "package.json"), "utf8"));
const manifest = JSON.parse(readFileSync(join(here, "package/package.json"), "utf8"));
put("package.json", JSON.stringify({ ...manifest, version }, null, 2) + "\n");

for (const name of ["littoral.wasm", "worker.js", "littoral.js", "inline.js"]) {
  const size = statSync(join(dist, name)).size, packed = gzipSync(readFileSync(join(dist, name)), { level: 9 }).length;
  console.log(`${name.padEnd(14)} ${(size / 1e6).toFixed(2)} MB, ${(packed / 1e6).toFixed(2)} MB packed by gzip`);
}
