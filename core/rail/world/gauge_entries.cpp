#include "core/rail/world/gauge_entries.h"

#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <type_traits>
#include <utility>

#include "core/rail/chunk/chunk_grid.h"
#include "core/rail/chunk/sweep.h"
#include "core/rail/clearance/structure_gauge.h"
#include "core/rail/line/line_place.h"
#include "core/rail/network/network.h"
#include "core/rail/network/route.h"
#include "core/rail/network/world_tracks.h"
#include "core/rail/structures/structures.h"
#include "core/rail/traffic/train_places.h"

namespace railcast {
namespace {

constexpr double kLeastDepth_m = 1e-3;
/// Triangles that reach farther along the track are divided. In a curve of 150 m radius, the chord
/// of such a piece is 3 mm off.
constexpr double kLongestPiece_m = 2.0;
/// Triangles are not divided below this size.
constexpr double kLeastPiece_m = 0.1;
/// Of platforms' edges: chords of the platform and of such pieces.
constexpr double kEdgeTolerance_m = 5e-3;
/// The edge is looked for within this height; the wall below stands back.
constexpr double kAboutEdge_m = 0.12;
/// No part of the gauge is farther from its track's axis.
constexpr double kGaugeReach_m = 2.5;

using Triangle = std::array<Vector3, 3>;

/// A point of a triangle, as seen from the line and in the world.
struct Corner : PlaceBesideLine {
  Vector3 place_m;
};
using Corners = std::array<Corner, 3>;

Corner CornerAt(const Alignment& alignment, const Vector3& place_m, double near_s_m) {
  return {PlaceOnLine(alignment, place_m, near_s_m), place_m};
}

/// The part of a polygon on one side of a line parallel to an axis (Sutherland, Hodgman 1974).
/// @param axis 0: what has x up to the limit is left; 1: y.
/// @param sign -1: what has at least the limit is left instead.
std::vector<Eigen::Vector2d> Clipped(const std::vector<Eigen::Vector2d>& polygon,
                                     int axis,
                                     double limit,
                                     double sign) {
  std::vector<Eigen::Vector2d> inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    const double from_a = sign * (limit - a[axis]);
    const double from_b = sign * (limit - b[axis]);
    if (from_a >= 0.0) inside.push_back(a);
    if ((from_a >= 0.0) != (from_b >= 0.0)) {
      inside.emplace_back(a + from_a / (from_a - from_b) * (b - a));
    }
  }
  return inside;
}

/// Collects what one thing has in the gauge of one track.
class GaugeProbe {
 public:
  /// @param platform If it measures one, for which the gauge is wider.
  GaugeProbe(const WorldTracks& tracks,
             std::size_t track,
             const Alignment& alignment,
             const PlatformSpec* platform)
      : track_(tracks.world.tracks[track]),
        course_(tracks.courses[track]),
        alignment_(alignment),
        platform_(platform),
        gauge_(StructureGauge(ContactHeightOver_m(track_, tracks.world.catenary))) {
    for (const GaugePart& part : gauge_) top_m_ = std::max(top_m_, part.top_m);
  }

  /// Whether something within bounds of chainage and offset may be in the gauge anywhere. Until the
  /// next call, all triangles must be parts of that.
  bool MayReach(const Eigen::AlignedBox2d& bounds_m) {
    const double begin_s_m = std::max(bounds_m.min().x(), course_.begin_s_m());
    const double end_s_m = std::min(bounds_m.max().x(), course_.end_s_m());
    if (begin_s_m > end_s_m) return false;
    const auto at_m = [&](double step, double num_steps) {
      return num_steps > 0.0 ? std::lerp(begin_s_m, end_s_m, step / num_steps) : begin_s_m;
    };
    constexpr double kStep_m = 5.0;
    double least_m = std::numeric_limits<double>::infinity();
    double most_m = -least_m;
    const double num_steps = std::ceil((end_s_m - begin_s_m) / kStep_m);
    for (double step = 0.0; step <= num_steps; ++step) {
      const double d_m = course_.OffsetWithin_m(at_m(step, num_steps));
      least_m = std::min(least_m, d_m);
      most_m = std::max(most_m, d_m);
    }
    // What differs between its places and the track's cross-sections: their angle, cant, gradients,
    // and what a track goes aside between samples.
    constexpr double kMargin_m = 6.0;
    const double reach_m = kGaugeReach_m + kMargin_m;
    if (bounds_m.min().y() > most_m + reach_m || bounds_m.max().y() < least_m - reach_m)
      return false;
    constexpr double kCurveStep_m = 2.0;
    constexpr double kBetweenSamples = 1.2;
    sharpest_per_m_ = 0.0;
    const double num_curves = std::ceil((end_s_m - begin_s_m) / kCurveStep_m);
    for (double step = 0.0; step <= num_curves; ++step) {
      const double curvature_per_m = course_.CurvatureAt(alignment_, at_m(step, num_curves));
      sharpest_per_m_ = std::max(sharpest_per_m_, kBetweenSamples * std::abs(curvature_per_m));
    }
    return true;
  }

