// The worker: starts the library, hands it what it is asked, and arrays over without copying them.
import createLibrary from "littoral:library";
import { decode, encode } from "./message";
import type { Reply, Request, Start } from "./protocol";

interface Port {
  post(message: Reply, transfer: ArrayBuffer[]): void;
  listen(hear: (message: Start | Request) => void): void;
}

async function openPort(): Promise<Port> {
  if (typeof self === "object" && typeof self.postMessage === "function") {
    return {
      post: (message, transfer) => self.postMessage(message, { transfer }),
      listen: (hear) => self.addEventListener("message", (event) => hear(event.data as Start | Request)),
    };
  }
  const { parentPort } = await import("node:worker_threads");
  if (!parentPort) throw new Error("this file is the code of a worker");
  return {
    post: (message, transfer) => parentPort.postMessage(message, transfer),
    listen: (hear) => void parentPort.on("message", hear),
  };
}

/** The buffers of all arrays in a value: they are nobody else's. */
function buffersIn(value: unknown, found = new Set<ArrayBuffer>()): Set<ArrayBuffer> {
  if (ArrayBuffer.isView(value)) found.add(value.buffer as ArrayBuffer);
  else if (value && typeof value === "object") {
    for (const part of Object.values(value)) buffersIn(part, found);
  }
  return found;
}

type Library = Awaited<ReturnType<typeof createLibrary>>;

function replyTo(library: Library, { op, args, as, free, progress, flag }: Request, port: Port): Reply {
  const stop = () => flag !== null && Atomics.load(flag, 0) !== 0;
  if (op === "memory") return { value: library.HEAPU8.length / 2 ** 20 };
  if (stop()) return { error: "Cancelled", message: "cancelled" };
  const watch = !progress && !flag ? undefined : (fraction: number, stage: string) => {
    if (progress) port.post({ progress: fraction, stage }, []);
    return stop();
  };
  try {
    return decode(library.answer(encode({ op, args, as, free }), watch)) as Reply;
  } catch (error) {
    // What is no answer of the library is a trap of WebAssembly, after which nothing is certain.
    return { error: "InternalError", message: `the library failed: ${String(error)}`, fatal: true };
  }
}

async function serve(): Promise<void> {
  const port = await openPort();
  let library: Library | undefined;
  port.listen(async (message) => {
    if (!("start" in message)) {
      if (!library) return;
      const reply = replyTo(library, message, port);
      if (message.op !== "") port.post(reply, "value" in reply ? [...buffersIn(reply.value)] : []);
      return;
    }
    try {
      library = await createLibrary({
        instantiateWasm: (imports, use) => {
          void WebAssembly.instantiate(message.start, imports).then((instance) => use(instance));
          return {};
        },
      });
      port.post({ value: null }, []);
    } catch (error) {
      port.post({ error: "InternalError", message: `the library does not start: ${String(error)}`, fatal: true }, []);
    }
  });
}

void serve();
