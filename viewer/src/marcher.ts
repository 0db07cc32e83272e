// Makes isosurfaces, of large volumes in a worker so that the page stays responsive.
import workerText from "worker:./march-worker.ts";
import { makeWorker } from "./occlusion";
import { march, type Grid, type Shell } from "./march";

const small = 300_000;  // nodes that take less than a frame or two

export class Marcher {
  private worker: Worker | null = null;
  private busy = false;
  private next: number | null = null;

  constructor(private readonly grid: Grid, private readonly done: (shell: Shell, level: number) => void) {
    if (grid.values.length <= small) return;
    this.worker = makeWorker(workerText);
    if (!this.worker) return;
    this.worker.onmessage = ({ data }: MessageEvent<{ shell: Shell; level: number }>) => {
      this.busy = false;
      this.done(data.shell, data.level);
      if (this.next !== null) this.ask(this.next);
    };
    this.worker.onerror = (event) => {
      event.preventDefault();
      this.worker = null;
      this.busy = false;
      if (this.next !== null) this.ask(this.next);
    };
    this.worker.postMessage({ grid });
  }

  /** Is a surface being made? */
  get working(): boolean {
    return this.busy;
  }

  /** Asks for the surface of a level; of several while one is being made, the last counts. */
  ask(level: number): void {
    this.next = null;
    if (!this.worker) this.done(march(this.grid, level), level);
    else if (this.busy) this.next = level;
    else {
      this.busy = true;
      this.worker.postMessage({ level });
    }
  }

  dispose(): void {
    this.worker?.terminate();
  }
}
