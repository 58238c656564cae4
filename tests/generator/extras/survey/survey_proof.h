#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <unordered_map>
#include <vector>

#include "railcast/transform.h"

namespace railcast {

/// Recorded points in cubes of 0.25 m.
class RecordedCells {
 public:
  void Add(const Vector3& point_m) { points_of_cell_[KeyOf(point_m)].push_back(point_m); }
  /// The number of points in the cell of a place and those that touch it.
  [[nodiscard]] int NumAbout(const Vector3& place_m) const {
    std::size_t num = 0;
    (void)AnyAbout(place_m, [&](const std::vector<Vector3>& points_m) {
      num += points_m.size();
      return false;
    });
    return static_cast<int>(num);
  }
  /// Whether one of these points is so near.
  [[nodiscard]] bool HasWithin(double distance_m, const Vector3& place_m) const {
    return AnyAbout(place_m, [&](const std::vector<Vector3>& points_m) {
      return std::ranges::any_of(points_m, [&](const Vector3& point_m) {
        return (point_m - place_m).norm() <= distance_m;
      });
    });
  }

 private:
  static constexpr double kEdge_m = 0.25;
  static std::int64_t KeyOf(const Vector3& point_m) {
    std::int64_t key = 0;
    for (const double coordinate_m : point_m) {
      key = key * 2'000'000 + std::llround(std::floor(coordinate_m / kEdge_m)) + 1'000'000;
    }
    return key;
  }
  /// Whether the points of one of the cells are so: its own first, where the nearest mostly are.
  template <class AreSo>
  bool AnyAbout(const Vector3& place_m, const AreSo& are_so) const {
    constexpr int kOwn = 13;
    for (int i = 0; i < 27; ++i) {
      const int k = (i + kOwn) % 27;
      const Vector3 offset_m = kEdge_m * Vector3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      const auto found = points_of_cell_.find(KeyOf(place_m + offset_m));
      if (found != points_of_cell_.end() && are_so(found->second)) return true;
    }
    return false;
  }
  std::unordered_map<std::int64_t, std::vector<Vector3>> points_of_cell_;
};

/// A beam that met a surface within the surveyed part: four recorded points, without which there is
/// no surface, lie in its cell and those that touch it.
struct ProvenBeam {
  std::string label;
  double range_m{};
  double incidence_deg{};
  int num_points{};  ///< Recorded in its cell and those that touch it.
  /// Whether a recorded point is no farther from it than the sensor's beams are from each other.
  bool is_within_spacing{};
  double error_m{};  ///< Of the range; NaN if the beam meets nothing in the survey.
};

inline constexpr int kLeastPointsOfSurface = 4;

struct Proven {
  std::size_t num_beams = 0;
  double hit_share = 0.0;
  double near_share = 0.0;  ///< Met something within 0.3 m of where it should.
  double median_error_m = 0.0;
  double upper_error_m = 0.0;  ///< 90 % of the hits have a smaller one.
};

template <class IsWanted>
Proven ProvenBy(const std::vector<ProvenBeam>& beams, const IsWanted& is_wanted) {
  Proven proven;
  std::vector<double> errors_m;
  for (const ProvenBeam& beam : beams) {
    if (!is_wanted(beam)) continue;
    ++proven.num_beams;
    if (std::isfinite(beam.error_m)) errors_m.push_back(std::abs(beam.error_m));
  }
  if (errors_m.empty()) return proven;
  std::ranges::sort(errors_m);
  proven.hit_share = static_cast<double>(errors_m.size()) / static_cast<double>(proven.num_beams);
  const auto num_near = std::ranges::lower_bound(errors_m, 0.3) - errors_m.begin();
  proven.near_share = static_cast<double>(num_near) / static_cast<double>(proven.num_beams);
  proven.median_error_m = errors_m[errors_m.size() / 2];
  proven.upper_error_m = errors_m[errors_m.size() * 9 / 10];
  return proven;
}

inline void PrintRow(const std::string& what, const Proven& proven) {
  if (proven.num_beams < 20) return;
  std::printf("| %s | %zu | %.1f | %.1f | %.1f | %.1f |\n", what.c_str(), proven.num_beams,
              100.0 * proven.hit_share, 100.0 * proven.near_share, 100.0 * proven.median_error_m,
              100.0 * proven.upper_error_m);
}

}  // namespace railcast
