#pragma once

#include "core/base/error.h"
#include "railcast/scenario.h"

namespace railcast {

/// Adds the faults that only building a scenario's scan patterns and its world reveals. Leaves out
/// faults that merely follow from values that could not be read.
void AddBuildFaults(const ScenarioSpec& spec, const UnknownPlaces& unknown, ErrorList& errors);

}  // namespace railcast