  [[nodiscard]] std::size_t num_comparisons() const { return num_comparisons_; }

  /// @pre MayReach was true for what it is a part of.
  void Add(const Corners& triangle) {
    ++num_comparisons_;
    const auto [first, last] = std::ranges::minmax(triangle, {}, &Corner::s_m);
    if (last.s_m < course_.begin_s_m() || first.s_m > course_.end_s_m()) return;
    const double length_m = last.s_m - first.s_m;
    if (IsSurelyOutside(triangle, length_m)) return;
    const double middle_s_m = 0.5 * (first.s_m + last.s_m);
    const Transform track_from_world = course_.WorldFromTrack(alignment_, middle_s_m).inverse();
    Triangle here;
    std::ranges::transform(triangle, here.begin(),
                           [&](const Corner& corner) { return track_from_world * corner.place_m; });
    if (IsFar(here)) return;
    if (length_m > kLongestPiece_m) return Divide(triangle);
    for (const GaugePart& part : gauge_) Measure(here, part, middle_s_m);
    if (platform_ != nullptr) MeasurePlatform(here, middle_s_m);
  }

  [[nodiscard]] std::optional<GaugeEntry> Entry(const std::string& name) const {
    if (!(entry_.depth_m > kLeastDepth_m)) return std::nullopt;
    GaugeEntry entry = entry_;
    entry.name = name;
    entry.track = track_.name;
    constexpr int kClear_m = 5;
    for (const int at_m : metres_) {
      if (entry.stretches.empty() || at_m > entry.stretches.back().end_s_m + kClear_m) {
        entry.stretches.push_back({std::max<double>(at_m, entry.begin_s_m), 0.0});
      }
      entry.stretches.back().end_s_m = std::min(at_m + 1.0, entry.end_s_m);
    }
    return entry;
  }

 private:
  /// Whether the triangle is outside the gauge wherever the track lies between its outermost
  /// offsets. Does not need the track's frame, but allows a metre for what differs from it.
  [[nodiscard]] bool IsSurelyOutside(const Corners& triangle, double length_m) const {
    constexpr double kMargin_m = 1.0;
    constexpr double kSteepest = 0.1;  // Of gradients and cant.
    const auto [rightmost, leftmost] = std::ranges::minmax(triangle, {}, &Corner::d_m);
    const double reach_m =
        kGaugeReach_m + kMargin_m + length_m + length_m * length_m / alignment_.tightest_radius_m();
    if (rightmost.d_m > course_.most_d_m() + reach_m) return true;
    if (leftmost.d_m < course_.least_d_m() - reach_m) return true;
    const double width_m =
        std::max(leftmost.d_m - course_.least_d_m(), course_.most_d_m() - rightmost.d_m);
    const double lowest_m = std::ranges::min(triangle, {}, &Corner::h_m).h_m;
    return lowest_m > top_m_ + kMargin_m + kSteepest * (length_m + width_m);
  }
  /// Whether the triangle is on one side of the gauge, allowing for a curve along its length: an
  /// arc that touches the track's axis is k x^2 / (1 + sqrt(1 - k^2 x^2)) beside it after x m, that
  /// is L^2 / 8 R at both ends of a chord of L, and the gauge is turned by as much as its
  /// direction.
  [[nodiscard]] bool IsFar(const Triangle& here) const {
    constexpr double kMargin_m = 0.1;
    constexpr double kSharpestTurn = 0.7;
    double along_m = 0.0;
    for (const Vector3& corner : here) along_m = std::max(along_m, std::abs(corner.x()));
    const double turn = sharpest_per_m_ * along_m;
    if (turn > kSharpestTurn) return false;
    const double cosine = std::sqrt(1.0 - turn * turn);
    const double reach_m = kGaugeReach_m / cosine + turn * along_m / (1.0 + cosine) + kMargin_m;
    const auto is_beyond = [&](double sign) {
      return std::ranges::all_of(
          here, [&](const Vector3& corner) { return sign * corner.y() > reach_m; });
    };
    return is_beyond(1.0) || is_beyond(-1.0);
  }

