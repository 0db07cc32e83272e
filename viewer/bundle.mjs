// How modules of src/ are bundled: tables (.inc) as text, and "worker:FILE" as the text of a bundle.
import { dirname, join } from "node:path";

export function bundleOptions(esbuild) {
  const options = {
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: "es2022",
    charset: "ascii",
    legalComments: "inline",
    logLevel: "warning",
    loader: { ".inc": "text", ".css": "text" },
  };
  const workers = {
    name: "workers",
    setup(build) {
      build.onResolve({ filter: /^worker:/ }, ({ path, importer }) => ({
        path: join(dirname(importer), path.slice("worker:".length)), namespace: "worker",
      }));
      build.onLoad({ filter: /.*/, namespace: "worker" }, async ({ path }) => {
        const { outputFiles } = await esbuild.build({ ...options, entryPoints: [path], nodePaths: build.initialOptions.nodePaths });
        return { contents: outputFiles[0].text, loader: "text" };
      });
    },
  };
  return { ...options, plugins: [workers] };
}
