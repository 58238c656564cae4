#include "viewer/composition/composer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/io/recording/firing_truth.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/recording/scan_table.h"
#include "core/points/nearest_points.h"
#include "core/track/track_survey.h"
#include "railcast/frame.h"
#include "railcast/io/recording.h"
#include "railcast/lidar.h"
#include "railcast/scenario.h"
#include "viewer/color/palette.h"
#include "viewer/composition/coloring.h"
#include "viewer/frames/shown_frame.h"
#include "viewer/overlays/overlays.h"

namespace railcast {
namespace {

std::vector<Eigen::Vector3f> PointsOf(const ShownFrame& shown, const Transform& to_from_own) {
  std::vector<Eigen::Vector3f> points_m;
  points_m.reserve(shown.num_points());
  for (std::size_t i = 0; i < shown.num_points(); ++i) {
    const float* const own_m = shown.positions_m.data() + 3 * i;
    const Vector3 point_m = to_from_own * Eigen::Map<const Eigen::Vector3f>(own_m).cast<double>();
    points_m.emplace_back(point_m.cast<float>());
  }
  return points_m;
}

std::array<double, 2> FitDistances_m(const FieldValues& distances) {
  return {0.0, FitScale(distances)[1]};
}

FieldValues DistancesField(const ShownFrame& of, const ShownFrame& other) {
  const std::vector<float> distances_m = DistancesToNearest_m(of, other);
  return {.kind = FieldValues::Kind::kAmount,
          .title = "to the other's nearest point [m]",
          .values = {distances_m.begin(), distances_m.end()}};
}

// Lists the categories of empty beams for the legend: the firings without a return, by outcome, or
// as one category where the recording has no outcomes.
std::vector<Category> BeamKinds(const RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  std::array<std::size_t, kOutcomeNames.size()> counts{};
  std::size_t num_empty = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); slot += frame.returns) {
    if (!std::isnan(frame.x[slot])) continue;
    ++num_empty;
    ++counts[static_cast<std::size_t>(frame.outcome[slot])];
  }
  if (!HasAllOutcomes(recorded)) {
    return {{.value = 0.0,
             .name = "beams without return",
             .rgb = kUnknownOutcomeRgb,
             .num_points = num_empty}};
  }
  std::vector<Category> kinds;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    const auto outcome = static_cast<Outcome>(i);
    kinds.push_back({.value = static_cast<double>(i),
                     .name = "no return: " + OutcomeTitle(outcome),
                     .rgb = OutcomeRgb(outcome),
                     .num_points = counts[i]});
  }
  return kinds;
}

constexpr double kRingLimit_m = 300.0;
constexpr double kUnknownRange_m = 100.0;

Coloring ColorFrame(const ShownFrame& shown, const RecordingInfo& info, const Choices& choices) {
  return AtPlace(shown.recorded->name + ": ", [&] {
    const FieldValues field = ValuesOf(shown, choices.color_by);
    if (field.kind == FieldValues::Kind::kCategory) {
      return ColorByCategory(field, choices.color_by, info, *shown.recorded);
    }
    const ColorMap map = choices.map.value_or(
        field.kind == FieldValues::Kind::kDifference ? ColorMap::kCoolwarm : ColorMap::kViridis);
    return ColorByScale(field, map, choices.ends ? *choices.ends : FitScale(field));
  });
}

void AddTo(Overlay&& part, Overlay& drawing) {
  std::ranges::move(part.segments, std::back_inserter(drawing.segments));
  std::ranges::move(part.words, std::back_inserter(drawing.words));
}

}  // namespace

struct Composer::World {
  Surroundings surroundings;
  ScanPattern pattern;
  std::optional<ScanTable> scan;  ///< Table of the pattern, if that is a grid.
  std::optional<int> home_chunk;  ///< The chunk that `standing` was gathered for.
  Transform world_from_standing = Transform::Identity();
  std::shared_ptr<const std::vector<Part>> standing;

  void AddSurfaces(const RecordedFrame& recorded, Composition& composition) {
    const Frame& frame = recorded.frame;
    const int home = surroundings.world->HomeChunk(frame.stamp_ns);
    if (home_chunk != home) {
      StandingScene gathered = GatherStandingScene(surroundings, home);
      world_from_standing = gathered.world_from_home;
      standing = std::make_shared<const std::vector<Part>>(std::move(gathered.parts));
      home_chunk = home;
    }
    composition.surfaces.push_back(
        {standing, frame.world_from_sensor.inverse() * world_from_standing});
    composition.surfaces.push_back(
        {std::make_shared<const std::vector<Part>>(GatherSceneObjects(surroundings, recorded)),
         Transform::Identity()});
  }
};

