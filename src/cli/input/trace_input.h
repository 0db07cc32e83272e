#pragma once
// What `view` and `render` do with --trace: surfaces of fields, traced by rays.

#include "cli/input/space_input.h"
#include "cli/input/volume_input.h"

namespace littoral::cli {

struct TraceArguments {
  bool trace = false;
  SpaceArguments space;  // its input is set from the verb's FILE
};

/// Adds --trace and the options of sdf that go with it.
void add_trace_options(CLI::App& verb, TraceArguments& texts, Session& session);

/// Throws InputError naming an option that means nothing without --trace.
void check_no_trace_options(const CLI::App& verb);

/// The scene of `file` with its surface traced.
io::Scene read_traced_scene(const std::string& file, TraceArguments& texts,
                            const VolumeViewArguments& view, bool for_page, Session& session);

}  // namespace littoral::cli
