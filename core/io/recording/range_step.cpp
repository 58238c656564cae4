#include "core/io/recording/range_step.h"

#include <algorithm>
#include <cmath>

#include "core/base/rounded_scale.h"
#include "core/io/recording/surface_point.h"

namespace railcast {

double StepOfValues(const std::vector<double>& values, double most) {
  std::vector<double> differences;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double difference = values[i] - values[i - 1];
    if (std::abs(difference) < most) differences.push_back(difference);
  }
  return FindStep(differences);
}

double RangeStep_m(const RecordedFrame& recorded) {
  constexpr double kMost_m = 0.3;
  // First returns that are used: enough for 1,000 differences on surfaces.
  constexpr std::size_t kMostPoints = 4000;
  constexpr std::size_t kAtOnce = 20;
  const Frame& frame = recorded.frame;
  const std::size_t num_firings = frame.num_slots() / frame.returns;
  const std::size_t stride = 1 + num_firings / kMostPoints;
  std::vector<double> ranges_m;
  for (std::size_t begin = 0; begin < num_firings; begin += stride * kAtOnce) {
    for (std::size_t i = begin; i < std::min(begin + kAtOnce, num_firings); ++i) {
      const std::size_t slot = i * frame.returns;
      ranges_m.push_back(HasSurfacePoint(recorded, slot) ? static_cast<double>(frame.range_m[slot])
                                                         : std::nan(""));
    }
    ranges_m.push_back(std::nan(""));
  }
  return StepOfValues(ranges_m, kMost_m);
}

}  // namespace railcast
