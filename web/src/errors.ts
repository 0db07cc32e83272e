// The errors of the package: one class for each of the library's, and two of JavaScript's own world.

export class LittoralError extends Error {
  /** Stays the same when the wording changes. */
  readonly code: string;
  constructor(message: string, code = "internal") {
    super(message);
    this.code = code;
    this.name = new.target.name;
  }
}
export class InputError extends LittoralError {
  constructor(message: string, code = "bad-input") {
    super(message, code);
  }
}
export class UnsupportedError extends LittoralError {}
export class SolveError extends LittoralError {
  readonly residual: number;
  constructor(message: string, code = "solve-failed", residual = -1) {
    super(message, code);
    this.residual = residual;
  }
}
export class IoError extends LittoralError {}
export class MemoryError extends LittoralError {}
export class Cancelled extends LittoralError {
  constructor(message = "cancelled") {
    super(message, "cancelled");
  }
}
export class InternalError extends LittoralError {}

/** An error as it crosses from the worker. */
export interface Failure {
  error: string;
  message: string;
  code?: string;
  residual?: number;
}

export function errorOf({ error, message, code, residual }: Failure): LittoralError {
  switch (error) {
    case "InputError": return new InputError(message, code);
    case "UnsupportedError": return new UnsupportedError(message, code);
    case "SolveError": return new SolveError(message, code, residual);
    case "IoError": return new IoError(message, code);
    case "MemoryError": return new MemoryError(message, code);
    case "Cancelled": return new Cancelled();
    case "LittoralError": return new LittoralError(message, code);
    default: return new InternalError(message);
  }
}
