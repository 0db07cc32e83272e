#pragma once
// One run of the program: reads arguments, runs a verb, turns errors into exit statuses.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/session.h"

namespace littoral::cli {

class Program {
 public:
  enum class Signals { watched, as_they_are };

  Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// The exit status of the program with these arguments. To be called once.
  int run(std::vector<std::string> arguments, Signals signals);
  /// Reads the arguments alone. Throws InputError for those that `run` would refuse unseen.
  void read(std::vector<std::string> arguments);

  const CLI::App& app() const { return app_; }
  const Session& session() const { return session_; }

 private:
  Session session_;
  CLI::App app_;
};

}  // namespace littoral::cli
