// The module of WebAssembly: a desk that answers bytes with bytes (src/desk/message.h).

#include <emscripten/bind.h>
#include <emscripten/val.h>

#include <chrono>
#include <string>

#include "desk/desk.h"

namespace littoral::web {

using emscripten::val;

/// A context that tells `progress(fraction, stage)`, at most twenty times a second, and stops where
/// that answers true.
Context context_of(const val& progress) {
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

val answer(const std::string& request, const val& progress) {
  static desk::Desk desk;
  const std::string out = desk.answer(request, context_of(progress));
  const auto* bytes = reinterpret_cast<const unsigned char*>(out.data());
  return val(emscripten::typed_memory_view(out.size(), bytes)).call<val>("slice");
}

}  // namespace littoral::web

EMSCRIPTEN_BINDINGS(littoral_module) { emscripten::function("answer", littoral::web::answer); }