  // Halves the edge that is longest along the track.
  void Divide(const Corners& triangle) {
    std::size_t longest = 0;
    const auto length_m = [&](std::size_t i) {
      return std::abs(triangle[(i + 1) % 3].s_m - triangle[i].s_m);
    };
    for (std::size_t i = 1; i < 3; ++i) {
      if (length_m(i) > length_m(longest)) longest = i;
    }
    const std::size_t next = (longest + 1) % 3;
    // Beyond the centre of a curve, chainages of neighbouring places are far apart.
    if ((triangle[next].place_m - triangle[longest].place_m).norm() < kLeastPiece_m) return;
    const Corner middle =
        CornerAt(alignment_, 0.5 * (triangle[longest].place_m + triangle[next].place_m),
                 0.5 * (triangle[longest].s_m + triangle[next].s_m));
    for (const std::size_t replaced : {longest, next}) {
      Corners half = triangle;
      half[replaced] = middle;
      Add(half);
    }
  }

  /// Platforms stand farther from the axis than the gauge of wagons reaches.
  void MeasurePlatform(const Triangle& here, double s_m) {
    const double side = here[0].y() > 0.0 ? 1.0 : -1.0;
    const double edge_m = kLeastPlatformEdge_m - kEdgeTolerance_m +
                          PlatformWidening_m(alignment_, course_, side, s_m);
    const double top_m = platform_->height_m + kAboutEdge_m;
    Measure(here, {edge_m, platform_->height_m - kAboutEdge_m, top_m}, s_m);
  }

  void Measure(const Triangle& here, const GaugePart& part, double s_m) {
    std::vector<Eigen::Vector2d> polygon;
    for (const Vector3& corner : here) polygon.emplace_back(corner.y(), corner.z());
    polygon = Clipped(polygon, 0, part.half_width_m, 1.0);
    polygon = Clipped(polygon, 0, -part.half_width_m, -1.0);
    polygon = Clipped(polygon, 1, part.top_m, 1.0);
    polygon = Clipped(polygon, 1, part.bottom_m, -1.0);
    if (polygon.empty()) return;
    Eigen::AlignedBox2d inside_m;  // Right to left and bottom to top.
    for (const Eigen::Vector2d& point : polygon) inside_m.extend(point);
    const double bottom_m = inside_m.min().y();
    const double top_m = inside_m.max().y();
    const double from_axis_m = std::max({0.0, inside_m.min().x(), -inside_m.max().x()});
    const double depth_m = part.half_width_m - from_axis_m;
    // What only touches the gauge from above or below is not in it.
    const bool touches =
        top_m - part.bottom_m < kLeastDepth_m || part.top_m - bottom_m < kLeastDepth_m;
    if (depth_m <= kLeastDepth_m || touches) return;
    if (entry_.depth_m == 0.0) {
      entry_.begin_s_m = entry_.end_s_m = s_m;
      entry_.bottom_m = bottom_m;
      entry_.top_m = top_m;
    }
    metres_.insert(static_cast<int>(std::floor(s_m)));
    entry_.begin_s_m = std::min(entry_.begin_s_m, s_m);
    entry_.end_s_m = std::max(entry_.end_s_m, s_m);
    entry_.bottom_m = std::max(0.0, std::min(entry_.bottom_m, bottom_m));
    entry_.top_m = std::max(entry_.top_m, top_m);
    if (depth_m > entry_.depth_m) {
      entry_.depth_m = depth_m;
      entry_.deepest_s_m = s_m;
    }
  }

  const TrackSpec& track_;
  const TrackCourse& course_;
  const Alignment& alignment_;
  const PlatformSpec* platform_;
  std::vector<GaugePart> gauge_;
  double top_m_ = 0.0;
  double sharpest_per_m_ = 0.0;  ///< Of the track where it is compared with something.
  std::size_t num_comparisons_ = 0;
  GaugeEntry entry_;
  std::set<int> metres_;  ///< Of chainage, with something of it in the gauge.
};

/// Probes for all tracks.
class Probes {
 public:
  /// @param own_tracks Names of tracks to leave out.
  /// @param platform If it is one that is probed.
  Probes(const WorldTracks& tracks,
         const Alignment& alignment,
         const std::vector<std::string>& own_tracks = {},
         const PlatformSpec* platform = nullptr)
      : alignment_(alignment) {
    for (std::size_t i = 0; i < tracks.courses.size(); ++i) {
      const std::string& name = tracks.world.tracks[i].name;
      const bool is_own = std::ranges::find(own_tracks, name) != own_tracks.end();
      if (!is_own) probes_.emplace_back(tracks, i, alignment, platform);
    }
  }