Composer::Composer(RecordingInfo info) : info_(std::move(info)) {
  if (!info_.scenario) return;
  world_ = std::make_unique<World>();
  world_->surroundings = {*info_.scenario, MakeWorld(*info_.scenario)};
  world_->pattern = BuildScanPattern(info_.scenario->lidar.scan);
  world_->scan = MakeScanTable(world_->pattern);
}

Composer::~Composer() = default;
Composer::Composer(Composer&&) noexcept = default;

void Composer::AddEmptyBeams(const RecordedFrame& recorded, Composition& composition) const {
  const Frame& frame = recorded.frame;
  const bool has_pattern_shape = world_ && recorded.is_grid && frame.rows == world_->pattern.rows &&
                                 frame.columns == world_->pattern.columns;
  const auto beams = !has_pattern_shape ? BeamsOf(recorded)
                     : world_->pattern.repeats()
                         ? BeamsOf(world_->pattern)
                         : BeamsOf(PatternOfFrame(world_->pattern, frame.index));
  if (!beams) return;
  composition.empty_beams = DrawEmptyBeams(recorded, *beams);
  composition.beam_kinds = BeamKinds(recorded);
}

const FoundTracks& Composer::TracksOf(const ShownFrame& shown) const {
  if (tracks_of_ != shown.recorded) {
    tracks_ = FindTracks(*shown.recorded, std::nullopt);
    tracks_of_ = shown.recorded;
  }
  return tracks_;
}

std::string Composer::Missing(const ShownFrame& shown, const Choices& choices) const {
  const OverlayChoices& overlays = choices.overlays;
  const bool needs_world = overlays.gauge || overlays.mesh;
  if (choices.empty_beams && !shown.recorded->is_grid) {
    return "beams without return need a frame in which every firing has its place";
  }
  if (overlays.frustum && info_.kind == kMergedKind) {
    return "the frustum needs the frames of one sensor, and these are of several";
  }
  if (overlays.frustum && !(world_ ? world_->scan : MakeScanTable(shown.frame()))) {
    return world_ ? "the frustum needs a sensor whose firings are a grid"
                  : "the frustum needs the scenario or a grid of firings";
  }
  if (needs_world && !world_) {
    return "gauge and surfaces need the scenario, which is not known";
  }
  if (overlays.track && !world_) {
    const std::string& why_not = TracksOf(shown).why_not;
    if (!why_not.empty()) return "no track is found: " + why_not;
  }
  if ((needs_world || (overlays.track && world_)) && !shown.recorded->has_pose) {
    return "track, gauge and surfaces need the sensor's pose, which is not known";
  }
  if (overlays.boxes && shown.recorded->objects.empty() && info_.kind != "sequence" &&
      !(world_ && shown.recorded->has_pose)) {
    return "boxes need a sequence's objects, or a scenario and poses";
  }
  return {};
}

void Composer::AddOverlays(const ShownFrame& shown,
                           const OverlayChoices& choices,
                           Composition& composition) {
  const RecordedFrame& recorded = *shown.recorded;
  if (choices.boxes) AddTo(DrawObjectBoxes(recorded, info_.labels), composition.overlays);
  if (choices.axes) AddTo(DrawAxes(), composition.overlays);
  if (choices.rings) {
    AddTo(DrawRangeRings(kRingLimit_m,
                         world_ ? std::optional(info_.scenario->lidar.mount) : std::nullopt),
          composition.overlays);
  }
  if (choices.frustum && info_.kind != kMergedKind) {
    const auto table = world_ ? world_->scan : MakeScanTable(recorded.frame);
    const double range_m = world_ ? info_.scenario->lidar.range_max_m : kUnknownRange_m;
    if (table) AddTo(DrawSensorFrustum(*table, range_m), composition.overlays);
  }
  if (choices.track && !world_)
    AddTo(DrawFoundTracks(TracksOf(shown).tracks), composition.overlays);
  if (!world_ || !recorded.has_pose) return;
  if (choices.track) AddTo(DrawTrackAxis(world_->surroundings, recorded), composition.overlays);
  if (choices.mesh) world_->AddSurfaces(recorded, composition);
  if (choices.gauge) AddTo(DrawClearSpace(world_->surroundings, recorded), composition.overlays);
}

