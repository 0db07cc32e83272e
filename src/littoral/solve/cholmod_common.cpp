#if LITTORAL_CHOLMOD

#include "littoral/solve/cholmod_common.h"

#include <dlfcn.h>

#include <mutex>

namespace littoral {

namespace {

/// One thread of BLAS: results then do not depend on how many cores there are, and the many small
/// supernodes run faster. Independent factorizations run side by side instead.
void use_one_blas_thread() {
  static std::once_flag once;
  std::call_once(once, [] {
    using Setter = void (*)(int);
    if (void* symbol = dlsym(RTLD_DEFAULT, "openblas_set_num_threads"))
      reinterpret_cast<Setter>(symbol)(1);
  });
}

}  // namespace

CholmodCommon::CholmodCommon() {
  use_one_blas_thread();
  cholmod_start(&c);
  c.supernodal = CHOLMOD_SUPERNODAL;
  c.final_ll = 1;
  c.print = 0;
  c.try_catch = 1;
  c.nmethods = 1;
  c.method[0].ordering = CHOLMOD_METIS;
  c.postorder = 1;
}

CholmodCommon::~CholmodCommon() { cholmod_finish(&c); }

}  // namespace littoral

#endif
