#include "generator/extras/import/lines/line_heights.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rail/line/alignment_course.h"
#include "core/rail/network/world_tracks.h"
#include "generator/extras/import/fit/plan_model.h"
#include "generator/extras/import/heights/profile_fit.h"
#include "generator/extras/import/lines/line_places.h"
#include "generator/extras/import/lines/speed_limits.h"
#include "railcast/alignment.h"

namespace railcast {
namespace {

/// 1 where a line turns left, -1 where it turns right. On a straight, into which the ramp of a cant
/// may reach, that of the nearest curve; 0 if none is near.
double TurnOf(const Alignment& alignment, double s_m) {
  constexpr double kReach_m = 100.0;
  constexpr double kStep_m = 5.0;
  constexpr double kStraight_per_m = 1e-6;
  for (double away_m = 0.0; away_m <= kReach_m; away_m += kStep_m) {
    double sharpest_per_m = 0.0;
    for (const double at_s_m : {s_m - away_m, s_m + away_m}) {
      const double curvature_per_m = alignment.At(at_s_m).curvature_per_m;
      if (std::abs(curvature_per_m) > std::abs(sharpest_per_m)) sharpest_per_m = curvature_per_m;
    }
    if (std::abs(sharpest_per_m) > kStraight_per_m) return std::copysign(1.0, sharpest_per_m);
  }
  return 0.0;
}

/// Whether the middle one of three entries is where a line through the others is.
bool IsBetween(const ChainageValue& a, const ChainageValue& middle, const ChainageValue& b) {
  constexpr double kSame_mm = 0.05;
  const double share = (middle.s_m - a.s_m) / (b.s_m - a.s_m);
  return std::abs(a.value + share * (b.value - a.value) - middle.value) <= kSame_mm;
}

/// Entries of cants, and the last one and the end, are at least that far from each other.
constexpr double kCantSteps_per_m = 10.0;

/// Appends an entry, in the place of the last one if that is where the line through both of its
/// neighbours is; none that is too near to the last one or to the end of the line.
void AppendCant(double s_m, double cant_mm, double length_m, std::vector<ChainageValue>& cants_mm) {
  // An alignment's first entry is at 0.
  const ChainageValue entry{cants_mm.empty() ? 0.0 : RoundedTo(s_m, kCantSteps_per_m), cant_mm};
  if (!cants_mm.empty() && !(entry.s_m > cants_mm.back().s_m)) return;
  if (entry.s_m > length_m - 1.0 / kCantSteps_per_m) return;
  const std::size_t num = cants_mm.size();
  if (num >= 2 && IsBetween(cants_mm[num - 2], cants_mm[num - 1], entry)) cants_mm.pop_back();
  cants_mm.push_back(entry);
}

constexpr double kNearestSamples_m = 20.0;

HeightQuality HeightQualityOf(const Profile& profile, const std::vector<HeightSample>& samples) {
  HeightQuality quality;
  quality.num_points = profile.offsets_m.size();
  std::vector<double> distances_m;
  for (const double offset_m : profile.offsets_m) distances_m.push_back(std::abs(offset_m));
  for (std::size_t i = 0; i < distances_m.size(); ++i) {
    if (distances_m[i] <= kFarHeight_m) continue;
    if (quality.num_far++ == 0) quality.far_s_m = samples[i].s_m;
  }
  std::ranges::sort(distances_m);
  quality.median_m = QuantileOf(distances_m, 0.5);
  quality.p99_m = QuantileOf(distances_m, 0.99);
  quality.num_gradients = profile.gradients_permil.size();
  for (const ChainageValue& gradient : profile.gradients_permil) {
    quality.steepest_permil = std::max(quality.steepest_permil, std::abs(gradient.value));
  }
  quality.least_roundness = profile.least_roundness;
  return quality;
}

void FitHeights(std::vector<HeightSample> samples, ImportedLine& line) {
  std::ranges::stable_sort(samples, {}, &HeightSample::s_m);
  AlignmentSpec& alignment = line.alignment;
  const Profile profile = FitProfile(
      samples,
      {.length_m = line.quality.length_m,
       .sigma_m = line.height_sigma_m,
       .speed_kmph = [&](double s_m) { return SpeedAt_kmph(alignment.speed_limits_kmph, s_m); }});
  alignment.origin_m[2] = profile.start_z_m;
  alignment.gradients_permil = profile.gradients_permil;
  alignment.gradient_smoothing_m = profile.smoothing_m;
  line.height_quality = HeightQualityOf(profile, samples);
}

/// Chainages at which the model's ground may be the line's.
std::vector<double> ChainagesOnGround(const RailMap& map,
                                      const TrackLine& track,
                                      const ImportedLine& line,
                                      double cell_m) {
  const std::vector<LineStretch> apart =
      StretchesWhere(map, track, line.chainages_m, [](const MapTags& tags) {
        return IsThere(TagOf(tags, "bridge")) || IsThere(TagOf(tags, "tunnel"));
      });
  const double step_m = std::max(kNearestSamples_m, cell_m);
  const double num_steps = std::max(1.0, std::floor(line.quality.length_m / step_m));
  std::vector<double> chainages_m;
  for (double step = 0.0; step <= num_steps; ++step) {
    const double s_m = line.quality.length_m * (step / num_steps);
    const bool is_apart = std::ranges::any_of(apart, [&](const LineStretch& stretch) {
      return s_m >= stretch.begin_s_m - cell_m && s_m <= stretch.end_s_m + cell_m;
    });
    if (!is_apart) chainages_m.push_back(s_m);
  }
  return chainages_m;
}

void CheckCovers(const RailMap& map,
                 const std::vector<TrackLine>& tracks,
                 const ElevationMap& elevation) {
  for (const TrackLine& track : tracks) {
    for (const std::size_t i : track.nodes) {
      const MapNode& node = map.nodes[i];
      if (elevation.Covers(node.place_m)) continue;
      throw InputError(elevation.name() + ": must cover the lines to their ends (got none of " +
                       track.name + " at " + NumberText(node.geographic_deg.x()) + ", " +
                       NumberText(node.geographic_deg.y()) + " degrees)");
    }
  }
}

std::vector<HeightSample> HeightsOfModel(const ElevationMap& elevation,
                                         const RailMap& map,
                                         const TrackLine& track,
                                         const ImportedLine& line) {
  const std::vector<double> chainages_m = ChainagesOnGround(map, track, line, elevation.cell_m());
  const Alignment alignment(line.alignment);
  std::vector<Eigen::Vector2d> places_m;
  for (const double s_m : chainages_m) {
    places_m.emplace_back(alignment.At(s_m).position_m.head<2>());
  }
  const std::vector<std::optional<double>> heights_m = elevation.HeightsAt(places_m);
  std::vector<HeightSample> samples;
  for (std::size_t i = 0; i < places_m.size(); ++i) {
    if (heights_m[i]) samples.push_back({chainages_m[i], *heights_m[i]});
  }
  if (samples.empty()) {
    throw InputError(elevation.name() + ": must have a height along each line (got none for " +
                     line.name + ")");
  }
  return samples;
}

std::vector<HeightSample> HeightsOfPoints(const RailMap& map,
                                          const TrackLine& track,
                                          const ImportedLine& line) {
  std::vector<HeightSample> samples;
  for (std::size_t i = 0; i < track.nodes.size(); ++i) {
    const std::optional<double>& height_m = map.nodes[track.nodes[i]].height_m;
    if (height_m) samples.push_back({line.chainages_m[i], *height_m});
  }
  return samples;
}

}  // namespace

bool HasSurveyedCant(const RailMap& map, const TrackLine& track) {
  return std::ranges::any_of(track.nodes,
                             [&](std::size_t node) { return map.nodes[node].cant_mm.has_value(); });
}

void SetCants(const RailMap& map,
              const TrackLine& track,
              std::span<const ChainageRange> level,
              ImportedLine& line) {
  if (!HasSurveyedCant(map, track)) {
    LevelCant(level, line.alignment);
    return;
  }
  const Alignment alignment(line.alignment);
  std::vector<ChainageValue> cants_mm;
  for (std::size_t i = 0; i < track.nodes.size(); ++i) {
    const double cant_mm = map.nodes[track.nodes[i]].cant_mm.value_or(0.0);
    const double s_m = line.chainages_m[i];
    AppendCant(s_m, cant_mm == 0.0 ? 0.0 : TurnOf(alignment, s_m) * cant_mm, alignment.length_m(),
               cants_mm);
  }
  line.alignment.cants_mm = std::move(cants_mm);
}

void LevelCant(std::span<const ChainageRange> level, AlignmentSpec& line) {
  constexpr double kStep_m = 10.0;
  constexpr double kSteps_per_mm = 100.0;
  const Alignment alignment(line);
  const double length_m = alignment.length_m();
  const auto is_in_cant = [&](const ChainageRange& stretch) {
    double s_m = std::max(0.0, stretch.begin_s_m);
    const double end_s_m = std::min(length_m, stretch.end_s_m);
    while (s_m < end_s_m && std::abs(alignment.At(s_m).cant_rad) <= kMostCantAtCrossing_rad) ++s_m;
    return s_m < end_s_m || std::abs(alignment.At(end_s_m).cant_rad) > kMostCantAtCrossing_rad;
  };
  std::vector<ChainageRange> in_cant;
  std::ranges::copy_if(level, std::back_inserter(in_cant), is_in_cant);
  if (in_cant.empty()) return;
  const auto cant_mm = [&](double s_m) {
    double share = 1.0;
    for (const ChainageRange& stretch : in_cant) {
      const double away_m = std::max({0.0, stretch.begin_s_m - s_m, s_m - stretch.end_s_m});
      share = std::min(share, away_m / line.cant_ramp_m);
    }
    const double by_rule_mm =
        -(line.gauge_mm + kRailHeadWidth_mm) * std::sin(alignment.At(s_m).cant_rad);
    return RoundedTo(share * by_rule_mm, kSteps_per_mm);
  };
  std::vector<double> chainages_m;
  for (double s_m = 0.0; s_m < length_m; s_m += kStep_m) chainages_m.push_back(s_m);
  // Between its places, cant is linear: also stretches that were level have places at their ends.
  for (const ChainageRange& stretch : level) {
    for (const double s_m : {stretch.begin_s_m, stretch.end_s_m}) {
      if (s_m > 0.0 && s_m < length_m) chainages_m.push_back(s_m);
    }
  }
  std::ranges::sort(chainages_m);
  for (const double s_m : chainages_m) AppendCant(s_m, cant_mm(s_m), length_m, line.cants_mm);
}

Eigen::AlignedBox2d ElevationBounds(const RailMap& map, const TrackLine& track) {
  constexpr double kMargin_m = 500.0;
  Eigen::AlignedBox2d bounds_m;
  for (const std::size_t node : track.nodes) bounds_m.extend(map.nodes[node].place_m);
  const Eigen::Vector2d margin_m = Eigen::Vector2d::Constant(kMargin_m);
  return {bounds_m.min() - margin_m, bounds_m.max() + margin_m};
}

std::unique_ptr<const ElevationMap> ReadElevation(const std::filesystem::path& file,
                                                  const std::string& crs,
                                                  const MapProjection& projection,
                                                  const RailMap& map,
                                                  const std::vector<TrackLine>& tracks) {
  Eigen::AlignedBox2d bounds_m;
  for (const TrackLine& track : tracks) bounds_m.extend(ElevationBounds(map, track));
  auto elevation = std::make_unique<const ElevationMap>(file, crs, projection, bounds_m);
  CheckCovers(map, tracks, *elevation);
  return elevation;
}

std::optional<std::string> SetHeights(const RailMap& map,
                                      const TrackLine& track,
                                      const ElevationMap* elevation,
                                      ImportedLine& line) {
  std::vector<HeightSample> samples = elevation != nullptr
                                          ? HeightsOfModel(*elevation, map, track, line)
                                          : HeightsOfPoints(map, track, line);
  if (elevation == nullptr && samples.size() < 2) return std::nullopt;
  FitHeights(std::move(samples), line);
  if (line.height_quality->p99_m <= kFarthestHeight_m) return std::nullopt;
  return "its heights must lie within " + NumberText(kFarthestHeight_m) +
         " m of gradients that a railway can have (got " + ShortText(line.height_quality->p99_m) +
         " m for one in a hundred)";
}

}  // namespace railcast
