// A page as a C++ source: literals of at most 8 kB, which every compiler joins; bytes beyond ASCII as
// octal escapes.

/** Defines `std::string_view NAME()` of a namespace, which a header declares. */
export function asSource(page, { header, namespace, name }) {
  const bytes = Buffer.from(page, "utf8"), pieces = [];
  for (let at = 0; at < bytes.length; at += 8000) {
    let text = "";
    for (const byte of bytes.subarray(at, at + 8000)) {
      const c = String.fromCharCode(byte);
      if (c === "\n") text += "\\n";
      else if (c === "\\" || c === '"') text += "\\" + c;
      else if (c === "?" || byte < 32 || byte > 126) text += "\\" + byte.toString(8).padStart(3, "0");
      else text += c;
    }
    pieces.push(`    "${text}"`);
  }
  return `#include "${header}"

namespace ${namespace} {

namespace {
constexpr char text[] =
${pieces.join("\n")};
}  // namespace

std::string_view ${name}() { return {text, sizeof text - 1}; }

}  // namespace ${namespace}
`;
}
