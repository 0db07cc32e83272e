/** The same in one module, without an address to fetch anything from: for pages opened from disk. */
export * from "./littoral.js";
