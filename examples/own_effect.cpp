// own_effect.cpp: adds an effect that railcast lacks: exhaust over the track, which dims what is
// behind it.
//
// The effect changes the frame that the simulator has made: a frame says with which power each
// point was received, as a multiple of the detection threshold. It cannot change the echoes before
// they are detected: an effect that does so has to be added to railcast itself (CONTRIBUTING.md,
// "an effect").
#include <railcast/railcast.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <limits>

struct Exhaust {
  Eigen::Vector3f center_m{12.0F, 0.0F, 0.5F};  // In the sensor's axes.
  float radius_m = 2.0F;
  float extinction_per_m = 1.0F;
};

// Length of a beam inside the ball of exhaust before it reaches the point.
float LengthInside_m(const Exhaust& exhaust, const Eigen::Vector3f& point_m) {
  const float range_m = point_m.norm();
  const float nearest_m = exhaust.center_m.dot(point_m) / range_m;
  const float off_axis_m2 = exhaust.center_m.squaredNorm() - nearest_m * nearest_m;
  const float half_m2 = exhaust.radius_m * exhaust.radius_m - off_axis_m2;
  if (half_m2 <= 0.0F) return 0.0F;
  const float half_m = std::sqrt(half_m2);
  const float end_m = std::min(range_m, nearest_m + half_m);
  return std::max(0.0F, end_m - std::max(0.0F, nearest_m - half_m));
}

// Dims the light on its way there and back (law of Beer and Lambert). Needs points in the sensor's
// axes and one return per firing, both of which are the default.
void Apply(const Exhaust& exhaust, railcast::Frame& frame) {
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!railcast::HasPoint(frame.outcome[slot])) continue;
    const float length_m = LengthInside_m(exhaust, {frame.x[slot], frame.y[slot], frame.z[slot]});
    if (length_m == 0.0F) continue;
    frame.power_ratio[slot] *= std::exp(-2.0F * exhaust.extinction_per_m * length_m);
    if (frame.power_ratio[slot] >= 1.0F) continue;
    frame.outcome[slot] = railcast::Outcome::kBelowThreshold;  // Label and true range stay known.
    frame.return_count[slot] = 0;
    for (auto* values : {&frame.x, &frame.y, &frame.z, &frame.range_m}) {
      (*values)[slot] = std::numeric_limits<float>::quiet_NaN();
    }
  }
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    const auto simulator = railcast::MakeSimulator(railcast::ReadScenario(argv[1]), 0);
    railcast::Frame frame;
    simulator->Scan(0, frame);
    const auto num_points = [&] {
      return std::count_if(frame.outcome.begin(), frame.outcome.end(), railcast::HasPoint);
    };
    const auto num_before = num_points();
    Apply(Exhaust{}, frame);
    std::cout << num_before - num_points() << " of " << num_before << " points are lost\n";
    return num_points() < num_before ? 0 : 1;
  } catch (const railcast::InputError& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