  void Add(const Model& model, const Transform& world_from_model, double guess_s_m) {
    for (const Part& part : model.parts) {
      std::vector<Corner> corners;
      for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
        corners.push_back(
            CornerAt(alignment_, world_from_model * vertex.cast<double>(), guess_s_m));
        guess_s_m = corners.back().s_m;
      }
      const Eigen::AlignedBox2d bounds_m = BoundsOf(corners, part.mesh.triangles);
      for (GaugeProbe& probe : probes_) {
        if (!probe.MayReach(bounds_m)) continue;
        for (const auto& [a, b, c] : part.mesh.triangles) {
          probe.Add({corners[a], corners[b], corners[c]});
        }
      }
    }
  }

  [[nodiscard]] std::size_t num_comparisons() const {
    std::size_t num = 0;
    for (const GaugeProbe& probe : probes_) num += probe.num_comparisons();
    return num;
  }

  void Report(const std::string& name, std::vector<GaugeEntry>& entries) const {
    for (const GaugeProbe& probe : probes_) {
      if (auto entry = probe.Entry(name)) entries.push_back(std::move(*entry));
    }
  }

 private:
  /// In chainage and offset, as far as chords of curves may reach.
  template <class Triangles>
  [[nodiscard]] Eigen::AlignedBox2d BoundsOf(const std::vector<Corner>& corners,
                                             const Triangles& triangles) const {
    Eigen::AlignedBox2d bounds_m;
    for (const Corner& corner : corners) {
      bounds_m.extend(Eigen::Vector2d(corner.s_m, corner.d_m));
    }
    double longest_m = 0.0;
    for (const auto& [a, b, c] : triangles) {
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
        longest_m = std::max(longest_m, (corners[to].place_m - corners[from].place_m).norm());
      }
    }
    const double sagitta_m = longest_m * longest_m / (8.0 * alignment_.tightest_radius_m());
    bounds_m.min().y() -= sagitta_m;
    bounds_m.max().y() += sagitta_m;
    return bounds_m;
  }

  const Alignment& alignment_;
  std::vector<GaugeProbe> probes_;
};

template <class Structure>
void ProbeStructure(const Structure& structure,
                    const WorldTracks& tracks,
                    const Alignment& alignment,
                    const ChunkGrid& grid,
                    Probes& probes) {
  const RailSurfaces surfaces;
  double first_s_m = 0.0;
  double last_s_m = alignment.length_m();
  if constexpr (std::is_base_of_v<StretchSpec, Structure>) {
    first_s_m = structure.begin_s_m;
    last_s_m = structure.end_s_m;
  } else if constexpr (std::is_base_of_v<PointSpec, Structure>) {
    // It stands in the chunk of its place, and reaches a few metres along the track.
    first_s_m = structure.s_m - RailWorld::kChunkLength_m;
    last_s_m = structure.s_m + RailWorld::kChunkLength_m;
  }
  const int last = grid.ChunkAt(last_s_m);
  for (int chunk = grid.ChunkAt(first_s_m); chunk <= last; ++chunk) {
    const Transform world_from_chunk = grid.WorldFromChunk(chunk);
    const double begin_s_m = grid.BeginOf(chunk);
    const double end_s_m = grid.EndOf(chunk);
    const ChunkContext context{.spec = tracks.world,
                               .alignment = alignment,
                               .tracks = tracks.courses,
                               .turnouts = {},
                               .surfaces = surfaces,
                               .seed = tracks.world.seed,
                               .chunk = chunk,
                               .begin_s_m = begin_s_m,
                               .end_s_m = end_s_m,
                               .chunk_from_world = world_from_chunk.inverse()};
    Chunk built;
    AddStructure(context, structure, built);
    const double middle_s_m = 0.5 * (begin_s_m + end_s_m);
    probes.Add(built.ground, world_from_chunk, middle_s_m);
    for (const Placement& placement : built.placements) {
      Transform chunk_from_model;
      chunk_from_model.matrix() = placement.chunk_from_model.matrix();
      probes.Add(*placement.model, world_from_chunk * chunk_from_model, middle_s_m);
    }
  }
}

