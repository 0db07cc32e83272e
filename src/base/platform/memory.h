#pragma once
// Sizes foreseen not to fit are errors, not crashes.

#include <string>

#include "littoral/error.h"

namespace littoral {

/// Bytes this process may still use: free and reclaimable memory of the machine, less where a limit
/// is set on the process. A very large number where the system does not say.
double available_memory();

/// What work begun by this thread may need at most [bytes]; 0, the default: what is available.
void set_memory_limit(double bytes);
double memory_limit();

/// What is available, or the limit of this thread's work where that is less [bytes].
double memory_to_use();

/// The most memory this process has held so far [bytes]; 0 where the system does not say.
double peak_memory();

/// What this process can write to, touched or not, as limits of it count [bytes]; 0 where the
/// system does not say.
double writable_memory();

/// Gives memory that was freed back to the system where much would be kept for later; between
/// stages that take much.
void return_freed_memory();

/// Throws IoError, with both numbers and the remedy, if `bytes` exceeds the available memory.
/// what: "a grid of 999 x 999 x 999 nodes"; remedy: "lower option resolution".
void check_memory(double bytes, const std::string& what, const std::string& remedy);

/// Is it what check_memory throws, and not about a file?
bool is_about_memory(const IoError& error);

}  // namespace littoral
