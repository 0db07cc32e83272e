// The one test source that knows where the checkout lies and how the library was built, so that
// compiled tests can be cached across checkouts and linked with every build of the library.

#include "shared_data.h"

namespace littoral::test {

std::filesystem::path source_dir() { return LITTORAL_SOURCE_DIR; }

bool sanitized() {
#ifdef LITTORAL_SANITIZED
  return true;
#else
  return false;
#endif
}

}  // namespace littoral::test
