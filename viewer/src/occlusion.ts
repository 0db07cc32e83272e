// The openness of surfaces that are made here, in a worker, once they have rested.
import workerText from "worker:./openness-worker.ts";
import { follow, type Asked } from "./openness";

const rest = 120;  // milliseconds

/** A worker of the page; null where the browser forbids it. */
export function makeWorker(text: string): Worker | null {
  if (typeof Worker === "undefined") return null;
  try {
    return new Worker(URL.createObjectURL(new Blob([text], { type: "text/javascript" })));
  } catch {
    return null;
  }
}

export class Occlusion {
  private worker: Worker | null;
  private job = 0;
  private timer = 0;
  private busy = false;
  private readonly here = follow((open, job) => this.take(open, job));

  constructor(private readonly surface: () => Omit<Asked, "job">, private readonly done: (open: Uint8Array) => void) {
    this.worker = makeWorker(workerText);
    if (!this.worker) return;
    this.worker.onmessage = ({ data }: MessageEvent<{ open: Uint8Array; job: number }>) => this.take(data.open, data.job);
    this.worker.onerror = (event) => {
      event.preventDefault();
      this.worker = null;
      this.ask();
    };
  }

  private take(open: Uint8Array, job: number): void {
    if (job !== this.job) return;
    this.busy = false;
    this.done(open);
  }

  get working(): boolean {
    return this.busy;
  }

  /** The surface is another: its openness is wanted, soon. */
  ask(): void {
    this.busy = true;
    const job = ++this.job;
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => {
      const asked = { ...this.surface(), job };
      if (this.worker) this.worker.postMessage(asked);
      else this.here(asked);
    }, rest);
  }

  dispose(): void {
    window.clearTimeout(this.timer);
    this.worker?.terminate();
  }
}
