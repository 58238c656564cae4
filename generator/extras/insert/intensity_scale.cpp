#include "generator/extras/insert/intensity_scale.h"

#include <algorithm>
#include <cmath>

#include "core/base/text.h"
#include "core/io/recording/recording_kinds.h"

namespace railcast {

IntensityScaleFinder::IntensityScaleFinder(const RecordingInfo& info)
    : are_reflectances_(IsSimulated(info) || info.kind.starts_with("capture")) {}

void IntensityScaleFinder::Add(const RecordedFrame& recorded) {
  if (!recorded.Has("intensity")) return;
  for (const float intensity : recorded.frame.intensity) {
    if (std::isnan(intensity)) continue;
    ++num_points_;
    if (intensity > 1.0F) ++num_above_1_;
    if (intensity > 100.0F) ++num_above_100_;
    highest_ = std::max(highest_, intensity);
    if (intensity > 0.0F && !(least_ > 0.0F && least_ < intensity)) least_ = intensity;
  }
}

IntensityScale IntensityScaleFinder::Found() const {
  if (num_points_ == 0) return {1.0, 0.0, "intensities: none are recorded"};
  if (are_reflectances_) return {1.0, 0.0, "intensities: reflectances, 1 = white"};
  const double of_zero = 0.25 * static_cast<double>(least_);
  constexpr std::uint64_t kHardlyAny = 100;
  const std::string seen =
      ", since the highest recorded is " + ShortText(static_cast<double>(highest_));
  if (num_above_1_ * kHardlyAny <= num_points_) {
    return {1.0, of_zero, "intensities: taken for reflectances, 1 = white" + seen};
  }
  if (num_above_100_ * kHardlyAny <= num_points_) {
    return {100.0, of_zero, "intensities: taken for hundredths, 100 = white" + seen};
  }
  if (highest_ <= 255.0F)
    return {255.0, of_zero, "intensities: taken for bytes, 255 = white" + seen};
  return {65535.0, of_zero, "intensities: taken for 16-bit counts, 65535 = white" + seen};
}

}  // namespace railcast
