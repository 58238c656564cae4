#pragma once

#include "analysis/detectability/object_detection.h"
#include "core/program/options.h"

namespace railcast {

/// Adds --reaction-s, --deceleration-mps2 and --margin-m.
void AddBrakingOptions(ProgramOptions& command, BrakingSpec& braking);

}  // namespace railcast
