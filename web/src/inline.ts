// The package as one module, for a page that is opened from disk: nothing is fetched.
import wasm from "littoral:wasm";
import worker from "littoral:worker";
import type * as api from "../package/littoral";
import { Client, openWith } from "./client";
import { browserWorker, inNode, nodeWorker, withLibrary } from "./start";

export * from "./errors";

async function unpacked(base64: string): Promise<ArrayBuffer> {
  const packed = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return await new Response(stream).arrayBuffer();
}

/** The address of the worker's code is kept: more workers may be started. */
let address: string | undefined;

export function open(): Promise<api.Littoral> {
  return openWith(withLibrary(async () => WebAssembly.compile(await unpacked(wasm)), async () => {
    if (inNode) return nodeWorker(worker, true);
    address ??= URL.createObjectURL(new Blob([worker], { type: "text/javascript" }));
    return browserWorker(address);
  }), Client);
}
