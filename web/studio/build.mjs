// node build.mjs OUT LITTORAL: bundles src/ and the library into OUT/studio.html, one file that asks
// for nothing. LITTORAL is the module `littoral/inline` (web/package built by `make web`).
// node build.mjs OUT native NODE_MODULES: the page of `littoral view --edit`, which computes in the
// program that serves it, also as C++ string literals in OUT/studio_page.cpp.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateRawSync } from "node:zlib";
import { bundleOptions } from "../../viewer/bundle.mjs";
import { asSource } from "../../viewer/literals.mjs";

const here = dirname(fileURLToPath(import.meta.url)), root = resolve(here, "../..");
const out = resolve(process.argv[2] ?? join(root, "dist"));
const native = process.argv[3] === "native";
const library = native ? join(root, "web/src/native.ts") : resolve(process.argv[3] ?? join(root, "dist/inline.js"));
const modules = resolve(process.argv[4] ?? join(here, "node_modules"));
const esbuild = createRequire(join(modules, "any.js"))("esbuild");
const policy = "default-src 'none'; style-src 'unsafe-inline'; img-src data: blob:; " + (native
  ? "script-src 'unsafe-inline'; connect-src 'self'"
  : "script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob:");

const packed = {
  name: "packed",
  setup(plugins) {
    plugins.onResolve({ filter: /^packed:/ }, ({ path }) => ({ path: path.slice(7), namespace: "packed" }));
    plugins.onLoad({ filter: /.*/, namespace: "packed" }, ({ path }) => ({
      contents: deflateRawSync(readFileSync(join(root, path)), { level: 9 }).toString("base64"),
      loader: "text",
    }));
  },
};

const options = bundleOptions(esbuild);
const bundle = await esbuild.build({
  ...options,
  entryPoints: [join(here, "src/main.ts")],
  external: ["node:*"], // what the library would use in Node
  alias: { "littoral/inline": library },
  nodePaths: [modules], // modules of viewer/src find three here
  plugins: [...options.plugins, packed],
});
// Inside a script element a closing tag would end it; strings may hold it escaped.
const script = bundle.outputFiles[0].text.replace(/<\/script/gi, "<\\/script").replace(/<!--/g, "<\\!--");
const put = (page, mark, text) => page.replace(mark, () => text); // no $ patterns in text
let page = readFileSync(join(here, "src/page.html"), "utf8");
page = put(page, "CONTENT_POLICY", policy);
page = put(page, "/*STYLE*/", readFileSync(join(here, "src/style.css"), "utf8"));
page = put(page, "/*SCRIPT*/", script);
mkdirSync(out, { recursive: true });
writeFileSync(join(out, "studio.html"), page);
if (native) {
  const declared = { header: "cli/studio_page.h", namespace: "littoral::cli", name: "studio_page" };
  writeFileSync(join(out, "studio_page.cpp"), asSource(page, declared));
}
console.log(`${join(out, "studio.html")}: ${(Buffer.byteLength(page) / 1e6).toFixed(2)} MB`);
