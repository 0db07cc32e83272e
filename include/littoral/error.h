#pragma once
// The error family. The core throws these and nothing else, and never prints.

#include <stdexcept>
#include <string>

namespace littoral {

/// Root of all errors thrown by littoral.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Bad input: the message names file, line or element, and the remedy where there is one.
class InputError : public Error {
 public:
  using Error::Error;
};

/// A combination that is not supported: the message names method and domain, and what would work.
class UnsupportedError : public Error {
 public:
  using Error::Error;
};

/// A linear or convex solve broke down; carries the residual that was reached.
class SolveError : public Error {
 public:
  explicit SolveError(const std::string& what, double residual = -1)
      : Error(what), residual_(residual) {}
  double residual() const { return residual_; }

 private:
  double residual_;
};

/// A file could not be opened, read or written, or a size was foreseen not to fit in memory.
class IoError : public Error {
 public:
  using Error::Error;
};

/// The caller asked to stop.
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
};

}  // namespace littoral
