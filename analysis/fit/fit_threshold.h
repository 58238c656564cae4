#pragma once

#include <vector>

#include "analysis/fit/fit.h"

namespace railcast {

/// What detection says: random losses, threshold, extinction, and the surfaces' ratios to the
/// threshold, or their reflectances where something fixes the scale.
///
/// @param result Its surfaces have their reflectance from intensities already, where these are
/// used;
///   the rest of them and the parameters are filled in.
void FitThreshold(const std::vector<Trial>& trials,
                  const std::vector<FitSurface>& surfaces,
                  const FitSettings& settings,
                  FitResult& result);

}  // namespace railcast
