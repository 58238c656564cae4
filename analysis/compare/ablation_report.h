#pragma once

#include <string>
#include <utility>
#include <vector>

#include "analysis/compare/ablation.h"
#include "analysis/report/report.h"

namespace railcast {

/// @param facts Of the scenario.
[[nodiscard]] Report MakeAblationReport(
    const std::vector<EffectStudy>& studies,
    const std::string& title,
    const std::vector<std::pair<std::string, std::string>>& facts,
    const std::string& command);

}  // namespace railcast
