#pragma once

#include <optional>
#include <string>

#include "analysis/compare/cloud_figures.h"

namespace railcast {

/// Intensities of two sources that differ by hardly more than a factor, as those of drivers that
/// count from 0 to 255 and of others that count from 0 to 1 do.
struct IntensityFactor {
  double b_over_a{};      ///< Median of the ratios of the deciles.
  double largest_left{};  ///< The largest ratio of two deciles once they are scaled; 1 is none.
};

/// Compares the deciles of CloudHistograms::intensity. (Not the divergence that is left: counted
/// intensities fall into other bins once they are scaled.)
/// Returns nothing if the factor is less than two bins, or if a decile is off by more than one.
[[nodiscard]] std::optional<IntensityFactor> IntensityFactorOf(const Histogram& a,
                                                               const Histogram& b);

/// One sentence.
[[nodiscard]] std::string InWords(const IntensityFactor& factor);

}  // namespace railcast