/// The structure as it stands; barriers that move, at their lowest.
template <class Structure>
Structure AtRest(Structure structure) {
  if constexpr (std::is_same_v<Structure, LevelCrossingSpec>) {
    std::vector<TimedValue>& angles_deg = structure.barrier_angles_deg;
    if (!angles_deg.empty()) {
      structure.barrier_angle_deg =
          std::ranges::min_element(angles_deg, {}, &TimedValue::value)->value;
      angles_deg.clear();
    }
  }
  return structure;
}

/// Names of the tracks of an object's route on which a wagon there has its wheels.
std::vector<std::string> TracksUnder(const RailWorld& world, std::size_t object, double s_m) {
  constexpr double kHalfWagon_m = 10.0;
  std::vector<std::string> names;
  for (const RouteSection& section : world.object_route(object).sections) {
    if (s_m + kHalfWagon_m < section.begin_s_m || s_m - kHalfWagon_m > section.end_s_m) continue;
    names.push_back(world.tracks()[section.track].name);
  }
  return names;
}

std::vector<GaugeEntry> EntriesOfObject(const WorldTracks& tracks,
                                        const RailWorld& world,
                                        std::size_t object,
                                        bool is_on_its_track,
                                        std::int64_t time_ns) {
  const double s_m = world.ObjectChainage_m(object, time_ns);
  std::vector<std::string> own_tracks;
  if (is_on_its_track) own_tracks = TracksUnder(world, object, s_m);
  Probes probes(tracks, world.alignment(), own_tracks);
  const SceneObject& probed = world.objects()[object];
  probes.Add(*probed.model, world.WorldFromObject(object, time_ns), s_m);
  std::vector<GaugeEntry> entries;
  probes.Report(probed.name, entries);
  return entries;
}

}  // namespace

std::vector<GaugeEntry> FindObjectInGauge(const WorldSpec& given_spec,
                                          const RailWorld& world,
                                          std::size_t object,
                                          bool is_on_its_track,
                                          std::int64_t time_ns) {
  WorldSpec spec = given_spec;
  spec.tracks = world.tracks();
  const WorldTracks tracks{spec, world.network().courses};
  return EntriesOfObject(tracks, world, object, is_on_its_track, time_ns);
}

StructuresInGauge FindStructuresInGauge(const WorldSpec& spec,
                                        const Alignment& alignment,
                                        std::span<const TrackCourse> courses) {
  const WorldTracks tracks{spec, courses};
  const ChunkGrid grid(alignment, RailWorld::kChunkLength_m, spec.terrain.half_width_m);
  std::vector<StructuresInGauge> of_structures(spec.structures.size());
  oneapi::tbb::parallel_for(std::size_t{0}, spec.structures.size(), [&](std::size_t i) {
    std::visit(
        [&]<class Structure>(const Structure& given) {
          std::vector<std::string> own_tracks;
          if (kBelongsIntoGauge<Structure>) own_tracks.push_back(given.track);
          const PlatformSpec* platform = nullptr;
          if constexpr (std::is_same_v<Structure, PlatformSpec>) platform = &given;
          Probes probes(tracks, alignment, own_tracks, platform);
          ProbeStructure(AtRest(given), tracks, alignment, grid, probes);
          probes.Report(given.name, of_structures[i].entries);
          of_structures[i].num_comparisons = probes.num_comparisons();
        },
        spec.structures[i]);
  });
  StructuresInGauge all;
  for (const StructuresInGauge& some : of_structures) {
    all.entries.insert(all.entries.end(), some.entries.begin(), some.entries.end());
    all.num_comparisons += some.num_comparisons;
  }
  return all;
}

std::vector<GaugeEntry> FindGaugeEntries(const WorldSpec& given_spec, const RailWorld& world) {
  WorldSpec spec = given_spec;
  spec.tracks = world.tracks();
  const WorldTracks tracks{spec, world.network().courses};
  std::vector<GaugeEntry> entries =
      FindStructuresInGauge(spec, world.alignment(), world.network().courses).entries;
  const std::size_t num_objects = spec.objects.size();
  for (std::size_t i = 0; i < num_objects + NumVehicles(spec.trains); ++i) {
    if (world.objects()[i].moves) continue;
    // A wagon on its rails is where it belongs, but it may stand foul of another track.
    const bool is_on_its_track =
        i >= num_objects || (IsRailVehicle(spec.objects[i].type) && spec.objects[i].d_m == 0.0);
    for (GaugeEntry& entry : EntriesOfObject(tracks, world, i, is_on_its_track, 0)) {
      entries.push_back(std::move(entry));
    }
  }
  return entries;
}

}  // namespace railcast
