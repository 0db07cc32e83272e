// The command `littoral`.

#include "cli/program.h"

int main(int argc, char** argv) {
  littoral::cli::Program program;
  return program.run({argv + 1, argv + argc}, littoral::cli::Program::Signals::watched);
}
