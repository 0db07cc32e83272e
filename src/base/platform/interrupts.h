#pragma once
// Requests to stop, for a library inside a program that has handlers of its own.

#include "littoral/context.h"

namespace littoral {

/// While in scope on the process's first thread, SIGINT raises the token and then goes where it
/// went before. On other threads, and while SIGINT is ignored, it does nothing.
class CancelOnInterrupt {
 public:
  explicit CancelOnInterrupt(const CancelToken& token);
  ~CancelOnInterrupt();
  CancelOnInterrupt(const CancelOnInterrupt&) = delete;
  CancelOnInterrupt& operator=(const CancelOnInterrupt&) = delete;

 private:
  CancelToken token_;
  bool active_ = false;
};

}  // namespace littoral
