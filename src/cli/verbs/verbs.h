#pragma once
// Each function adds one verb to the program; reading its arguments sets session.job.

#include "cli/session.h"

namespace littoral::cli {

void add_distance(CLI::App& program, Session& session);
void add_pairs(CLI::App& program, Session& session);
void add_winding(CLI::App& program, Session& session);
void add_sdf(CLI::App& program, Session& session);
void add_query(CLI::App& program, Session& session);
void add_fit_tori(CLI::App& program, Session& session);
void add_info(CLI::App& program, Session& session);
void add_convert(CLI::App& program, Session& session);
void add_repair(CLI::App& program, Session& session);
void add_compare(CLI::App& program, Session& session);
void add_contour(CLI::App& program, Session& session);
void add_offset(CLI::App& program, Session& session);
void add_samples(CLI::App& program, Session& session);
void add_batch(CLI::App& program, Session& session);
void add_methods(CLI::App& program, Session& session);
void add_formats(CLI::App& program, Session& session);
void add_help(CLI::App& program, Session& session);
void add_completion(CLI::App& program, Session& session);
void add_view(CLI::App& program, Session& session);
void add_render(CLI::App& program, Session& session);

}  // namespace littoral::cli
