#pragma once

#include "core/base/error.h"
#include "core/base/unknown_places.h"
#include "core/scenario/scenario_spec.h"

namespace railcast {

/// The faults that show when a scenario's scan pattern and its world are built, as far as they do
/// not follow from what is unknown.
void AddBuildFaults(const ScenarioSpec& spec, const UnknownPlaces& unknown, ErrorList& errors);

}  // namespace railcast
