// Workers of browsers and of Node.
import type { RunningWorker } from "./process";

export const inNode = typeof process === "object" && typeof process.versions?.node === "string";

export function browserWorker(address: string | URL): RunningWorker {
  const worker = new Worker(address);
  return {
    post: (message) => worker.postMessage(message),
    onMessage: (hear) => { worker.onmessage = (event) => hear(event.data as never); },
    onError: (hear) => { worker.onerror = (event) => hear(event.message ?? "its code did not load"); },
    end: () => worker.terminate(),
  };
}

/** From a file, or from code itself. */
export async function nodeWorker(code: string | URL, isCode: boolean): Promise<RunningWorker> {
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
