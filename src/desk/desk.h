#pragma once
// The library behind a page: requests that name an operation, and objects that stay here and are
// named by number. A worker of a browser and `littoral view --edit` both answer from it.

#include <littoral/littoral.h>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "desk/message.h"

namespace littoral::desk {

using Object = std::variant<Mesh, DistanceSolver, Sdf, Volume>;

/// Files that a page begins with, from where the program runs.
struct Given {
  std::filesystem::path surface;
  std::vector<std::filesystem::path> sources;
};

class Desk {
 public:
  explicit Desk(Given given = {}) : given_(std::move(given)) {}

  /// Answers {"op", "args", "as", "free"} with {"value"}, or {"error", "message"} with the name of
  /// the error. Objects are {"handle": number}; those that are made get the numbers of "as".
  std::string answer(std::string_view request, const Context& context);

  const Given& given() const { return given_; }
  const Object& object(int handle) const;

 private:
  Message answered(const Message& request, const Context& context);

  Given given_;
  std::map<int, std::shared_ptr<const Object>> objects_;
};

/// The surface in a file, of a volume its isosurface at 0.
Mesh surface_of_file(const std::filesystem::path& path, const Context& context);

/// A message that says what was thrown; from within a handler.
Message message_of_exception();

}  // namespace littoral::desk
