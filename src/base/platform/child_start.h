#pragma once
// What every child process does first; only calls that are safe in a copy of a process with several
// threads.

#include <cstdint>

namespace littoral {

/// Leads a process group of its own, ends with its parent where the system can see to that, leaves
/// no core file, reacts to signals as by default, reads nothing, and writes to `output`, an open
/// file. False where that failed.
bool begin_child(int output) noexcept;

/// What a limit on memory is a limit of.
enum class MemoryKind {
  address_space,  // whatever a program may do
  data            // what it can write to, which is what it uses: stacks, heaps and their like
};
/// Lowers a limit of this process [bytes]; 0: leaves it.
void limit_memory(MemoryKind kind, double bytes) noexcept;

}  // namespace littoral
