#include "generator/extras/insert/plan/standing_things.h"

#include <pcl/sample_consensus/mlesac.h>
#include <pcl/sample_consensus/sac_model_perpendicular_plane.h>
#include <pcl/sample_consensus/impl/mlesac.hpp>
#include <pcl/sample_consensus/impl/sac_model_perpendicular_plane.hpp>
#include <pcl/sample_consensus/impl/sac_model_plane.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/units.h"
#include "core/points/point_alignment.h"
#include "core/points/point_spread.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

constexpr double kNearestSensor_m = 3.0;
constexpr double kFarthestSensor_m = 60.0;
constexpr std::size_t kMostFrames = 8;
/// Circles about a place, of which the smallest with enough points counts.
constexpr std::array<double, 3> kRadii_m = {0.75, 1.5, 3.0};
constexpr std::size_t kFewestPoints = 15;
constexpr std::size_t kMostPoints = 5'000;
/// How far the ground may be below and above the rails.
constexpr double kDeepest_m = 8.0;
constexpr double kHighest_m = 1.5;

/// Points about a place, relative to it.
using LocalCloud = pcl::PointCloud<pcl::PointXYZ>;

/// The frames to read, and for each the places to look at.
std::map<std::size_t, std::vector<std::size_t>> PlacesOfFrames(
    const RecordedWay& way,
    const Transform& vehicle_from_sensor,
    const std::vector<Vector3>& places_m) {
  std::map<std::size_t, std::vector<std::size_t>> places_of;
  for (std::size_t place = 0; place < places_m.size(); ++place) {
    std::vector<std::size_t> near;
    // Sensors look away from what is below their own vehicle, but not those that lie on their side.
    std::vector<std::size_t> nearest;
    for (std::size_t frame = 0; frame < way.at_frames.size(); ++frame) {
      const Vector3 sensor_m = way.at_frames[frame] * vehicle_from_sensor.translation();
      const double distance_m = (sensor_m - places_m[place]).head<2>().norm();
      if (distance_m > kFarthestSensor_m) continue;
      (distance_m < kNearestSensor_m ? nearest : near).push_back(frame);
    }
    if (near.empty()) near = std::move(nearest);
    const std::size_t num_used = std::min(near.size(), kMostFrames);
    for (std::size_t i = 0; i < num_used; ++i) {
      places_of[near[i * near.size() / num_used]].push_back(place);
    }
  }
  return places_of;
}

/// Adds the points of a frame to the places that they are near.
void AddPoints(const RecordedFrame& recorded,
               const RecordedWay& way,
               std::int64_t frame_time_ns,
               const Transform& vehicle_from_sensor,
               const std::vector<Vector3>& places_m,
               const std::vector<std::size_t>& places,
               std::vector<LocalCloud>& clouds) {
  const Frame& frame = recorded.frame;
  const bool has_times = recorded.Has("time_ns") && !way.is_held;
  const Transform world_from_first = way.WorldFromVehicle(frame_time_ns) * vehicle_from_sensor;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (!std::isfinite(frame.range_m[i])) continue;
    const Vector3 point_m(frame.x[i], frame.y[i], frame.z[i]);
    // The motion within the frame changes little: far points need no exact pose.
    const Vector3 about_m = world_from_first * point_m;
    for (const std::size_t place : places) {
      constexpr double kMotion_m = 10.0;
      const Vector3 near_m = about_m - places_m[place];
      if (near_m.head<2>().norm() > kRadii_m.back() + (has_times ? kMotion_m : 0.0)) continue;
      const Vector3 local_m = has_times
                                  ? Vector3(way.WorldFromVehicle(frame_time_ns + frame.time_ns[i]) *
                                                (vehicle_from_sensor * point_m) -
                                            places_m[place])
                                  : near_m;
      if (local_m.head<2>().norm() > kRadii_m.back() || local_m.z() < -kDeepest_m ||
          local_m.z() > kHighest_m || clouds[place].size() == kMostPoints) {
        continue;
      }
      clouds[place].push_back({static_cast<float>(local_m.x()), static_cast<float>(local_m.y()),
                               static_cast<float>(local_m.z())});
    }
  }
}

