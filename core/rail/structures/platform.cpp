#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/text.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/rail/clearance/clear_space.h"
#include "core/rail/network/turnout_place.h"
#include "core/rail/structures/structure_track.h"
#include "core/rail/structures/structures.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

/// The slab at the edge overhangs the wall below it.
constexpr double kNoseHeight_m = 0.12;
constexpr double kNoseDepth_m = 0.08;
/// The wall's foot below top of rail; the ground lies 0.7 m below it.
constexpr double kPlatformFoot_m = 1.3;

/// Up to 160 km/h, passengers keep 2.5 m from the track's axis; the strip lies behind that line
/// and is 0.3 m wide (DIN 32984), with ribs of 4 mm.
constexpr double kDangerZone_m = 2.5;
constexpr double kStripWidth_m = 0.3;
constexpr double kStripHeight_m = 0.004;
constexpr double kStripBevel_m = 0.01;

constexpr double kRoofDepth_m = 0.25;
constexpr double kRoofRise_m = 0.3;  ///< Height of the roof's edges above its valley.
/// Distance of the roof's edge from the platform's edge, and from the platform's back.
constexpr double kRoofFromEdge_m = 0.5;
constexpr double kRoofFromBack_m = 0.1;
constexpr double kColumnWidth_m = 0.2;

/// The platform's cross-section: y from its edge towards its back, z from its top.
Outline BodyOutline(const PlatformSpec& platform) {
  const double foot_m = -(platform.height_m + kPlatformFoot_m);
  return {{0.0, 0.0},
          {0.0, -kNoseHeight_m},
          {kNoseDepth_m, -kNoseHeight_m},
          {kNoseDepth_m, foot_m},
          {platform.width_m, foot_m},
          {platform.width_m, 0.0}};
}

std::optional<Outline> StripOutline(const PlatformSpec& platform) {
  const double begin_m = std::max(0.0, kDangerZone_m - platform.edge_distance_m);
  const double end_m = begin_m + kStripWidth_m;
  if (!platform.has_edge_strip || end_m > platform.width_m) return std::nullopt;
  return Outline{{begin_m, 0.0},
                 {begin_m + kStripBevel_m, kStripHeight_m},
                 {end_m - kStripBevel_m, kStripHeight_m},
                 {end_m, 0.0}};
}

/// Ramps at the ends: 1:12, down to 0.1 m above the ends of concrete sleepers.
constexpr double kRampSlope = 1.0 / 12.0;
constexpr double kRampFoot_m = -0.08;

double RampLength_m(const PlatformSpec& platform) {
  if (!platform.has_ramps) return 0.0;
  const double half_m = 0.5 * (platform.end_s_m - platform.begin_s_m);
  return std::min(half_m, (platform.height_m - kRampFoot_m) / kRampSlope);
}

/// The part between the ramps.
ChainageRange LevelRange(const PlatformSpec& platform) {
  const double ramp_m = RampLength_m(platform);
  return {.begin_s_m = platform.begin_s_m + ramp_m, .end_s_m = platform.end_s_m - ramp_m};
}

/// Height of the edge above top of rail.
double EdgeHeight_m(const PlatformSpec& platform, double s_m) {
  if (!platform.has_ramps) return platform.height_m;
  const double from_end_m = std::min(s_m - platform.begin_s_m, platform.end_s_m - s_m);
  return std::min(platform.height_m, kRampFoot_m + kRampSlope * std::max(0.0, from_end_m));
}

ChainageRange RoofRange(const PlatformSpec& platform) {
  const ChainageRange level = LevelRange(platform);
  return {.begin_s_m = platform.roof->begin_s_m.value_or(level.begin_s_m),
          .end_s_m = platform.roof->end_s_m.value_or(level.end_s_m)};
}

/// A roof with its valley over the columns.
Outline RoofOutline(const PlatformSpec& platform) {
  const double front_m = std::min(kRoofFromEdge_m, 0.25 * platform.width_m);
  const double back_m = platform.width_m - kRoofFromBack_m;
  const double middle_m = 0.5 * platform.width_m;
  const double low_m = platform.roof->height_m;
  const double high_m = low_m + kRoofRise_m;
  return {{front_m, high_m},
          {middle_m, low_m},
          {back_m, high_m},
          {back_m, high_m + kRoofDepth_m},
          {middle_m, low_m + kRoofDepth_m},
          {front_m, high_m + kRoofDepth_m}};
}

/// Curvature of the track's axis over the 20 m about a chainage, left positive.
double MeanCurvatureAt(const Alignment& alignment, const TrackCourse& track, double s_m) {
  constexpr double kHalf_m = 10.0;
  const auto place_at = [&](double at_s_m) {
    return Vector3(track.WorldFromTrack(alignment, at_s_m).translation());
  };
  // Beyond its ends the line is straight.
  const double from_s_m = std::max(0.0, s_m - kHalf_m);
  const double to_s_m = std::min(alignment.length_m(), s_m + kHalf_m);
  const double turn_rad =
      track.Heading_rad(alignment, to_s_m) - track.Heading_rad(alignment, from_s_m);
  return turn_rad / (place_at(to_s_m) - place_at(from_s_m)).head<2>().norm();
}

/// The frame of a platform's edge. Outside a canted curve, the lower corner of the upright nose
/// would be nearer to the axis than the edge, which stands back as much.
Transform EdgeFrameAt(const ChunkContext& context,
                      const StructureTrack& track,
                      const PlatformSpec& platform,
                      double s_m) {
  const double side = SignOf(platform.side);
  const double nose_m = kNoseHeight_m * std::sin(context.alignment.At(s_m).cant_rad);
  const double edge_m = platform.edge_distance_m +
                        PlatformWidening_m(context.alignment, track.course(), side, s_m) +
                        std::max(0.0, side * nose_m);
  return track.UprightAt(s_m, side * edge_m, EdgeHeight_m(platform, s_m));
}

