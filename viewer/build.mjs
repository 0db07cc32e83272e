// node build.mjs OUT [NODE_MODULES]: bundles src/ into OUT/page.html, one file without any outside
// reference, and writes it as C++ string literals to OUT/page_template.cpp.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { bundleOptions } from "./bundle.mjs";
import { asSource } from "./literals.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const out = resolve(process.argv[2] ?? "dist");
const modules = resolve(process.argv[3] ?? join(here, "node_modules"));
const esbuild = createRequire(join(modules, "any.js"))("esbuild");

const bundle = await esbuild.build({
  ...bundleOptions(esbuild),
  entryPoints: [join(here, "src/main.ts")],
  nodePaths: [modules],
});
const script = bundle.outputFiles[0].text;
if (/<\/script/i.test(script)) throw new Error("the bundle would end its own script element");
const style = readFileSync(join(here, "src/style.css"), "utf8");
const put = (page, mark, text) => page.replace(mark, () => text); // no $ patterns in text
let page = readFileSync(join(here, "src/page.html"), "utf8");
page = put(page, "/*STYLE*/", style);
page = put(page, "/*SCRIPT*/", script);

mkdirSync(out, { recursive: true });
writeFileSync(join(out, "page.html"), page);
writeFileSync(join(out, "page_template.cpp"),
              asSource(page, { header: "io/page/page_template.h", namespace: "littoral::io", name: "page_template" }));
