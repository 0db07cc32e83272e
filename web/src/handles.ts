// Objects in the worker, and how they are made again in another worker.
import { InternalError } from "./errors";
import type { Call, Process } from "./process";
import type { Handle } from "./protocol";

let numbers = 0;

/** An object in the worker; arguments of the call that makes it may be others. */
export class Remote {
  readonly handle = ++numbers;
  generation = -1;
  disposed = false;

  constructor(readonly process: Process, readonly op: string, readonly args: readonly unknown[]) {}

  /** Makes the object if this worker has not got it; in turn only. */
  async ensure(call: Call): Promise<void> {
    if (this.generation === this.process.generation) return;
    await perform(this.process, this.op, this.args, [this], call);
  }

  dispose(): void {
    if (this.disposed) return;
    this.disposed = true;
    this.process.free(this.handle, this.generation);
  }
}

/** Sends a request with its arguments made, and takes note of what it makes. */
async function perform(process: Process, op: string, args: readonly unknown[], made: Remote[], call: Call): Promise<unknown> {
  const borrowed: Remote[] = [];
  const sent: unknown[] = [];
  for (const arg of args) {
    if (!(arg instanceof Remote)) {
      sent.push(arg);
      continue;
    }
    // An object that nobody refers to any more may still be what others are made of.
    if (arg.disposed && arg.generation !== process.generation) borrowed.push(arg);
    await arg.ensure(call);
    sent.push({ handle: arg.handle } satisfies Handle);
  }
  const value = await process.ask(op, sent, made.map((m) => m.handle), call);
  for (const remote of made) remote.generation = process.generation;
  for (const remote of borrowed) process.free(remote.handle, remote.generation);
  return value;
}

/** A call in its turn. Arguments that are disposed of already are refused. */
export function request(process: Process, op: string, args: readonly unknown[], made: Remote[], call: Call): Promise<unknown> {
  for (const arg of args) {
    if (arg instanceof Remote && arg.disposed) {
      return Promise.reject(new InternalError("this object was disposed of"));
    }
  }
  return process.inTurn(call, () => perform(process, op, args, made, call));
}

/** Frees what nobody refers to any more. */
export const forgotten = new FinalizationRegistry<Remote>((remote) => remote.dispose());