/// Adds what has one cross-section, in the frame of the platform's edge.
class PlatformBuilder {
 public:
  PlatformBuilder(const ChunkContext& context, const PlatformSpec& platform)
      : context_(context), platform_(platform), track_(context, platform.track) {}

  void Add(Chunk& chunk) const {
    const ChainageRange level = LevelRange(platform_);
    const StructureSurfaces& surfaces = context_.surfaces.structures;
    Mesh& concrete = MeshOf(surfaces.platform, chunk.ground);
    Sweep(level, BodyOutline(platform_), concrete);
    if (platform_.has_ramps) {
      Sweep({platform_.begin_s_m, level.begin_s_m}, BodyOutline(platform_), concrete);
      Sweep({level.end_s_m, platform_.end_s_m}, BodyOutline(platform_), concrete);
    }
    if (const auto strip = StripOutline(platform_)) {
      Sweep(level, *strip, MeshOf(surfaces.platform_strip, chunk.ground));
    }
    if (!platform_.roof) return;
    Mesh& steel = MeshOf(surfaces.platform_roof, chunk.ground);
    Sweep(RoofRange(platform_), RoofOutline(platform_), steel);
    AddColumns(steel);
  }

 private:
  [[nodiscard]] Transform EdgeAt(double s_m) const {
    return EdgeFrameAt(context_, track_, platform_, s_m);
  }

  void Sweep(const ChainageRange& range, const Outline& outline_m, Mesh& mesh) const {
    const double side = SignOf(platform_.side);
    const double farthest_m = side * (platform_.edge_distance_m + platform_.width_m);
    const auto stretch =
        StretchInChunk(track_, range, farthest_m, [&](double s_m) { return EdgeAt(s_m); });
    if (stretch) AppendSweptSolid(*stretch, OnSide(outline_m, side), mesh);
  }

  void AddColumns(Mesh& mesh) const {
    const double half_m = 0.5 * kColumnWidth_m;
    const ChainageRange roof = RoofRange(platform_);
    const double end_m = std::min(1.0, 0.25 * (roof.end_s_m - roof.begin_s_m));
    const Mesh column = MakeBox(
        {Vector3(-half_m, -half_m, 0.0), Vector3(half_m, half_m, platform_.roof->height_m)});
    const double middle_m = SignOf(platform_.side) * 0.5 * platform_.width_m;
    for (const double s_m :
         track_.Places({.begin_s_m = roof.begin_s_m + end_m, .end_s_m = roof.end_s_m - end_m},
                       platform_.roof->column_spacing_m)) {
      mesh.Append(column, EdgeAt(s_m) * Eigen::Translation3d(0.0, middle_m, 0.0));
    }
  }

  const ChunkContext& context_;
  const PlatformSpec& platform_;
  StructureTrack track_;
};

}  // namespace

void AddStructure(const ChunkContext& context, const PlatformSpec& platform, Chunk& chunk) {
  PlatformBuilder(context, platform).Add(chunk);
}

double PlatformWidening_m(const Alignment& alignment,
                          const TrackCourse& track,
                          double side,
                          double s_m) {
  return CurveWidening_m(MeanCurvatureAt(alignment, track, s_m), side);
}

std::optional<double> PlatformTop_m(const ChunkContext& context,
                                    const PlatformSpec& platform,
                                    double s_m,
                                    double d_m) {
  if (s_m < platform.begin_s_m || s_m > platform.end_s_m) return std::nullopt;
  const StructureTrack track(context, platform.track);
  const double side = SignOf(platform.side);
  const Transform upright = track.Upright(s_m);
  const Transform chunk_from_edge = EdgeFrameAt(context, track, platform, s_m);
  const double edge_m = (upright.inverse() * chunk_from_edge.translation()).y();
  const double behind_edge_m = side * (d_m - track.offset_m(s_m) - edge_m);
  if (behind_edge_m < 0.0 || behind_edge_m > platform.width_m) return std::nullopt;
  return (context.chunk_from_world.inverse() * chunk_from_edge.translation()).z();
}

std::vector<ClearedArea> ClearedBy(const PlatformSpec& platform) {
  return ClearedBeside(platform, platform.edge_distance_m,
                       platform.edge_distance_m + platform.width_m);
}

void CheckShape(const StructurePlace& place, const PlatformSpec& platform, WorldFaults& faults) {
  if (!platform.roof || !faults.AreKnown({place.pointer})) return;
  const ChainageRange roof = RoofRange(platform);
  const ChainageRange level = LevelRange(platform);
  if (!(roof.begin_s_m >= level.begin_s_m && roof.end_s_m <= level.end_s_m &&
        roof.begin_s_m < roof.end_s_m)) {
    if (level.begin_s_m >= level.end_s_m) {
      return faults.Add(place.pointer + "/roof",
                        "must not be given, since the ramps leave no level part of the platform",
                        StretchText(platform.begin_s_m, platform.end_s_m));
    }
    faults.Add(place.pointer + "/roof",
               (platform.has_ramps ? "must lie between the platform's ramps, "
                                   : "must lie on the platform, ") +
                   StretchText(level.begin_s_m, level.end_s_m),
               StretchText(roof.begin_s_m, roof.end_s_m));
  }
}

}  // namespace railcast
