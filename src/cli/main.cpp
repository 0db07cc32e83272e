// The command `littoral`.

#include "cli/program.h"
#include "solve/direct/dense_kernels.h"

int main(int argc, char** argv) {
  littoral::dense::end_blas_threads();
  littoral::cli::Program program;
  return program.run({argv + 1, argv + argc}, littoral::cli::Program::Signals::watched);
}
