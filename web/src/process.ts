// A worker that is started when it is needed, does one call after the other, and is replaced where it
// had to be ended.
import { Cancelled, errorOf, InternalError, LittoralError } from "./errors";
import type { Reply, Request } from "./protocol";

/** Who does the work: a worker of a browser or of Node, or a program on this machine. */
export interface RunningWorker {
  post(message: Request): void;
  onMessage(hear: (reply: Reply) => void): void;
  onError(hear: (what: string) => void): void;
  /** Stops the call under way, which answers all the same. Without it the worker is ended. */
  cancel?(): void;
  end(): void;
}

export interface Call {
  signal?: AbortSignal;
  onProgress?: (fraction: number, stage: string) => void;
}

/** How long a call that was asked to stop may take to do so [ms]. */
const patience = 300;

export class Process {
  /** Grows with every worker: what was made in an earlier one is lost. */
  generation = 0;
  private worker: RunningWorker | null = null;
  private closed = false;
  private last: Promise<unknown> = Promise.resolve();
  private freed: number[] = [];
  private ended: ((error: Error) => void) | null = null; // of the request under way

  constructor(private readonly start: () => Promise<RunningWorker>) {}

  /** Runs `body` when all calls before it are through. */
  inTurn<T>(call: Call, body: () => Promise<T>): Promise<T> {
    const { signal } = call;
    if (signal?.aborted) return Promise.reject(new Cancelled());
    return new Promise<T>((resolve, reject) => {
      const leave = () => reject(new Cancelled()); // while waiting
      signal?.addEventListener("abort", leave);
      this.last = this.last.then(async () => {
        signal?.removeEventListener("abort", leave);
        if (signal?.aborted) return;
        await body().then(resolve, reject);
      });
    });
  }

  /** Sends a request to the worker, in its turn only. Objects to free go with it. */
  async ask(op: string, args: unknown[], as: number[], call: Call): Promise<unknown> {
    const worker = await this.running();
    const { signal, onProgress } = call;
    const shared = !worker.cancel && typeof SharedArrayBuffer === "function" && signal;
    const flag = shared ? new Int32Array(new SharedArrayBuffer(4)) : null;
    const free = this.freed.splice(0);
    return new Promise((resolve, reject) => {
      let timer: ReturnType<typeof setTimeout> | undefined;
      const finish = () => {
        clearTimeout(timer);
        signal?.removeEventListener("abort", stop);
        this.ended = null;
      };
      const giveUp = () => {
        this.drop();
        finish();
        reject(new Cancelled());
      };
      const stop = () => {
        if (worker.cancel) return worker.cancel();
        if (!flag) return giveUp();
        Atomics.store(flag, 0, 1);
        timer = setTimeout(giveUp, patience);
      };
      this.ended = (error) => {
        finish();
        reject(error);
      };
      worker.onMessage((reply) => {
        if ("progress" in reply) return onProgress?.(reply.progress, reply.stage);
        finish();
        if ("value" in reply) return resolve(reply.value);
        if (reply.fatal) this.drop();
        reject(errorOf(reply));
      });
      signal?.addEventListener("abort", stop);
      worker.post({ op, args, as, free, progress: onProgress !== undefined, flag });
      if (signal?.aborted) stop();
    });
  }

  /** Frees an object of this generation, with the next request or when nothing happens. */
  free(handle: number, generation: number): void {
    if (generation !== this.generation || this.closed) return;
    this.freed.push(handle);
    if (this.freed.length > 1) return;
    this.last = this.last.then(() => {
      const free = this.freed.splice(0);
      if (free.length) this.worker?.post({ op: "", args: [], as: [], free, progress: false, flag: null });
    });
  }

  close(): void {
    this.closed = true;
    this.drop();
    this.ended?.(new InternalError("littoral was closed"));
  }

  private drop(): void {
    this.worker?.end();
    this.worker = null;
    this.freed = [];
    this.generation += 1;
  }

  private async running(): Promise<RunningWorker> {
    if (this.closed) throw new InternalError("littoral was closed");
    if (this.worker) return this.worker;
    try {
      const worker = await this.start();
      worker.onError((what) => {
        if (this.worker !== worker) return;
        this.drop();
        this.ended?.(new InternalError(`the worker ended: ${what}`));
      });
      this.worker = worker;
      return worker;
    } catch (error) {
      throw error instanceof LittoralError ? error : new InternalError(String(error));
    }
  }
}
