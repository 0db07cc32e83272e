// node build.mjs OUT [NODE_MODULES]: bundles src/ into OUT/page.html, one file without any outside
// reference, and writes it as C++ string literals to OUT/page_template.cpp.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { bundleOptions } from "./bundle.mjs";

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

// Literals of at most 8 kB, which every compiler joins; bytes beyond ASCII as octal escapes.
const bytes = Buffer.from(page, "utf8");
const pieces = [];
for (let at = 0; at < bytes.length; at += 8000) {
  let text = "";
  for (const byte of bytes.subarray(at, at + 8000)) {
    const c = String.fromCharCode(byte);
    if (c === "\n") text += "\\n";
    else if (c === "\\" || c === '"') text += "\\" + c;
    else if (c === "?" || byte < 32 || byte > 126) text += "\\" + byte.toString(8).padStart(3, "0");
    else text += c;
  }
  pieces.push(`    "${text}"`);
}
mkdirSync(out, { recursive: true });
writeFileSync(join(out, "page.html"), page);
writeFileSync(
  join(out, "page_template.cpp"),
  `#include "io/page/page_template.h"

namespace littoral::io {

namespace {
constexpr char text[] =
${pieces.join("\n")};
}  // namespace

std::string_view page_template() { return {text, sizeof text - 1}; }

}  // namespace littoral::io
`,
);
