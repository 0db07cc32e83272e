#pragma once
// What the bindings of all parts share: calls without the interpreter's lock, arrays, options.

#include <littoral/littoral.h>
// The same in every file: how a type is converted must not depend on what a file includes.
#include <nanobind/eigen/dense.h>
#include <nanobind/eigen/sparse.h>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/platform/interrupts.h"

namespace littoral::python {

namespace nb = nanobind;

using Path = std::filesystem::path;  // from Python: any str or PathLike that names a file

void bind_surfaces(nb::module_& m);
void bind_space(nb::module_& m);
void bind_tets(nb::module_& m);
void bind_operators(nb::module_& m);
void bind_batch(nb::module_& m);
void bind_samples(nb::module_& m);

/// A Context in the hands of Python.
struct Settings {
  int threads = 0;
  nb::object progress = nb::none();  // callable(fraction, stage)
  double memory_limit = 0;
};

/// The settings of a call, and what came of its callbacks.
class RunningCall {
 public:
  explicit RunningCall(const Settings* settings) : settings_(settings) {
    if (!settings) return;
    context_.threads = settings->threads;
    context_.memory_limit = settings->memory_limit;
    if (!settings->progress.is_none())
      context_.progress = [this](double fraction, const std::string& stage) {
        report(fraction, stage);
      };
  }
  RunningCall(const RunningCall&) = delete;
  RunningCall& operator=(const RunningCall&) = delete;

  const Context& context() const { return context_; }

  /// With the lock held, after a call was cancelled: throws what Python raised meanwhile, if
  /// anything.
  void raise_what_python_raised() const {
    if (raised_) std::rethrow_exception(raised_);
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// At most twenty times a second: the callback needs the lock.
  void report(double fraction, const std::string& stage) {
    const auto now = Clock::now();
    if (fraction < 1 && now - reported_ < std::chrono::milliseconds(50)) return;
    reported_ = now;
    const nb::gil_scoped_acquire lock;
    if (raised_) return;
    try {
      settings_->progress(fraction, stage);
    } catch (nb::python_error&) {
      raised_ = std::current_exception();
      context_.cancel.cancel();
    }
  }

  const Settings* settings_;
  Context context_;
  Clock::time_point reported_{};
  std::exception_ptr raised_;
};

/// What `body(context)` returns, computed without the interpreter's lock. An interrupt from the
/// keyboard stops it.
template <class Body>
auto released(const Settings* settings, const Body& body) {
  RunningCall call(settings);
  try {
    const nb::gil_scoped_release unlocked;
    const CancelOnInterrupt watch(call.context().cancel);
    return body(call.context());
  } catch (const Cancelled&) {
    call.raise_what_python_raised();
    throw;
  }
}

/// Points of a surface as three arrays.
struct PointArrays {
  std::vector<SurfacePoint> points;
};

/// Text of the library for people: bytes that are not UTF-8, of a file's or a field's name, as
/// "\\xe9".
nb::str shown_text(std::string_view text);
/// A field's name, and back: such bytes as Python has them in names of files.
nb::str name_out(std::string_view name);
std::string name_in(nb::handle name);

/// A report as Python data, and back.
nb::dict as_dict(const Report& report);
Report as_report(const nb::dict& data);

/// A soup as Python data (points, offsets, corners, lines, normals, scalars), and back.
nb::tuple as_tuple(PolygonSoup soup);
PolygonSoup as_soup(const nb::tuple& data);

}  // namespace littoral::python
