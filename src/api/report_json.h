#pragma once
// Reports and facts as JSON text.

#include <string>
#include <vector>

#include "api/surface/mesh_info.h"
#include "littoral/methods.h"
#include "littoral/report.h"

namespace littoral {

/// One object with method, domain, status, options, sizes, timings [s], iterations, residuals,
/// warnings and unreachable_components. Stages named twice are added up; numbers that are not
/// finite become the texts "inf", "-inf", "nan"; bytes that are not UTF-8 are replaced.
std::string report_json(const Report& report);

/// The facts as one object, in their order.
std::string info_json(const std::vector<InfoEntry>& entries);

/// A list of objects: name, summary, domains, options, reference.
std::string methods_json(const std::vector<MethodFamily>& families);

}  // namespace littoral
