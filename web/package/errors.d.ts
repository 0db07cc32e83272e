/** Root of all errors. The message is the library's. */
export class LittoralError extends Error {
  /** Which kind of error it is; stays the same when the wording changes (docs/guides/messages.md). */
  readonly code: string;
}
/** Bad input; the message names file, line or element. */
export class InputError extends LittoralError {}
/** A combination that is not supported; the message says what would work. */
export class UnsupportedError extends LittoralError {}
/** A solve broke down. */
export class SolveError extends LittoralError {
  /** That was reached; -1 where unknown. */
  readonly residual: number;
}
/** A file of an unknown kind, or a size that would not fit in memory. */
export class IoError extends LittoralError {}
/** Memory ran out. */
export class MemoryError extends LittoralError {}
/** The caller asked to stop. */
export class Cancelled extends LittoralError {}
/** The library itself failed, or its worker could not be started; the next call starts it anew. */
export class InternalError extends LittoralError {}
