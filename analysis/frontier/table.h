#pragma once

#include <string>
#include <vector>

#include "analysis/frontier/measure.h"

namespace railcast {

/// The results as aligned text, a line per row: time, ratio to the raw trace, errors in percent and
/// millimetres.
[[nodiscard]] std::string FrontierTable(const std::vector<RowResult>& results);

}  // namespace railcast
