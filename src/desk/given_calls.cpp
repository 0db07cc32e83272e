// The files that a page was started with. The surface goes straight into the library.

#include <algorithm>
#include <sstream>

#include "desk/call.h"
#include "io/read.h"

namespace littoral::desk {

namespace {

/// The 64 bits of FNV-1a, by which a link knows its file.
std::string content_hash(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3;
  std::string out(16, '0');
  for (std::size_t k = 16; k-- > 0; hash >>= 4) out[k] = "0123456789abcdef"[hash & 15];
  return out;
}

json given(Call& call) {
  const Given& given = call.given();
  if (given.surface.empty()) return nullptr;
  json sources = json::array();
  for (const std::filesystem::path& path : given.sources) {
    const io::FileBytes file(path);
    const std::string_view text = file.view();
    sources.push_back(
        {{"name", path.filename().string()},
         {"bytes", call.put(reinterpret_cast<const unsigned char*>(text.data()), text.size())}});
  }
  return {{"name", given.surface.filename().string()},
          {"hash", content_hash(io::FileBytes(given.surface).view())},
          {"sources", sources}};
}

json load_given(Call& call) {
  const std::filesystem::path& path = call.given().surface;
  if (path.empty()) throw InputError("no file was given");
  return made_surface(call, surface_of_file(path, call.context()));
}

}  // namespace

Mesh surface_of_file(const std::filesystem::path& path, const Context& context) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  const auto listed = [&](const std::string& extensions) {
    std::istringstream words(extensions);
    for (std::string word; words >> word;)
      if (word == extension) return true;
    return false;
  };
  if (!extension.empty() && !listed(mesh_extensions()) && listed(volume_extensions()))
    return isosurface(read_volume(path), 0, true, context);
  return read_mesh(path);
}

void add_given_operations(Operations& operations) {
  operations.merge(Operations{{"given", given}, {"loadGiven", load_given}});
}

}  // namespace littoral::desk
