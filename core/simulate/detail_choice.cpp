#include "core/simulate/detail_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "core/base/units.h"

namespace railcast {
namespace {

double ScaleOf(const Eigen::Affine3d& window_from_model) {
  return window_from_model.linear().col(2).norm();
}

}  // namespace

DetailRule DetailOf(const SimulatorSpec& spec, const ScanPattern& pattern) {
  const DetectorSpec& detector = spec.detector;
  if (spec.has_full_detail || detector.effects.dense_footprint) return {};
  const auto& [horizontal_mrad, vertical_mrad] = detector.beam.divergence_mrad;
  const double beam_mrad =
      detector.effects.footprint ? std::min(horizontal_mrad, vertical_mrad) : 0.0;
  return {.vehicle_from_sensor = spec.vehicle_from_sensor,
          .ray_spacing_rad = RaySpacing_rad(pattern),
          .beam_width_rad = 1e-3 * beam_mrad,
          .sector = SectorOf(pattern, spec.vehicle_from_sensor)};
}

double RaySpacing_rad(const ScanPattern& pattern) {
  // Cells of equal area: equal steps of azimuth and of the sine of the elevation.
  const double step_rad = RadFromDeg(1.0);
  std::map<std::pair<int, int>, std::size_t> num_in_cell;
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const auto x = static_cast<double>(pattern.direction_x[i]);
    const auto y = static_cast<double>(pattern.direction_y[i]);
    const auto z = static_cast<double>(pattern.direction_z[i]);
    ++num_in_cell[{static_cast<int>(std::floor(std::atan2(y, x) / step_rad)),
                   static_cast<int>(std::floor(z / step_rad))}];
  }
  std::vector<std::size_t> densities;
  for (const auto& [cell, num] : num_in_cell) densities.push_back(num);
  std::sort(densities.begin(), densities.end(), std::greater<>());
  std::size_t num_denser = 0;
  for (const std::size_t density : densities) {
    num_denser += density;
    if (10 * num_denser >= pattern.num_firings()) {
      return step_rad / std::sqrt(static_cast<double>(density));
    }
  }
  return 0.0;
}

ScanSector SectorOf(const ScanPattern& pattern, const Transform& vehicle_from_sensor) {
  constexpr double kSteepest = 0.5;
  constexpr double kMargin_rad = RadFromDeg(5.0);
  constexpr int kNumCells = 360;
  if (!pattern.repeats()) return {};
  std::array<bool, kNumCells> is_seen{};
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const Vector3 direction =
        vehicle_from_sensor.linear() *
        Eigen::Vector3f(pattern.direction_x[i], pattern.direction_y[i], pattern.direction_z[i])
            .cast<double>();
    if (std::abs(direction.z()) > kSteepest) return {};
    const double turns = std::atan2(direction.y(), direction.x()) / (2.0 * std::numbers::pi);
    const auto cell = static_cast<int>(std::floor(kNumCells * (turns + 1.0)));
    is_seen[static_cast<std::size_t>(cell % kNumCells)] = true;
  }
  // The longest gap, whose other side is the sector.
  int longest = 0;
  int end_of_longest = 0;
  int length = 0;
  for (int cell = 0; cell < 2 * kNumCells; ++cell) {
    length = is_seen[static_cast<std::size_t>(cell % kNumCells)] ? 0 : length + 1;
    if (length <= longest || length > kNumCells) continue;
    longest = length;
    end_of_longest = cell + 1;
  }
  const double cell_rad = 2.0 * std::numbers::pi / kNumCells;
  const double half_rad = 0.5 * (kNumCells - longest) * cell_rad;
  return {.middle_rad = end_of_longest * cell_rad + half_rad,
          .half_width_rad = half_rad + kMargin_rad};
}

std::int64_t CoarserPoseStep_ns(const DetailRule& rule,
                                double distance_m,
                                std::int64_t pose_step_ns) {
  constexpr double kPoseError_m = 2e-3;
  constexpr double kShare = 1.0 / 8.0;
  const double angle_rad = rule.beam_width_rad > 0.0
                               ? std::min(rule.beam_width_rad, rule.ray_spacing_rad)
                               : rule.ray_spacing_rad;
  const double error_m = kShare * angle_rad * std::max(distance_m, 0.0);
  return static_cast<std::int64_t>(static_cast<double>(pose_step_ns) *
                                   std::sqrt(std::max(1.0, error_m / kPoseError_m)));
}

DetailChoice::DetailChoice(const World& world, int home_chunk, const DetailRule& rule)
    : rule_(rule) {
  if (!(rule.ray_spacing_rad > 0.0)) return;
  const Transform window_from_world = world.WorldFromChunk(home_chunk).inverse();
  for (const Transform& world_from_vehicle : world.VehiclePosesIn(home_chunk)) {
    const Transform window_from_vehicle = window_from_world * world_from_vehicle;
    sensors_window_m_.emplace_back((window_from_vehicle * rule.vehicle_from_sensor).translation());
    sights_window_.emplace_back(
        window_from_vehicle.linear() *
        Vector3(std::cos(rule.sector.middle_rad), std::sin(rule.sector.middle_rad), 0.0));
  }
}

