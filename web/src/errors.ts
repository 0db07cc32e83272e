// The errors of the package: one class for each of the library's, and two of JavaScript's own world.

export class LittoralError extends Error {
  constructor(message: string) {
    super(message);
    this.name = new.target.name;
  }
}
export class InputError extends LittoralError {}
export class UnsupportedError extends LittoralError {}
export class SolveError extends LittoralError {
  readonly residual: number;
  constructor(message: string, residual = -1) {
    super(message);
    this.residual = residual;
  }
}
export class IoError extends LittoralError {}
export class MemoryError extends LittoralError {}
export class Cancelled extends LittoralError {
  constructor(message = "cancelled") {
    super(message);
  }
}
export class InternalError extends LittoralError {}

/** An error as it crosses from the worker. */
export interface Failure {
  error: string;
  message: string;
  residual?: number;
}

export function errorOf({ error, message, residual }: Failure): LittoralError {
  switch (error) {
    case "InputError": return new InputError(message);
    case "UnsupportedError": return new UnsupportedError(message);
    case "SolveError": return new SolveError(message, residual);
    case "IoError": return new IoError(message);
    case "MemoryError": return new MemoryError(message);
    case "Cancelled": return new Cancelled();
    case "LittoralError": return new LittoralError(message);
    default: return new InternalError(message);
  }
}
