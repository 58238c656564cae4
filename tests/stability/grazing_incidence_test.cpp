// From 80 to 89.99 degrees of incidence, a small error across the surface becomes an error along
// the beam, divided by the cosine: 1 um across is 6 mm along at 89.99 degrees. What counts is how
// many micrometres a method loses across the surface. One quad of kilometres, the usual ground of a
// simple scene, loses a thousand times as much as ground in cells about a near origin.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/rail/chunk/sweep.h"
#include "core/rail/line/rail_section.h"
#include "tests/stability/regime.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/frame_checks.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr std::array kIncidences_deg = {80.0, 85.0, 88.0, 89.0, 89.5, 89.9, 89.99};
/// Range at which the middle beam meets the surface.
constexpr double kRange_m = 100.0;

/// The surfaces lie oblique in their chunk, as on a slope in a curve, because z = 0 would hide
/// rounding.
Transform ChunkFromSurface() {
  return MakeTransform(RotationFromYawPitchRoll(0.3, -0.025, 0.03), {0.7, -0.4, -1.7});
}

Mesh InChunk(const Mesh& surface) {
  Mesh mesh;
  mesh.Append(surface, ChunkFromSurface());
  return mesh;
}

/// Ground at z = 0 in cells of 1 m by 0.5 m, as chunks build it: 130 m long and 16 m wide.
Mesh Cells() {
  std::vector<Vector3> points_m;
  constexpr std::size_t kColumns = 33;
  for (int row = 0; row <= 130; ++row) {
    for (std::size_t column = 0; column < kColumns; ++column) {
      points_m.emplace_back(row, 0.5 * static_cast<double>(column) - 8.0, 0.0);
    }
  }
  return MeshOfGrid(points_m, kColumns, [](std::size_t, std::size_t) { return true; });
}

struct GrazingErrors {
  std::size_t num_hits = 0;
  std::size_t num_disagreeing = 0;  ///< Either the closed form or the trace hits, but not both.
  double along_m = 0.0;             ///< Largest error of the range.
  double across_m = 0.0;            ///< Largest error across the surface.
  double incidence_rad = 0.0;
};

/// Where a beam meets a surface that extends along x, in the surface's frame.
struct Meeting {
  double range_m = std::nan("");  ///< NaN: nowhere.
  double cosine{};
  bool is_at_border = false;  ///< On the border of two facets, rounding may choose either.
};
using ClosedForm = std::function<Meeting(const Vector3& origin_m, const Vector3& direction)>;

/// Sends a row of beams along x at the surface, from such a height above the point (0, `aim_y_m`,
/// 0) that the middle one meets z = 0 at the incidence asked for.
GrazingErrors CompareSurface(const Mesh& surface,
                             double incidence_deg,
                             double aim_y_m,
                             const ScanPattern& pattern,
                             const ClosedForm& closed_form) {
  const double pitch_rad = RadFromDeg(90.0 - incidence_deg);
  const Transform surface_from_sensor =
      MakeTransform(RotationFromYawPitchRoll(0.0, pitch_rad, 0.0),
                    {0.3, aim_y_m, kRange_m * std::sin(pitch_rad)});
  const auto world = WorldOfParts({{InChunk(surface), 2, 2}});
  world->chunk_from_vehicle = ChunkFromSurface() * surface_from_sensor;
  const Frame frame = ScanOnce(world, pattern);
  ExpectSoundSlots(frame, 0.5F, 300.0F);
  GrazingErrors errors;
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const std::size_t slot = pattern.row[i] * pattern.columns + pattern.column[i];
    const Vector3 direction = surface_from_sensor.linear() * DirectionOf(pattern, i);
    const Meeting truth = closed_form(surface_from_sensor.translation(), direction);
    if (std::isnan(truth.range_m) || frame.label[slot] == 0) {
      errors.num_disagreeing += std::isnan(truth.range_m) != (frame.label[slot] == 0) ? 1 : 0;
      continue;
    }
    if (truth.is_at_border) continue;
    const double error_m = std::abs(static_cast<double>(frame.range_m[slot]) - truth.range_m);
    const double incidence_rad = static_cast<double>(frame.incidence_rad[slot]);
    ++errors.num_hits;
    errors.along_m = std::max(errors.along_m, error_m);
    errors.across_m = std::max(errors.across_m, error_m * truth.cosine);
    errors.incidence_rad =
        std::max(errors.incidence_rad, std::abs(incidence_rad - std::acos(truth.cosine)));
  }
  return errors;
}

Meeting OnPlane(const Vector3& origin_m, const Vector3& direction) {
  return {-origin_m.z() / direction.z(), -direction.z()};
}

std::string DegreesOf(double incidence_deg) {
  std::ostringstream text;
  text << incidence_deg << "°";
  return text.str();
}

// The beam's direction and the range itself are rounded by some 1e-7 of 100 m; the corners of the
// mesh by 4e-6 m along the line, of which its slope of 0.04 leaves less than 1 um across.
double Tolerance_m(double incidence_deg) {
  return 5e-5 + 1.5e-6 / std::cos(RadFromDeg(incidence_deg));
}