Composition Composer::Compose(const ShownFrames& frames, const Choices& choices) {
  Composition composition;
  composition.labels = info_.labels;
  composition.is_origin_on_rails = info_.kind == kMergedKind;
  if (frames.empty()) return composition;
  const ShownFrame& latest = *frames.front();
  for (const auto& shown : frames) {
    Transform view_from_sensor = Transform::Identity();
    if (shown != frames.front()) {
      if (!shown->recorded->has_pose || !latest.recorded->has_pose) continue;
      view_from_sensor =
          latest.frame().world_from_sensor.inverse() * shown->frame().world_from_sensor;
    }
    Coloring coloring = ColorFrame(*shown, info_, choices);
    composition.clouds.push_back({.shown = shown,
                                  .view_from_sensor = view_from_sensor,
                                  .colors = std::move(coloring.colors),
                                  .is_faint = FaintPoints(*shown, choices.labels)});
    if (shown == frames.front()) composition.coloring = std::move(coloring);
  }
  AddOverlays(latest, choices.overlays, composition);
  if (choices.empty_beams) AddEmptyBeams(*latest.recorded, composition);
  return composition;
}

void FitChoices(const ShownFrame& shown, Choices& choices) {
  if (choices.color_by.empty()) choices.color_by = DefaultColorField(*shown.recorded);
  AtPlace(shown.recorded->name + ": ", [&] {
    if (!choices.labels.empty() && !shown.recorded->Has("label")) {
      throw InputError("has no field label to select by");
    }
    const FieldValues field = ValuesOf(shown, choices.color_by);
    // This also checks that categories are whole numbers.
    if (field.kind == FieldValues::Kind::kCategory) {
      (void)ColorByCategory(field, choices.color_by, RecordingInfo(), *shown.recorded);
    }
    const bool has_scale = field.kind != FieldValues::Kind::kCategory;
    if (!has_scale && choices.ends) {
      throw InputError("field " + choices.color_by + " has no scale with a range");
    }
    if (has_scale && !choices.ends) choices.ends = FitScale(field);
  });
}

std::optional<Transform> FirstFromSecond(const ShownFrame& first, const ShownFrame& second) {
  if (!first.recorded->has_pose || !second.recorded->has_pose) {
    const Vector3 apart_m = second.recorded->origin_m - first.recorded->origin_m;
    if (apart_m.isZero(0.0)) return std::nullopt;
    return Transform(Eigen::Translation3d(apart_m));
  }
  return first.frame().world_from_sensor.inverse() * second.frame().world_from_sensor;
}

std::vector<float> DistancesToNearest_m(const ShownFrame& of, const ShownFrame& other) {
  if (of.num_points() == 0 || other.num_points() == 0) {
    return std::vector<float>(of.num_points(), std::numeric_limits<float>::quiet_NaN());
  }
  const NearestSearch search(PointsOf(other, Transform::Identity()));
  const Transform other_from_of = FirstFromSecond(other, of).value_or(Transform::Identity());
  return search.Of(PointsOf(of, other_from_of)).distance_m;
}

Composition ComposeDistances(const std::shared_ptr<const ShownFrame>& a,
                             const std::shared_ptr<const ShownFrame>& b,
                             const Choices& choices) {
  Composition composition;
  const FieldValues of_a = DistancesField(*a, *b);
  const FieldValues of_b = DistancesField(*b, *a);
  const ColorMap map = choices.map.value_or(ColorMap::kViridis);
  const auto ends_m = choices.distance_ends_m ? *choices.distance_ends_m : FitDistances_m(of_a);
  composition.coloring = ColorByScale(of_a, map, ends_m);
  composition.clouds.push_back({.shown = a,
                                .view_from_sensor = Transform::Identity(),
                                .colors = std::move(composition.coloring.colors),
                                .is_faint = FaintPoints(*a, choices.labels)});
  composition.clouds.push_back(
      {.shown = b,
       .view_from_sensor = FirstFromSecond(*a, *b).value_or(Transform::Identity()),
       .colors = ColorByScale(of_b, map, ends_m).colors,
       .is_faint = FaintPoints(*b, choices.labels),
       .source = 1});
  return composition;
}

}  // namespace railcast
