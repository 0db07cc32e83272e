// Who computes: the library in a worker of the browser (littoral/inline), or the program that serves
// the page (web/src/native.ts). build.mjs puts in one of the two.
import type { Call, Littoral, Surface } from "littoral/inline";

export interface GivenFiles {
  readonly name: string;
  readonly hash: string;
  readonly sources: readonly { readonly name: string; readonly bytes: Uint8Array }[];
}

export interface Backend extends Littoral {
  /** Files that the program was started with. */
  given?(): Promise<GivenFiles | null>;
  loadGiven?(given: GivenFiles, call?: Call): Promise<Surface>;
}
