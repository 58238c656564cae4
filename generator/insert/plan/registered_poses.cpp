#include "generator/insert/plan/registered_poses.h"

#include "core/io/quiet_pcl.h"

#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/registration/icp.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

using NormalCloud = pcl::PointCloud<pcl::PointNormal>;

/// The points of a frame, thinned so that near ones do not outweigh all others, with the normals of
/// the surfaces that they are on.
NormalCloud::Ptr ThinnedCloud(const RecordedFrame& recorded) {
  constexpr float kCell_m = 0.4F;
  constexpr int kNeighbours = 12;
  const Frame& frame = recorded.frame;
  const NormalCloud::Ptr points(new NormalCloud);
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (!std::isfinite(frame.range_m[i])) continue;
    pcl::PointNormal point;
    point.getVector3fMap() = Eigen::Vector3f(frame.x[i], frame.y[i], frame.z[i]);
    points->push_back(point);
  }
  const NormalCloud::Ptr thinned(new NormalCloud);
  pcl::VoxelGrid<pcl::PointNormal> grid;
  grid.setInputCloud(points);
  grid.setLeafSize(kCell_m, kCell_m, kCell_m);
  grid.filter(*thinned);
  pcl::NormalEstimation<pcl::PointNormal, pcl::PointNormal> normals;
  normals.setInputCloud(thinned);
  normals.setKSearch(kNeighbours);
  normals.compute(*thinned);
  std::erase_if(thinned->points, [](const pcl::PointNormal& point) {
    return !point.getNormalVector3fMap().allFinite();
  });
  thinned->width = static_cast<std::uint32_t>(thinned->points.size());
  return thinned;
}

struct LaidCloud {
  Transform before_from_cloud;
  double residual_m{};
};

/// @param guess Where the cloud is about, in the axes of the one before it.
LaidCloud LayOn(const NormalCloud::Ptr& before,
                const NormalCloud::Ptr& cloud,
                const Transform& guess,
                const std::string& name) {
  constexpr double kMostDistance_m = 2.0;
  constexpr int kMostSteps = 60;
  constexpr std::size_t kFewest = 100;
  if (std::min(before->size(), cloud->size()) < kFewest) {
    throw InputError(name + ": must have at least " + NumberText(kFewest) +
                     " points in cells of 0.4 m to be laid on the frame before it" +
                     Got(std::min(before->size(), cloud->size())));
  }
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> icp;
  icp.setInputSource(cloud);
  icp.setInputTarget(before);
  icp.setMaxCorrespondenceDistance(kMostDistance_m);
  icp.setMaximumIterations(kMostSteps);
  icp.setTransformationEpsilon(1e-8);
  NormalCloud laid;
  icp.align(laid, guess.matrix().cast<float>());
  const double residual_m = std::sqrt(icp.getFitnessScore(kMostDistance_m * kMostDistance_m));
  constexpr double kMostResidual_m = 1.0;
  if (!icp.hasConverged() || !(residual_m <= kMostResidual_m)) {
    throw InputError(name + ": must fit the frame before it to 1 m" + " (got " +
                     ShortText(residual_m) + " m)");
  }
  const Eigen::Matrix4d found = icp.getFinalTransformation().cast<double>();
  const Eigen::Quaterniond turn(Eigen::Matrix3d(found.topLeftCorner<3, 3>()));
  return {MakeTransform(turn.normalized().toRotationMatrix(), found.topRightCorner<3, 1>()),
          residual_m};
}

}  // namespace

RegisteredPoses RegisterClouds(const std::filesystem::path& recording,
                               const Transform& vehicle_from_sensor) {
  const auto opened = OpenRecording(recording);
  RegisteredPoses registered;
  std::vector<double> residuals_m;
  NormalCloud::Ptr before;
  Transform motion = Transform::Identity();  // From one frame to the next, as the last one was.
  while (const auto read = opened->Next()) {
    const RecordedFrame recorded = (*read)();
    const NormalCloud::Ptr cloud = ThinnedCloud(recorded);
    if (!before) {
      registered.world_from_sensor.push_back(vehicle_from_sensor);
      residuals_m.push_back(0.0);
    } else {
      const LaidCloud laid = LayOn(before, cloud, motion, recorded.name);
      motion = laid.before_from_cloud;
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
