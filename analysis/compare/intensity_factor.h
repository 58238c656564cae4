#pragma once

#include <optional>
#include <string>

#include "analysis/compare/cloud_figures.h"

namespace railcast {

/// Intensities of two sources that differ by hardly more than a factor, as those of drivers that
/// count from 0 to 255 and of others that count from 0 to 1 do.
struct IntensityFactor {
  double b_over_a{};             ///< Median over the deciles of the ratios of their intensities.
  double divergence_bit{};       ///< Of the intensities as they are.
  double divergence_left_bit{};  ///< Of the intensities once they are scaled.
};

/// Returns nothing if the intensities are alike as they are, or differ by more than a factor: if
/// scaling leaves more than half of their divergence, or more than 0.1 bit.
[[nodiscard]] std::optional<IntensityFactor> IntensityFactorOf(const Histogram& a,
                                                               const Histogram& b);

/// One sentence.
[[nodiscard]] std::string InWords(const IntensityFactor& factor);

}  // namespace railcast
