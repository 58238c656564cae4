#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_perpendicular_plane.h>
#include <pcl/sample_consensus/impl/ransac.hpp>
#include <pcl/sample_consensus/impl/sac_model_perpendicular_plane.hpp>
#include <pcl/sample_consensus/impl/sac_model_plane.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/base/units.h"
#include "core/points/point_alignment.h"
#include "core/track/track_search.h"

namespace railcast {
namespace {

using PlaneCloud = pcl::PointCloud<pcl::PointXYZ>;
using PlaneModel = pcl::SampleConsensusModelPlane<pcl::PointXYZ>;
using LevelModel = pcl::SampleConsensusModelPerpendicularPlane<pcl::PointXYZ>;

constexpr double kPlane_m = 0.12;  ///< Ballast, sleepers and heads are within it.

/// One point for each cube of 0.3 m, so that area counts, not nearness.
PlaneCloud::Ptr Thinned(const std::vector<Eigen::Vector3f>& points_m) {
  constexpr float kFarthest_m = 30.0F;
  constexpr float kCell_m = 0.3F;
  std::vector<std::pair<std::uint64_t, std::size_t>> cells;
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    if (points_m[i].norm() > kFarthest_m) continue;
    const Eigen::Vector3i cell = (points_m[i] / kCell_m).array().floor().cast<int>() + 512;
    const auto number = [&](int axis) { return static_cast<std::uint64_t>(cell[axis]); };
    cells.emplace_back(number(0) << 32 | number(1) << 16 | number(2), i);
  }
  std::ranges::sort(cells);
  const PlaneCloud::Ptr cloud(new PlaneCloud);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0 && cells[i].first == cells[i - 1].first) continue;
    const Eigen::Vector3f& point_m = points_m[cells[i].second];
    cloud->push_back({point_m.x(), point_m.y(), point_m.z()});
  }
  return cloud;
}

/// The plane that most points are in; takes these out of the cloud.
std::optional<Vector3> TakePlane(const PlaneModel::Ptr& model, PlaneCloud& cloud) {
  pcl::RandomSampleConsensus<pcl::PointXYZ> consensus(model, kPlane_m);
  consensus.setMaxIterations(300);
  if (!consensus.computeModel()) return std::nullopt;
  pcl::Indices inliers;
  Eigen::VectorXf sampled;
  Eigen::VectorXf plane;
  consensus.getInliers(inliers);
  consensus.getModelCoefficients(sampled);
  model->optimizeModelCoefficients(inliers, sampled, plane);
  // Up is where the sensor is.
  const Vector3 normal = plane.head<3>().cast<double>().normalized() * (plane[3] < 0.0F ? -1 : 1);
  PlaneCloud rest;
  for (const pcl::PointXYZ& point : cloud) {
    const float off_m = plane.head<3>().dot(point.getVector3fMap()) + plane[3];
    if (std::abs(off_m) > static_cast<float>(kPlane_m)) rest.push_back(point);
  }
  cloud = rest;
  return normal;
}

Eigen::Matrix3d AxesWithUp(const Vector3& up) {
  const Vector3 ahead =
      std::abs(up.x()) < 0.8 ? Vector3(Vector3::UnitX()) : Vector3(Vector3::UnitY());
  const Vector3 left = up.cross(ahead).normalized();
  Eigen::Matrix3d axes;
  axes << left.cross(up).transpose(), left.transpose(), up.transpose();
  return axes;
}

}  // namespace

std::vector<Eigen::Matrix3d> FindGroundAxes(const std::vector<Eigen::Vector3f>& points_m) {
  constexpr std::size_t kFewestPoints = 30;
  constexpr int kMostPlanes = 3;
  std::vector<Eigen::Matrix3d> axes;
  DropPclMessages();
  const PlaneCloud::Ptr all = Thinned(points_m);
  if (all->size() < kFewestPoints) return axes;
  const PlaneCloud::Ptr level(new PlaneCloud(*all));
  const LevelModel::Ptr model(new LevelModel(level));
  model->setAxis(Eigen::Vector3f::UnitZ());
  model->setEpsAngle(RadFromDeg(35.0));
  if (const auto up = TakePlane(model, *level)) axes.push_back(AxesWithUp(*up));
  const PlaneCloud::Ptr rest(new PlaneCloud(*all));
  for (int i = 0; i < kMostPlanes && rest->size() >= kFewestPoints; ++i) {
    const auto up = TakePlane(PlaneModel::Ptr(new PlaneModel(rest)), *rest);
    if (!up) break;
    if (up->z() < std::cos(RadFromDeg(35.0))) axes.push_back(AxesWithUp(*up));
  }
  return axes;
}

}  // namespace railcast
