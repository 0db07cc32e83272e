// JSON and arrays beside it as the bytes of one message, and back: src/desk/message.h.
const mark = 0x314c544c, first = 8;
const types = { $f64: Float64Array, $i32: Int32Array, $u32: Uint32Array, $u8: Uint8Array };
type Word = keyof typeof types;
type Numbers = Float64Array | Int32Array | Uint32Array | Uint8Array;

const padded = (size: number) => Math.ceil(size / 8) * 8;

function wordOf(array: Numbers): Word | undefined {
  return (Object.keys(types) as Word[]).find((word) => array instanceof types[word]);
}

export function encode(value: unknown): Uint8Array<ArrayBuffer> {
  const arrays: Numbers[] = [];
  let size = 0;
  const json = JSON.stringify(value, (_, part: unknown) => {
    if (typeof part === "number" && !Number.isFinite(part)) return { $number: String(part) };
    if (!ArrayBuffer.isView(part)) return part;
    const array = part as Numbers, word = wordOf(array);
    if (!word) throw new TypeError("arrays of this type are not sent");
    const place = [size, array.length];
    arrays.push(array);
    size = padded(size + array.byteLength);
    return { [word]: place };
  });
  const text = new TextEncoder().encode(json), length = padded(text.length);
  const out = new Uint8Array(first + length + size);
  new DataView(out.buffer).setUint32(0, length, true);
  new DataView(out.buffer).setUint32(4, mark, true);
  out.fill(0x20, first, first + length).set(text, first);
  let at = first + length;
  for (const array of arrays) {
    out.set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength), at);
    at += padded(array.byteLength);
  }
  return out;
}

/** Every array has its own buffer. */
export function decode(bytes: Uint8Array): unknown {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < first || view.getUint32(4, true) !== mark) throw new Error("this is no answer of littoral");
  const start = first + view.getUint32(0, true);
  const text = new TextDecoder().decode(bytes.subarray(first, start));
  return JSON.parse(text, (_, part: unknown) => {
    if (typeof part !== "object" || part === null) return part;
    for (const word of Object.keys(types) as Word[]) {
      const place = (part as Record<string, unknown>)[word];
      if (!Array.isArray(place)) continue;
      const [at, count] = place as [number, number], type = types[word];
      const from = bytes.byteOffset + start + at;
      return new type(bytes.buffer.slice(from, from + count * type.BYTES_PER_ELEMENT) as ArrayBuffer);
    }
    return part;
  });
}
