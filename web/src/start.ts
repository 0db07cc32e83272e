// Workers of browsers and of Node.
import { errorOf, InternalError } from "./errors";
import type { RunningWorker } from "./process";
import type { Start } from "./protocol";

/** A worker before it has the library. */
export interface BareWorker extends Omit<RunningWorker, "post"> {
  post(message: Start | Parameters<RunningWorker["post"]>[0]): void;
}

/** Starts workers with the library in them; its module is compiled once. */
export function withLibrary(wasm: () => Promise<WebAssembly.Module>, bare: () => Promise<BareWorker>): () => Promise<RunningWorker> {
  let compiled: Promise<WebAssembly.Module> | null = null;
  return async () => {
    try {
      compiled ??= wasm();
      const [module, worker] = await Promise.all([compiled, bare()]);
      await new Promise<void>((resolve, reject) => {
        worker.onError((what) => reject(new InternalError(`the worker does not start: ${what}`)));
        worker.onMessage((reply) => ("error" in reply ? reject(errorOf(reply)) : resolve()));
        worker.post({ start: module });
      });
      return worker;
    } catch (error) {
      compiled = null;
      throw error;
    }
  };
}

export const inNode = typeof process === "object" && typeof process.versions?.node === "string";

export function browserWorker(address: string | URL): BareWorker {
  const worker = new Worker(address);
  return {
    post: (message) => worker.postMessage(message),
    onMessage: (hear) => { worker.onmessage = (event) => hear(event.data as never); },
    onError: (hear) => { worker.onerror = (event) => hear(event.message ?? "its code did not load"); },
    end: () => worker.terminate(),
  };
}

/** From a file, or from code itself. */
export async function nodeWorker(code: string | URL, isCode: boolean): Promise<BareWorker> {
  const { Worker } = await import("node:worker_threads");
  const worker = new Worker(code, { eval: isCode });
  worker.unref(); // a program may end while a worker waits; a call under way keeps it
  let hear: ((reply: never) => void) | null = null;
  worker.on("message", (reply) => {
    if (!("progress" in reply)) worker.unref();
    hear?.(reply as never);
  });
  return {
    post: (message) => {
      if (!("op" in message) || message.op !== "") worker.ref();
      worker.postMessage(message);
    },
    onMessage: (listener) => { hear = listener as never; },
    onError: (listener) => {
      worker.removeAllListeners("error").removeAllListeners("exit");
      worker.on("error", (error) => listener(String(error)));
      worker.on("exit", () => listener("it stopped"));
    },
    end: () => void worker.terminate(),
  };
}
