#include "base/platform/child_start.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>
#if defined(__linux__)
#include <sys/prctl.h>
#endif

#include <csignal>
#include <initializer_list>

namespace littoral {

bool begin_child(int output) noexcept {
  ::setpgid(0, 0);
#if defined(__linux__)
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
  for (const int signal : {SIGINT, SIGTERM, SIGPIPE, SIGCHLD}) ::signal(signal, SIG_DFL);
  const struct rlimit no_core = {0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const int in = ::open("/dev/null", O_RDONLY);
  return in >= 0 && output >= 0 && ::dup2(in, 0) >= 0 && ::dup2(output, 1) >= 0 &&
         ::dup2(output, 2) >= 0;
}

void limit_memory(MemoryKind kind, double bytes) noexcept {
  const auto resource = kind == MemoryKind::data ? RLIMIT_DATA : RLIMIT_AS;
  struct rlimit space = {};
  if (!(bytes > 0 && bytes < 1e18) || ::getrlimit(resource, &space) != 0) return;
  const auto wanted = static_cast<rlim_t>(bytes);
  if (space.rlim_cur != RLIM_INFINITY && wanted >= space.rlim_cur) return;
  space.rlim_cur = wanted;
  ::setrlimit(resource, &space);
}

}  // namespace littoral