/// Whether points cover an area in plan. Those of one row of the sensor are on a line, through
/// which many planes go, and which may as well be on a wall.
bool CoverArea(const LocalCloud& cloud, double radius_m) {
  constexpr double kLeastShare = 0.1;
  std::vector<Eigen::Vector3f> in_plan_m;
  for (const pcl::PointXYZ& point : cloud) in_plan_m.emplace_back(point.x, point.y, 0.0F);
  // They do not vary along the vertical, which comes first.
  return SpreadOf(in_plan_m).variances_m2[1] >= std::pow(kLeastShare * radius_m, 2);
}

/// The plane through most of the points, if it goes through enough of them.
RecordedGround FitPlane(const LocalCloud::Ptr& cloud, double radius_m) {
  constexpr double kMostDistance_m = 0.06;
  constexpr double kMostSlope_rad = RadFromDeg(30.0);
  constexpr double kLeastShare = 0.3;
  constexpr int kMostSteps = 500;
  // As pcl::SACSegmentation does it, which brings models of all shapes.
  using PlaneModel = pcl::SampleConsensusModelPerpendicularPlane<pcl::PointXYZ>;
  DropPclMessages();
  const PlaneModel::Ptr model(new PlaneModel(cloud));
  model->setAxis(Eigen::Vector3f::UnitZ());
  model->setEpsAngle(kMostSlope_rad);
  pcl::MaximumLikelihoodSampleConsensus<pcl::PointXYZ> consensus(model, kMostDistance_m);
  consensus.setMaxIterations(kMostSteps);
  if (!consensus.computeModel()) return {};
  pcl::Indices inliers;
  Eigen::VectorXf sampled;
  Eigen::VectorXf plane;
  consensus.getInliers(inliers);
  consensus.getModelCoefficients(sampled);
  model->optimizeModelCoefficients(inliers, sampled, plane);
  model->selectWithinDistance(plane, kMostDistance_m, inliers);
  const auto num_in_plane = static_cast<double>(inliers.size());
  if (inliers.size() < kFewestPoints ||
      num_in_plane < kLeastShare * static_cast<double>(cloud->size()) ||
      !CoverArea(LocalCloud(*cloud, inliers), radius_m)) {
    return {};
  }
  RecordedGround ground;
  Vector3 normal = plane.head<3>().cast<double>();
  double offset_m = plane[3];
  if (normal.z() < 0.0) {
    normal = -normal;
    offset_m = -offset_m;
  }
  offset_m /= normal.norm();
  ground.up = normal.normalized();
  ground.height_m = -offset_m / ground.up.z();
  double sum_m2 = 0.0;
  for (const int index : inliers) {
    const Vector3 point_m =
        (*cloud)[static_cast<std::size_t>(index)].getVector3fMap().cast<double>();
    sum_m2 += std::pow(ground.up.dot(point_m) + offset_m, 2);
  }
  ground.residual_m = std::sqrt(sum_m2 / num_in_plane);
  ground.num_points = inliers.size();
  return ground;
}

RecordedGround GroundIn(const LocalCloud& cloud) {
  for (const double radius_m : kRadii_m) {
    const LocalCloud::Ptr near(new LocalCloud);
    for (const pcl::PointXYZ& point : cloud) {
      if (point.getVector3fMap().head<2>().norm() <= static_cast<float>(radius_m))
        near->push_back(point);
    }
    if (near->size() < kFewestPoints || !CoverArea(*near, radius_m)) continue;
    RecordedGround ground = FitPlane(near, radius_m);
    ground.radius_m = radius_m;
    if (ground.is_found()) return ground;
  }
  return {};
}

}  // namespace

std::vector<RecordedGround> FindGround(const std::filesystem::path& recording,
                                       const RecordedWay& way,
                                       const Transform& vehicle_from_sensor,
                                       const std::vector<Vector3>& places_m) {
  const auto places_of = PlacesOfFrames(way, vehicle_from_sensor, places_m);
  std::vector<LocalCloud> clouds(places_m.size());
  if (!places_of.empty()) {
    const auto opened = OpenRecording(recording);
    for (std::size_t frame = 0; frame <= places_of.rbegin()->first; ++frame) {
      const auto read = opened->Next();
      if (!read) break;
      const auto places = places_of.find(frame);
      if (places == places_of.end()) continue;
      AddPoints((*read)(), way, way.frame_times_ns[frame], vehicle_from_sensor, places_m,
                places->second, clouds);
    }
  }
  std::vector<RecordedGround> found;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    found.push_back(GroundIn(clouds[i]));
    found.back().height_m += places_m[i].z();
  }
  return found;
}

}  // namespace railcast
