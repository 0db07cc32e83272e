// What the two sides say to each other. One request is answered before the next is sent.
import type { Failure } from "./errors";

/** An object in the worker, by its number. */
export interface Handle {
  handle: number;
}

export interface Start {
  start: WebAssembly.Module;
}
export interface Request {
  /** An operation of src/desk, or nothing: only to free. */
  op: string;
  args: unknown[];
  /** Numbers for the objects that come of it. */
  as: number[];
  /** Objects that nobody refers to any more. */
  free: number[];
  /** Is anybody interested in progress? */
  progress: boolean;
  /** Not 0: the caller wants the call to stop. */
  flag: Int32Array | null;
}

export type Reply =
  | { progress: number; stage: string }
  | { value: unknown }
  /** fatal: the worker is of no use any more. */
  | (Failure & { fatal?: boolean });
