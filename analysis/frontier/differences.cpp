#include "analysis/frontier/differences.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace railcast {
namespace {

using Sums = EchoesByRange::Sums;

Estimate EstimateOf(const RelativeChange& change, double num_echoes) {
  return {change.change, change.change - change.margin, change.change + change.margin,
          static_cast<std::uint64_t>(num_echoes)};
}

Estimate ChangeOfNumber(const std::vector<Sums>& full,
                        const std::vector<Sums>& coarser,
                        double Sums::*of) {
  const double num = TotalOf(full, of);
  const bool is_enough = num >= kLeastDetailEchoes && full.size() >= kLeastDetailFrames;
  if (!is_enough || TotalOf(coarser, of) == 0.0) return NotEnough(static_cast<std::uint64_t>(num));
  return EstimateOf(ChangeOfSum(full, coarser, of), num);
}

Estimate ChangeOfMean(const std::vector<Sums>& full, const std::vector<Sums>& coarser) {
  const double num = TotalOf(full, &Sums::first);
  const bool is_enough = num >= kLeastDetailEchoes && full.size() >= kLeastDetailFrames;
  if (!is_enough || TotalOf(coarser, &Sums::first) == 0.0) {
    return NotEnough(static_cast<std::uint64_t>(num));
  }
  return EstimateOf(ChangeOfIntensity(full, coarser), num);
}

using PointsPerInstance = std::unordered_map<std::uint32_t, std::uint32_t>;

PointsPerInstance CountPoints(const Frame& frame) {
  PointsPerInstance points;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (frame.outcome[slot] == Outcome::kReturned) ++points[frame.instance[slot]];
  }
  return points;
}

std::uint32_t PointsOn(const PointsPerInstance& points, std::uint32_t instance) {
  const auto found = points.find(instance);
  return found == points.end() ? 0 : found->second;
}

double BoxDistance_m(const Simulator& simulator, std::size_t object, const Frame& frame) {
  const World& world = simulator.world();
  const Vector3 sensor_m = world.WorldFromObject(object, frame.stamp_ns).inverse() *
                           simulator.WorldFromSensor(frame.stamp_ns).translation();
  return world.objects()[object].model->Bounds().exteriorDistance(sensor_m);
}

}  // namespace

std::vector<DetailDifference> DifferencesOfDetail(const EchoesByRange& full,
                                                  const EchoesByRange& coarser) {
  std::vector<DetailDifference> differences;
  for (const auto& [label, bin] : full.Places()) {
    const std::vector<Sums>& of_full = full.Of(label, bin);
    // A coarser scene that has no echo there at all: as many frames without any.
    std::vector<Sums> of_coarser = coarser.Of(label, bin);
    of_coarser.resize(of_full.size());
    if (TotalOf(of_full, &Sums::first) < kLeastDetailEchoes) continue;
    differences.push_back({label, bin, ChangeOfNumber(of_full, of_coarser, &Sums::first),
                           ChangeOfNumber(of_full, of_coarser, &Sums::further),
                           ChangeOfMean(of_full, of_coarser)});
  }
  return differences;
}

double DetectionDistance_m(const Approach& approach,
                           std::uint32_t ApproachPoints::*points,
                           std::uint32_t min_points) {
  const auto& frames = approach.points;
  const auto first = std::ranges::find_if(
      frames, [&](const ApproachPoints& frame) { return frame.*points >= min_points; });
  if (first == frames.end()) return 0.0;
  if (first == frames.begin()) return std::nan("");
  const ApproachPoints& before = *(first - 1);
  // A frame without any point counts as one with half of one.
  const double few = std::log(std::max(static_cast<double>(before.*points), 0.5));
  const double enough = std::log(static_cast<double>(min_points));
  const double share = (enough - few) / (std::log(static_cast<double>((*first).*points)) - few);
  return before.distance_m * std::pow(first->distance_m / before.distance_m, share);
}

double DetectionDistanceError(const std::vector<Approach>& approaches) {
  double sum = 0.0;
  int num = 0;
  for (const Approach& approach : approaches) {
    const double expected_m = DetectionDistance_m(approach, &ApproachPoints::points_in_reference);
    if (!(expected_m > 0.0)) continue;
    double found_m = DetectionDistance_m(approach, &ApproachPoints::points);
    // Enough points in the first frame: at least from there on.
    if (std::isnan(found_m)) found_m = approach.points.front().distance_m;
    sum += std::abs(found_m / expected_m - 1.0);
    ++num;
  }
  return num == 0 ? std::nan("") : sum / num;
}

std::vector<Approach> ApproachesIn(const World& world) {
  std::vector<Approach> approaches;
  for (const SceneObject& object : world.objects()) {
    if (!object.is_ego) approaches.push_back({object.name, object.instance, {}});
  }
  return approaches;
}

void AddApproach(const Simulator& simulator,
                 const Frame& reference,
                 const Frame& other,
                 std::vector<Approach>& approaches) {
  const PointsPerInstance in_reference = CountPoints(reference);
  const PointsPerInstance in_other = CountPoints(other);
  std::size_t next = 0;
  const std::vector<SceneObject>& objects = simulator.world().objects();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].is_ego) continue;
    Approach& approach = approaches[next++];
    const double distance_m = BoxDistance_m(simulator, i, reference);
    const bool is_nearer =
        approach.points.empty() || distance_m < approach.points.back().distance_m;
    if (!is_nearer) continue;
    approach.points.push_back({distance_m, PointsOn(in_reference, approach.instance),
                               PointsOn(in_other, approach.instance)});
  }
}

}  // namespace railcast