TEST(GrazingIncidence, OnGroundIsRightAcrossTheSurfaceUpToTheLastHundredthOfADegree) {
  const Mesh cells = Cells();
  const Mesh quad = MakeFloor(0.0F, 20'000.0F);
  const ScanPattern pattern = MakeRaster(4, 0.01, 0.01);
  for (const double incidence_deg : kIncidences_deg) {
    const GrazingErrors ours = CompareSurface(cells, incidence_deg, 0.1, pattern, OnPlane);
    const GrazingErrors simple = CompareSurface(quad, incidence_deg, 0.1, pattern, OnPlane);
    if (incidence_deg == 89.0 || incidence_deg > 89.5) {
      RecordRegime("ground 100 m away under " + DegreesOf(incidence_deg),
                   {"one quad of 40 km: " + TwoDigits(1e3 * simple.along_m) + " mm along the beam",
                    TwoDigits(1e3 * ours.along_m) + " mm, incidence to " +
                        TwoDigits(1e6 * ours.incidence_rad) + " µrad"});
    }
    EXPECT_EQ(ours.num_hits, 400U);
    EXPECT_LE(ours.along_m, Tolerance_m(incidence_deg));
    // Cells of half a metre lean by 1 um at most; the arc cosine adds 5e-7 rad.
    EXPECT_LE(ours.incidence_rad, 2e-6);
    if (incidence_deg >= 89.0) {
      EXPECT_GT(simple.along_m, 10.0 * Tolerance_m(incidence_deg));
    }
  }
}

/// A rail's running band along x with its crown at y = z = 0, and the closed form of where a beam
/// meets it, with plane facets between the section's points.
struct Band {
  std::vector<Eigen::Vector2d> outline_m;

  [[nodiscard]] Mesh Swept() const {
    std::vector<Transform> stations;
    for (double x_m = 0.0; x_m <= 130.0; x_m += 2.5) {
      stations.push_back(MakeTransform(Eigen::Matrix3d::Identity(), {x_m, 0.0, 0.0}));
    }
    Mesh mesh;
    AppendSweep(stations, outline_m, mesh);
    return mesh;
  }

  [[nodiscard]] Meeting operator()(const Vector3& origin_m, const Vector3& direction) const {
    Meeting nearest;
    for (std::size_t i = 0; i + 1 < outline_m.size(); ++i) {
      const Eigen::Vector2d along = (outline_m[i + 1] - outline_m[i]).normalized();
      const Eigen::Vector2d normal(-along.y(), along.x());
      const double cosine = -normal.dot(direction.tail<2>());
      const double range_m = normal.dot(origin_m.tail<2>() - outline_m[i]) / cosine;
      const Vector3 place_m = origin_m + range_m * direction;
      const double part = along.dot(place_m.tail<2>() - outline_m[i]);
      const double width_m = (outline_m[i + 1] - outline_m[i]).norm();
      if (!(range_m > 0.0 && part >= 0.0 && part <= width_m && place_m.x() <= 130.0)) continue;
      constexpr double kBorder_m = 1e-4;
      // The comparison is false while `nearest` is still NaN.
      if (range_m >= nearest.range_m) continue;
      nearest = {range_m, std::abs(cosine), std::min(part, width_m - part) < kBorder_m};
    }
    return nearest;
  }
};

Band RunningBand() {
  const RailSection section = MakeRailSection(true);
  Band band;
  for (std::size_t i = section.head_first; i <= section.head_last; ++i) {
    band.outline_m.push_back(section.outline_m[i]);
  }
  const auto crown = std::max_element(band.outline_m.begin(), band.outline_m.end(),
                                      [](const auto& a, const auto& b) { return a.y() < b.y(); });
  const Eigen::Vector2d crown_m = *crown;
  for (Eigen::Vector2d& point : band.outline_m) point -= crown_m;
  return band;
}

// At 89.99 degrees, a facet of 7 mm by 2.5 m covers 3e-6 m2 across the beam, less than float32 can
// tell from 0 at 100 m. Some beams take the neighbouring facet, which is still right across to 0.2
// mm but off along the beam by decimetres.
TEST(GrazingIncidence, OnARailsRunningBandIsRightAcrossTheSurface) {
  const Band band = RunningBand();
  const Mesh rail = band.Swept();
  // 52 mm are 0.03 degrees at 100 m.
  const ScanPattern pattern = MakeRaster(0.04, 0.0005, 0.0001);
  for (const double incidence_deg : kIncidences_deg) {
    const GrazingErrors ours = CompareSurface(rail, incidence_deg, 0.0, pattern, band);
    if (incidence_deg > 89.5) {
      RecordRegime("a rail's running band 100 m away under " + DegreesOf(incidence_deg),
                   {"-", TwoDigits(1e3 * ours.along_m) + " mm along the beam, " +
                             TwoDigits(1e6 * ours.across_m) + " µm across, incidence to " +
                             TwoDigits(1e6 * ours.incidence_rad) + " µrad"});
    }
    EXPECT_GT(ours.num_hits, 500U);
    EXPECT_LE(ours.num_disagreeing, 20U);
    EXPECT_LE(ours.across_m, 2e-4);
    EXPECT_LE(ours.incidence_rad, 1e-4);
    if (incidence_deg <= 89.9) {
      EXPECT_LE(ours.along_m, Tolerance_m(incidence_deg));
      EXPECT_LE(ours.incidence_rad, 1e-5);
    }
  }
}

}  // namespace
}  // namespace railcast
