#include "core/points/point_alignment.h"

#include <pcl/console/print.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/registration/icp.h>
#include <pcl/features/impl/normal_3d.hpp>
#include <pcl/filters/impl/voxel_grid.hpp>

#include <cmath>

#include "core/base/error.h"

namespace railcast {
namespace {

using NormalCloud = pcl::PointCloud<pcl::PointNormal>;

}  // namespace

struct ThinnedCloud::Points {
  NormalCloud::Ptr cloud;
};

ThinnedCloud::ThinnedCloud(const std::vector<Eigen::Vector3f>& points_m) {
  constexpr auto kEdge_m = static_cast<float>(kCell_m);
  constexpr int kNeighbours = 12;
  const NormalCloud::Ptr points(new NormalCloud);
  for (const Eigen::Vector3f& point_m : points_m) {
    points->emplace_back().getVector3fMap() = point_m;
  }
  const NormalCloud::Ptr thinned(new NormalCloud);
  pcl::VoxelGrid<pcl::PointNormal> grid;
  grid.setInputCloud(points);
  grid.setLeafSize(kEdge_m, kEdge_m, kEdge_m);
  grid.filter(*thinned);
  pcl::NormalEstimation<pcl::PointNormal, pcl::PointNormal> normals;
  normals.setInputCloud(thinned);
  normals.setKSearch(kNeighbours);
  normals.compute(*thinned);
  std::erase_if(thinned->points, [](const pcl::PointNormal& point) {
    return !point.getNormalVector3fMap().allFinite();
  });
  thinned->width = static_cast<std::uint32_t>(thinned->points.size());
  points_ = std::make_shared<const Points>(Points{thinned});
}

std::size_t ThinnedCloud::size() const {
  return points_->cloud->size();
}

std::optional<LaidCloud> LayOn(const ThinnedCloud& onto,
                               const ThinnedCloud& cloud,
                               const Transform& guess) {
  constexpr double kMostDistance_m = 2.0;
  constexpr int kMostSteps = 60;
  Check(std::min(onto.size(), cloud.size()) >= kFewestLaid, "clouds that are laid have points");
  DropPclMessages();
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> icp;
  icp.setInputSource(cloud.points()->cloud);
  icp.setInputTarget(onto.points()->cloud);
  icp.setMaxCorrespondenceDistance(kMostDistance_m);
  icp.setMaximumIterations(kMostSteps);
  icp.setTransformationEpsilon(1e-8);
  NormalCloud laid;
  icp.align(laid, guess.matrix().cast<float>());
  if (!icp.hasConverged()) return std::nullopt;
  const Eigen::Matrix4d found = icp.getFinalTransformation().cast<double>();
  const Eigen::Quaterniond turn(Eigen::Matrix3d(found.topLeftCorner<3, 3>()));
  return LaidCloud{
      MakeTransform(turn.normalized().toRotationMatrix(), found.topRightCorner<3, 1>()),
      std::sqrt(icp.getFitnessScore(kMostDistance_m * kMostDistance_m))};
}

void DropPclMessages() {
  static const bool is_dropped = [] {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
    return true;
  }();
  static_cast<void>(is_dropped);
}

}  // namespace railcast
