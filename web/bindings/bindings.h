#pragma once
// What the bindings of all parts share: answers, arrays, calls. Every function answers an object
// with either `value`, or `error`, the kind of the error, and its `message`: exceptions of C++ mean
// nothing to JavaScript.

#include <emscripten/bind.h>
#include <emscripten/val.h>
#include <littoral/littoral.h>

#include <chrono>
#include <exception>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace littoral::web {

using emscripten::val;

inline val failed(const char* kind, const std::exception& error) {
  val out = val::object();
  out.set("error", std::string(kind));
  out.set("message", std::string(error.what()));
  return out;
}

/// What `body()` returns, or what it throws.
template <class Body>
val answered(const Body& body) {
  try {
    val out = val::object();
    out.set("value", body());
    return out;
  } catch (const SolveError& error) {
    val out = failed("SolveError", error);
    out.set("residual", error.residual());
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
    return failed("MemoryError", error);
  } catch (const std::exception& error) {
    return failed("InternalError", error);
  }
}

/// A context that tells `progress(fraction, stage)`, at most twenty times a second, and stops where
/// that answers true.
inline Context context_of(const val& progress) {
  Context context;
  if (progress.isUndefined()) return context;
  using Clock = std::chrono::steady_clock;
  context.progress = [progress, cancel = context.cancel, reported = Clock::time_point{}](
                         double fraction, const std::string& stage) mutable {
    const auto now = Clock::now();
    if (fraction < 1 && now - reported < std::chrono::milliseconds(50)) return;
    reported = now;
    if (progress(fraction, stage).as<bool>()) cancel.cancel();
  };
  return context;
}

/// A copy that belongs to JavaScript.
template <class T>
val array_of(const T* data, std::size_t size) {
  return val(emscripten::typed_memory_view(size, data)).call<val>("slice");
}
template <class Derived>
val array_of(const Eigen::PlainObjectBase<Derived>& values) {
  return array_of(values.data(), static_cast<std::size_t>(values.size()));
}

template <class T>
std::vector<T> numbers_of(const val& array) {
  if (array.isUndefined() || array.isNull()) return {};
  return emscripten::convertJSArrayToNumberVector<T>(array);
}

/// Points as they come, three numbers each.
inline MatX3 points_of(const val& array) {
  const std::vector<double> numbers = numbers_of<double>(array);
  if (numbers.size() % 3 != 0)
    throw InputError("points have three coordinates each, there are " +
                     std::to_string(numbers.size()) + " numbers");
  return Eigen::Map<const MatX3>(numbers.data(), static_cast<Eigen::Index>(numbers.size() / 3), 3);
}

AnyMethod method_of(const std::string& name, const val& options);

/// Lines as positions, offsets and levels.
val lines_of(const std::vector<LevelCurves>& levels);
val lines_of(const std::vector<MatX3>& lines);

/// Positions, triangles, the polygons that they were cut from, scalars.
val drawn(const PolygonSoup& soup);
PolygonSoup soup_of_triangles(const val& drawn);

}  // namespace littoral::web
