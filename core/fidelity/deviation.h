#pragma once

#include "core/fidelity/frame_comparison.h"
#include "core/scenario/scenario_spec.h"

namespace railcast {

/// By how much frames differ from the reference's, in the terms of ToleranceSpec.
struct Deviation {
  double range_m{};
  double missed_share{};
  double false_share{};
  double thin_missed_share{};
  double intensity{};  ///< Infinite if the echoes have none.

  bool operator==(const Deviation&) const = default;
};

/// A quantity's place in a deviation and in the tolerance.
struct DeviationQuantity {
  double Deviation::*value;
  double ToleranceSpec::*limit;
};
inline constexpr DeviationQuantity kDeviationQuantities[] = {
    {&Deviation::range_m, &ToleranceSpec::range_m},
    {&Deviation::missed_share, &ToleranceSpec::missed_share},
    {&Deviation::false_share, &ToleranceSpec::false_share},
    {&Deviation::thin_missed_share, &ToleranceSpec::thin_missed_share},
    {&Deviation::intensity, &ToleranceSpec::intensity},
};

[[nodiscard]] Deviation DeviationOf(const FrameDifference& difference);

/// Whether none of the quantities is beyond its limit.
[[nodiscard]] bool IsWithin(const Deviation& deviation, const ToleranceSpec& tolerance);

}  // namespace railcast
