#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/detect/detect_spec.h"

namespace railcast {

/// The effects by their name in a scenario.
inline constexpr std::pair<const char*, bool EffectSet::*> kEffects[] = {
    {"threshold", &EffectSet::threshold},
    {"rain", &EffectSet::rain},
    {"snow", &EffectSet::snow},
    {"noise", &EffectSet::noise},
    {"sensor_dropout", &EffectSet::sensor_dropout},
};

[[nodiscard]] inline std::vector<std::string> EffectNames() {
  std::vector<std::string> names;
  for (const auto& [name, member] : kEffects) names.emplace_back(name);
  return names;
}

}  // namespace railcast
