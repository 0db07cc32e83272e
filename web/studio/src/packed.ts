// Bytes as short text and back: examples in the page, and what links carry.

async function through(bytes: Uint8Array, stream: CompressionStream | DecompressionStream): Promise<Uint8Array> {
  const out = new Blob([bytes as BlobPart]).stream().pipeThrough(stream as ReadableWritablePair<Uint8Array, Uint8Array>);
  return new Uint8Array(await new Response(out as ReadableStream).arrayBuffer());
}

export const inflate = (bytes: Uint8Array) => through(bytes, new DecompressionStream("deflate-raw"));

export function fromBase64(text: string): Uint8Array {
  const raw = atob(text.replace(/-/g, "+").replace(/_/g, "/"));
  return Uint8Array.from(raw, (c) => c.charCodeAt(0));
}

export function toBase64(bytes: Uint8Array): string {
  let raw = "";
  for (let i = 0; i < bytes.length; i += 4096) raw += String.fromCharCode(...bytes.subarray(i, i + 4096));
  return btoa(raw).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
}

export async function pack(value: unknown): Promise<string> {
  const bytes = new TextEncoder().encode(JSON.stringify(value));
  return toBase64(await through(bytes, new CompressionStream("deflate-raw")));
}

export async function unpack(text: string): Promise<unknown> {
  return JSON.parse(new TextDecoder().decode(await inflate(fromBase64(text))));
}

/** Sixteen hexadecimal digits that tell files apart: FNV-1a of 64 bits. */
export function contentHash(bytes: Uint8Array): string {
  // In two halves of 32 bits; the prime is 2^40 + 0x1b3.
  let low = 0x84222325, high = 0xcbf29ce4;
  for (let i = 0; i < bytes.length; ++i) {
    low = (low ^ bytes[i]) >>> 0;
    const product = low * 0x1b3, carry = Math.floor(product / 0x100000000);
    high = (Math.imul(high, 0x1b3) + carry + (low << 8)) >>> 0;
    low = product >>> 0;
  }
  return high.toString(16).padStart(8, "0") + low.toString(16).padStart(8, "0");
}
