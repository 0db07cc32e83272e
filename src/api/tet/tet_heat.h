#pragma once
// What signed heat through given tets and through tets that fill a grid's box share.

#include <memory>

#include "base/task.h"
#include "littoral/report.h"
#include "operators/tet_operators.h"

namespace littoral {

/// phi as large as a unit gradient allows, with the same zero set; rows (rows x vertices) at which
/// it vanishes. `domain` names the mesh in messages.
VecX sharpened_on_tets(const std::shared_ptr<const TetOperators>& ops, const std::string& domain,
                       const SpMat& rows, const VecX& phi, const Task& task, Report& report);

}  // namespace littoral
