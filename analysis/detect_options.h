#pragma once

#include <optional>
#include <string>

#include "analysis/detectability/object_detection.h"
#include "core/program/options.h"

namespace railcast {

/// Adds --reaction-s, --deceleration-mps2 and --margin-m.
void AddBrakingOptions(ProgramOptions& command, BrakingSpec& braking);

/// The options that say when an object is detected, and how a train brakes for it.
struct RuleOptions {
  DetectSpec spec;
  std::string frames = "3/5";
  std::optional<double> speed_kmph;

  /// What they say. @pre CLI11 has checked them.
  [[nodiscard]] DetectSpec Spec() const;
};

/// Adds --frames and those of braking.
void AddRuleOptions(ProgramOptions& command, RuleOptions& options);

}  // namespace railcast
