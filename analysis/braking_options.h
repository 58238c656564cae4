#pragma once

#include <CLI/CLI.hpp>

#include "analysis/detectability/object_detection.h"

namespace railcast {

/// Adds --reaction-s, --deceleration-mps2 and --margin-m.
void AddBrakingOptions(CLI::App& command, BrakingSpec& braking);

}  // namespace railcast
