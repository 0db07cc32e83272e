#pragma once
// Parts of a page's scene (docs/reference/scene.md).

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/render/scene.h"
#include "io/render/scene_style.h"

namespace littoral::io {

std::string base64(const void* data, std::size_t size);

template <class T>
std::string base64(const std::vector<T>& items) {
  return base64(items.data(), items.size() * sizeof(T));
}

/// A volume with its slice.
nlohmann::json volume_json(const SceneVolume& volume, const SceneFrame& frame,
                           const FieldStyle& style);

/// Clouds, what becomes of them, and how values of the volume become distances in page units.
nlohmann::json trace_json(const SceneTrace& trace, const SceneFrame& frame,
                          const FieldStyle& style);

}  // namespace littoral::io
