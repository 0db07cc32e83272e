// The package with its parts in files beside it.
import type * as api from "../package/littoral";
import { Client, openWith } from "./client";
import { browserWorker, inNode, nodeWorker, withLibrary } from "./start";

export * from "./errors";

async function bytesAt(address: string | URL): Promise<BufferSource> {
  const url = new URL(address, import.meta.url);
  if (inNode && url.protocol === "file:") {
    const { readFile } = await import("node:fs/promises");
    return Uint8Array.from(await readFile(url));
  }
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`${url.href}: ${answer.status} ${answer.statusText}`);
  return await answer.arrayBuffer();
}

export function open(options: api.OpenOptions = {}): Promise<api.Littoral> {
  const wasm = options.wasm ?? new URL("./littoral.wasm", import.meta.url);
  const worker = options.worker ?? new URL("./worker.js", import.meta.url);
  return openWith(withLibrary(
    async () => WebAssembly.compile(await bytesAt(wasm)),
    async () => inNode ? nodeWorker(new URL(worker, import.meta.url), false) : browserWorker(worker)), Client);
}
