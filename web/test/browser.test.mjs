// The package in Chromium, from disk: one page without an outside reference.
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { openPage } from "../../viewer/test/browser.mjs";
import { assertSameAsProgram } from "./compare.mjs";
import { cases, file, files, folder, queries, regionSources, root } from "./inputs.mjs";
import { measured } from "./measured.mjs";

const dist = process.env.DIST ?? join(root, "dist");
const esbuild = createRequire(join(process.env.TOOLS ?? join(root, "build/web/node_modules"), "any.js"))("esbuild");

test("a page from disk gives what the program gives, and asks for nothing", async () => {
  const bundle = await esbuild.build({
    stdin: { contents: `import * as littoral from ${JSON.stringify(join(dist, "inline.js"))}; window.littoralPackage = littoral;`, resolveDir: dist },
    bundle: true, write: false, format: "iife", external: ["node:*"], logLevel: "warning",
  });
  file("page.html", `<!doctype html><meta charset="utf-8"><title>littoral</title><script>${bundle.outputFiles[0].text.replaceAll("</script", "<\\/script")}</script>`);
  const url = pathToFileURL(join(folder, "page.html")).href;
  const { page, errors, requests, close } = await openPage(url);
  try {
    await page.evaluate(`window.measured = ${measured.toString()}`);
    const asArrays = Object.fromEntries(Object.entries(files).map(([name, content]) => [name, [...Buffer.from(content)]]));
    const found = await page.evaluate(async (inputs) => {
      window.littoral = await window.littoralPackage.open();
      return window.measured(window.littoral, inputs);
    }, { files: asArrays, cases, queries, regionSources });
    assertSameAsProgram(found);
    // Without memory that is shared, cancelling ends the worker; what it held is made again.
    const after = await page.evaluate(async ({ spot }) => {
      const { littoral, littoralPackage } = window;
      const surface = await littoral.loadSurface(Uint8Array.from(spot), "spot.obj");
      const sdf = await surface.signedDistance();
      const [before] = await sdf.at([0, 0, 0]);
      const stop = new AbortController();
      const error = await sdf.sample({ resolution: 400 }, { signal: stop.signal, onProgress: () => stop.abort() }).catch((e) => e);
      const bad = await surface.prepare({ name: "nonsense" }).catch((e) => e);
      return {
        isolated: window.crossOriginIsolated, cancelled: error instanceof littoralPackage.Cancelled,
        input: bad instanceof littoralPackage.InputError, same: before === (await sdf.at([0, 0, 0]))[0],
      };
    }, { spot: asArrays["spot.obj"] });
    assert.deepEqual(after, { isolated: false, cancelled: true, input: true, same: true });
    assert.deepEqual(errors, []);
    assert.deepEqual(requests.filter((r) => !r.startsWith("blob:") && !r.startsWith("data:")), [url]);
  } finally {
    await close();
  }
});
