// The worker: starts the library, does what it is asked, hands arrays over without copying them.
import createLibrary from "littoral:library";
import { Failed, type Library, type Native, operationsOn, type Watch } from "./operations";
import type { Handle, Reply, Request, Start } from "./protocol";

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

const isHandle = (arg: unknown): arg is Handle =>
  typeof arg === "object" && arg !== null && "handle" in arg;

class Desk {
  private readonly objects = new Map<number, Native>();
  private readonly operations;

  constructor(library: Library, private readonly port: Port) {
    this.operations = operationsOn(library);
  }

  answer(request: Request): void {
    for (const number of request.free) {
      this.objects.get(number)?.delete();
      this.objects.delete(number);
    }
    if (request.op === "") return;
    let reply: Reply;
    try {
      reply = { value: this.done(request) };
    } catch (error) {
      // What is no answer of the library is a trap of WebAssembly, after which nothing is certain.
      reply = error instanceof Failed ? error.failure
        : { error: "InternalError", message: `the library failed: ${String(error)}`, fatal: true };
    }
    this.port.post(reply, "value" in reply ? [...buffersIn(reply.value)] : []);
  }

  private done({ op, args, as, progress, flag }: Request): unknown {
    const stop = () => flag !== null && Atomics.load(flag, 0) !== 0;
    if (stop()) throw new Failed({ error: "Cancelled", message: "cancelled" });
    const watch: Watch = !progress && !flag ? undefined : (fraction, stage) => {
      if (progress) this.port.post({ progress: fraction, stage }, []);
      return stop();
    };
    const operation = this.operations[op as keyof typeof this.operations] as
      (watch: Watch, ...args: unknown[]) => { made: Native[]; value: unknown };
    const { made, value } = operation(watch, ...args.map((arg) => (isHandle(arg) ? this.object(arg) : arg)));
    made.forEach((object, k) => this.objects.set(as[k], object));
    return value;
  }

  private object({ handle }: Handle): Native {
    const object = this.objects.get(handle);
    if (!object) throw new Error(`there is no object ${handle}`);
    return object;
  }
}

async function serve(): Promise<void> {
  const port = await openPort();
  let desk: Desk | undefined;
  port.listen(async (message) => {
    if (!("start" in message)) return desk?.answer(message);
    try {
      desk = new Desk(await createLibrary({
        instantiateWasm: (imports, use) => {
          void WebAssembly.instantiate(message.start, imports).then((instance) => use(instance));
          return {};
        },
      }), port);
      port.post({ value: null }, []);
    } catch (error) {
      port.post({ error: "InternalError", message: `the library does not start: ${String(error)}`, fatal: true }, []);
    }
  });
}

void serve();
