#include "desk/desk.h"

#include <exception>
#include <new>
#include <stdexcept>

#include "desk/call.h"

namespace littoral::desk {

namespace {

/// The page's objects are no longer here; it makes them again.
struct ObjectGone : std::runtime_error {
  explicit ObjectGone(int handle)
      : std::runtime_error("there is no object " + std::to_string(handle)) {}
};

Message failed(const char* kind, const std::exception& error, const std::string& code) {
  return {{{"error", kind}, {"message", error.what()}, {"code", code}}, {}};
}
Message failed(const char* kind, const Error& error) { return failed(kind, error, error.code()); }

json about(Call&) {
  return {{"version", LITTORAL_VERSION},
          {"methods", methods_json(method_families())},
          {"surfaces", mesh_extensions()},
          {"volumes", volume_extensions()},
          {"sources", sources_extensions()}};
}

const Operations& operations() {
  static const Operations all = [] {
    Operations out{{"about", about}};
    add_surface_operations(out);
    add_space_operations(out);
    add_shape_operations(out);
    add_given_operations(out);
    return out;
  }();
  return all;
}

std::vector<int> handles(const json& head, const char* name) {
  const auto found = head.find(name);
  if (found == head.end()) return {};
  return found->get<std::vector<int>>();
}

}  // namespace

Message message_of_exception() {
  try {
    throw;
  } catch (const SolveError& error) {
    Message out = failed("SolveError", error);
    out.head["residual"] = error.residual();
    return out;
  } catch (const InputError& error) {
    return failed("InputError", error);
  } catch (const UnsupportedError& error) {
    return failed("UnsupportedError", error);
  } catch (const IoError& error) {
    return failed("IoError", error);
  } catch (const Cancelled& error) {
    return failed("Cancelled", error);
  } catch (const Error& error) {
    return failed("LittoralError", error);
  } catch (const std::bad_alloc& error) {
    return failed("MemoryError", error, "too-large");
  } catch (const json::exception& error) {
    return failed("InputError", error, "bad-input");
  } catch (const std::exception& error) {
    return failed("InternalError", error, "internal");
  }
}

const Object& Desk::object(int handle) const {
  const auto found = objects_.find(handle);
  if (found == objects_.end()) throw ObjectGone(handle);
  return *found->second;
}

Message Desk::answered(const Message& request, const Context& context) {
  for (const int handle : handles(request.head, "free")) objects_.erase(handle);
  const std::string name = request.head.value("op", "");
  if (name.empty()) return {{{"value", nullptr}}, {}};
  const auto operation = operations().find(name);
  if (operation == operations().end()) throw InputError("there is no operation '" + name + "'");
  if (!request.head.contains("args") || !request.head["args"].is_array())
    throw InputError("a request has a list of arguments");
  Call call(*this, request, context);
  json value = operation->second(call);
  const std::vector<int> as = handles(request.head, "as");
  if (as.size() != call.made.size())
    throw InputError("the request has " + std::to_string(as.size()) + " numbers for " +
                     std::to_string(call.made.size()) + " objects");
  for (std::size_t k = 0; k < as.size(); ++k) objects_[as[k]] = call.made[k];
  call.out.head["value"] = std::move(value);
  return std::move(call.out);
}

std::string Desk::answer(std::string_view request, const Context& context) {
  try {
    return packed(answered(unpacked(request), context));
  } catch (const ObjectGone&) {
    Message out = message_of_exception();
    out.head["fatal"] = true;
    return packed(out);
  } catch (...) {
    return packed(message_of_exception());
  }
}

}  // namespace littoral::desk
