// The one test source that knows where the checkout lies, so that compiled tests can be cached
// across checkouts.

#include "shared_data.h"

namespace littoral::test {

std::filesystem::path source_dir() { return LITTORAL_SOURCE_DIR; }

}  // namespace littoral::test
