// What build.mjs puts into the bundles.
declare module "littoral:library" {
  export default function createLibrary(options: {
    instantiateWasm(imports: WebAssembly.Imports, use: (instance: WebAssembly.Instance) => void): object;
  }): Promise<{
    HEAPU8: Uint8Array;
    answer(request: Uint8Array, watch: ((fraction: number, stage: string) => boolean) | undefined): Uint8Array;
  }>;
}
/** The worker's code. */
declare module "littoral:worker" {
  const text: string;
  export default text;
}
/** littoral.wasm, packed by gzip, as base64. */
declare module "littoral:wasm" {
  const text: string;
  export default text;
}
