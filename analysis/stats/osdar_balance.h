#pragma once

#include "analysis/report/report.h"
#include "analysis/stats/difficulty.h"
#include "railcast/frame.h"

namespace railcast {

/// Shares of the classes among objects with points, by OSDaR23's names, beside those among
/// OSDaR23's own cuboids (osdar23_cuboids.json).
[[nodiscard]] Section MakeOsdarBalanceSection(const Difficulty& objects, const LabelTable& labels);

}  // namespace railcast
