#include "generator/insert/plan/registered_poses.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/points/point_alignment.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

ThinnedCloud ThinnedFrame(const Frame& frame) {
  std::vector<Eigen::Vector3f> points_m;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (std::isfinite(frame.range_m[i])) points_m.emplace_back(frame.x[i], frame.y[i], frame.z[i]);
  }
  return ThinnedCloud(points_m);
}

/// @throws InputError if it cannot be laid, or does not fit.
LaidCloud LayFrame(const ThinnedCloud& before,
                   const ThinnedCloud& cloud,
                   const Transform& guess,
                   const std::string& name) {
  const std::size_t num_points = std::min(before.size(), cloud.size());
  if (num_points < kFewestLaid) {
    throw InputError(name + ": must have at least " + NumberText(kFewestLaid) +
                     " points in cells of 0.4 m to be laid on the frame before it" +
                     Got(num_points));
  }
  constexpr double kMostResidual_m = 1.0;
  const auto laid = LayOn(before, cloud, guess);
  if (!laid || !(laid->residual_m <= kMostResidual_m)) {
    throw InputError(name + ": must fit the frame before it to 1 m (got " +
                     (laid ? ShortText(laid->residual_m) + " m" : "no convergence") + ")");
  }
  return *laid;
}

}  // namespace

RegisteredPoses RegisterClouds(const std::filesystem::path& recording,
                               const Transform& vehicle_from_sensor) {
  const auto opened = OpenRecording(recording);
  RegisteredPoses registered;
  std::vector<double> residuals_m;
  std::optional<ThinnedCloud> before;
  Transform motion = Transform::Identity();  // From one frame to the next, as the last one was.
  while (const auto read = opened->Next()) {
    const RecordedFrame recorded = (*read)();
    const ThinnedCloud cloud = ThinnedFrame(recorded.frame);
    if (!before) {
      registered.world_from_sensor.push_back(vehicle_from_sensor);
      residuals_m.push_back(0.0);
    } else {
      const LaidCloud laid = LayFrame(*before, cloud, motion, recorded.name);
      motion = laid.onto_from_cloud;
      registered.world_from_sensor.push_back(registered.world_from_sensor.back() * motion);
      residuals_m.push_back(laid.residual_m);
    }
    before = cloud;
  }
  if (residuals_m.size() < 2) return registered;
  const auto worst = std::ranges::max_element(residuals_m);
  registered.worst_residual_m = *worst;
  registered.worst_frame = static_cast<std::size_t>(worst - residuals_m.begin());
  residuals_m.erase(residuals_m.begin());  // The first frame has nothing to be laid on.
  std::ranges::nth_element(
      residuals_m, residuals_m.begin() + static_cast<std::ptrdiff_t>(residuals_m.size() / 2));
  registered.median_residual_m = residuals_m[residuals_m.size() / 2];
  return registered;
}

}  // namespace railcast