double DetailChoice::Distance_m(const Placement& placement,
                                const Eigen::Affine3d& window_from_model) {
  const auto [box, is_new] = boxes_.try_emplace(placement.model.get());
  if (is_new) box->second = placement.model->Bounds();
  const Eigen::Affine3d model_from_window = window_from_model.inverse();
  double distance2 = std::numeric_limits<double>::infinity();
  for (const Vector3& sensor_m : sensors_window_m_) {
    distance2 = std::min(
        distance2, box->second.squaredExteriorDistance(Vector3(model_from_window * sensor_m)));
  }
  return std::sqrt(distance2) * ScaleOf(window_from_model);
}

bool DetailChoice::Permits(double ray_spacing_m, double beam_width_m, double distance_m) const {
  return ray_spacing_m <= rule_.ray_spacing_rad * distance_m &&
         (!(rule_.beam_width_rad > 0.0) || beam_width_m <= rule_.beam_width_rad * distance_m);
}

bool DetailChoice::TakesCoarser(const CoarserSurfaces& surfaces,
                                const Transform& chunk_from_window) const {
  const auto permits = [&](const Vector3& sensor_window_m) {
    const Eigen::Vector2d place_m = (chunk_from_window * sensor_window_m).head<2>();
    return std::abs(place_m.y()) <= std::tan(surfaces.sight_angle_rad) * std::abs(place_m.x()) &&
           Permits(surfaces.ray_spacing_m, surfaces.beam_width_m,
                   surfaces.area_m.exteriorDistance(place_m));
  };
  return std::ranges::all_of(sensors_window_m_, permits);
}

bool DetailChoice::IsInSight(const Eigen::AlignedBox2d& area_m,
                             const Transform& chunk_from_window) const {
  if (rule_.sector.half_width_rad >= 0.5 * std::numbers::pi) return true;
  const double sine = std::sin(rule_.sector.half_width_rad);
  const double cosine = std::cos(rule_.sector.half_width_rad);
  for (std::size_t i = 0; i < sensors_window_m_.size(); ++i) {
    const Eigen::Vector2d place_m = (chunk_from_window * sensors_window_m_[i]).head<2>();
    const Eigen::Vector2d ahead = (chunk_from_window.linear() * sights_window_[i]).head<2>();
    // Whether the whole area lies behind the sensor, or beyond one of the sector's sides.
    double nearest_ahead_m = -std::numeric_limits<double>::infinity();
    double beyond_left_m = std::numeric_limits<double>::infinity();
    double beyond_right_m = beyond_left_m;
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector2d corner_m =
          area_m.corner(static_cast<Eigen::AlignedBox2d::CornerType>(k)) - place_m;
      const double ahead_m = corner_m.dot(ahead);
      const double left_m = ahead.x() * corner_m.y() - ahead.y() * corner_m.x();
      nearest_ahead_m = std::max(nearest_ahead_m, ahead_m);
      beyond_left_m = std::min(beyond_left_m, cosine * left_m - sine * ahead_m);
      beyond_right_m = std::min(beyond_right_m, -cosine * left_m - sine * ahead_m);
    }
    if (nearest_ahead_m > 0.0 && beyond_left_m < 0.0 && beyond_right_m < 0.0) return true;
  }
  return false;
}

std::size_t DetailChoice::LevelOf(std::span<const CoarserSurfaces> forms,
                                  const Transform& window_from_chunk) const {
  if (forms.empty() || sensors_window_m_.empty()) return 0;
  const Transform chunk_from_window = window_from_chunk.inverse();
  if (!IsInSight(forms.back().area_m, chunk_from_window)) return forms.size();
  const auto too_coarse = std::ranges::find_if_not(
      forms, [&](const CoarserSurfaces& form) { return TakesCoarser(form, chunk_from_window); });
  return static_cast<std::size_t>(too_coarse - forms.begin());
}

std::size_t DetailChoice::LevelOf(const Placement& placement,
                                  const Eigen::Affine3d& window_from_model) {
  if (placement.coarser == nullptr || sensors_window_m_.empty()) return 0;
  // Limits are those of the model's own size, and its scale shortens the distance to it.
  const double distance = Distance_m(placement, window_from_model) / ScaleOf(window_from_model);
  const auto permits = [&](const CoarserModel& coarser) {
    return Permits(coarser.ray_spacing_m, coarser.beam_width_m, distance);
  };
  const auto too_coarse =
      std::find_if_not(placement.coarser->begin(), placement.coarser->end(), permits);
  return static_cast<std::size_t>(too_coarse - placement.coarser->begin());
}

}  // namespace railcast
