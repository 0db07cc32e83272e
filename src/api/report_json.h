#pragma once
// Reports and facts as JSON text.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "api/surface/mesh_info.h"
#include "littoral/drawing.h"
#include "littoral/report.h"
#include "littoral/volume.h"

namespace littoral {

/// Visits each entry of a report with its name, in the order in which front ends show them.
template <class R, class Visit>
void each_entry(R& report, const Visit& visit) {
  visit("method", report.method);
  visit("domain", report.domain);
  visit("status", report.status);
  visit("options", report.options);
  visit("sizes", report.sizes);
  visit("timings", report.timings);
  visit("iterations", report.iterations);
  visit("residuals", report.residuals);
  visit("warnings", report.warnings);
  visit("unreachable_components", report.unreachable_components);
}

/// The report with every name once: timings and iterations added up, of residuals the largest, of
/// sizes, which may be stated again, the last.
Report summed_up(Report report);

/// Values of a result in short.
struct FieldRange {
  std::string name;
  double low = 0, high = 0;  // of the finite ones; NaN where there are none
  std::size_t count = 0, not_finite = 0;
};
FieldRange range_of(std::string name, const Eigen::Ref<const VecX>& values);

/// What a run would do; numbers are estimates, absent where nothing was measured.
struct PlannedRun {
  std::string reason;  // of the choice of the method
  std::optional<double> seconds, processor_seconds, memory_mb;
  double available_memory_mb = 0;
};

/// What a run of the program adds to the report of its computation.
struct RunRecord {
  std::string version, verb;                 // of the program
  std::vector<std::string> inputs, outputs;  // files
  std::optional<Grid> grid;
  std::vector<FieldRange> values;
  std::optional<PlannedRun> plan;
};

/// The report with schema, program, verb, inputs, outputs, grid and values: docs/reference holds
/// the schema.
std::string run_json(const RunRecord& record, const Report& report);
/// How a run failed: `kind` is "usage", "input", "unsupported", "io", "solve", "memory", "time" or
/// "internal".
struct RunFailure {
  std::string kind, code, message;
  int exit_status;
};
/// The same for a run that failed.
std::string failure_json(const RunRecord& record, const Report& report, const RunFailure& failure);

/// The facts as one object, in their order.
std::string info_json(const std::vector<InfoEntry>& entries);

}  // namespace littoral
