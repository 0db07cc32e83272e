// node build.mjs OUT LITTORAL: bundles src/ and the library into OUT/studio.html, one file that asks
// for nothing. LITTORAL is the module `littoral/inline` (web/package built by `make web`).
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateRawSync } from "node:zlib";
import * as esbuild from "esbuild";
import { bundleOptions } from "../../viewer/bundle.mjs";

const here = dirname(fileURLToPath(import.meta.url)), root = resolve(here, "../..");
const out = resolve(process.argv[2] ?? join(root, "dist"));
const library = resolve(process.argv[3] ?? join(root, "dist/inline.js"));

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
  nodePaths: [join(here, "node_modules")], // modules of viewer/src find three here
  plugins: [...options.plugins, packed],
});
// Inside a script element a closing tag would end it; strings may hold it escaped.
const script = bundle.outputFiles[0].text.replace(/<\/script/gi, "<\\/script").replace(/<!--/g, "<\\!--");
const put = (page, mark, text) => page.replace(mark, () => text); // no $ patterns in text
let page = readFileSync(join(here, "src/page.html"), "utf8");
page = put(page, "/*STYLE*/", readFileSync(join(here, "src/style.css"), "utf8"));
page = put(page, "/*SCRIPT*/", script);
mkdirSync(out, { recursive: true });
writeFileSync(join(out, "studio.html"), page);
console.log(`${join(out, "studio.html")}: ${(Buffer.byteLength(page) / 1e6).toFixed(2)} MB`);
