#pragma once
// The error family. The core throws these and nothing else, and never prints.

#include <stdexcept>
#include <string>
#include <utility>

namespace littoral {

/// Root of all errors thrown by littoral. The code says which kind of error it is, stays the same
/// when the wording changes, and is explained by the page of messages.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& what, std::string code = "internal")
      : std::runtime_error(what), code_(std::move(code)) {}
  const std::string& code() const { return code_; }

 private:
  std::string code_;
};

/// Bad input: the message names file, line or element, and the remedy where there is one.
class InputError : public Error {
 public:
  explicit InputError(const std::string& what, std::string code = "bad-input")
      : Error(what, std::move(code)) {}
};

/// A combination that is not supported: the message names method and domain, and what would work.
class UnsupportedError : public Error {
 public:
  explicit UnsupportedError(const std::string& what, std::string code = "unsupported")
      : Error(what, std::move(code)) {}
};

/// A linear or convex solve broke down; carries the residual that was reached.
class SolveError : public Error {
 public:
  explicit SolveError(const std::string& what, double residual = -1)
      : Error(what, "solve-failed"), residual_(residual) {}
  SolveError(const std::string& what, std::string code) : Error(what, std::move(code)) {}
  double residual() const { return residual_; }

 private:
  double residual_ = -1;
};

/// A file could not be opened, read or written, or a size was foreseen not to fit in memory.
class IoError : public Error {
 public:
  explicit IoError(const std::string& what, std::string code = "io-error")
      : Error(what, std::move(code)) {}
};

/// The caller asked to stop.
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled", "cancelled") {}
};

}  // namespace littoral
