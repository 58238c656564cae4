#include "generator/import/network/side_tracks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "core/base/text.h"
#include "generator/import/fit/line_fit.h"
#include "generator/import/lines/line_places.h"
#include "generator/import/lines/speed_limits.h"
#include "generator/import/network/track_levels.h"
#include "generator/import/network/track_runs.h"
#include "generator/import/network/track_sketch.h"

namespace railcast {
namespace {

/// That a world asks of tracks which no turnout joins, and a little for rounding.
constexpr double kLeastApart_m = 3.15;

/// Which accepted track a run meets at one end.
struct Meeting {
  std::size_t track{};
  double d_m{};  ///< Of that track there.
};

class SideTrackSearch {
 public:
  SideTrackSearch(const LinePlaces& places, double sigma_m, LineWorld& world)
      : length_m_(places.length_m()), sigma_m_(sigma_m), world_(world) {
    TrackSketch main{"main", 0.0, length_m_, {}, {{0.0, length_m_}}, true};
    main.offsets_m.assign(static_cast<std::size_t>(length_m_) + 3, 0.0);
    tracks_.push_back(std::move(main));
  }

  void Take(const TrackRun& run) {
    const auto begin = MeetingAt(run.points_m.front());
    const auto end = MeetingAt(run.points_m.back());
    if (begin && end && begin->track != end->track && TakeCrossover(run, *begin, *end)) return;
    if (TakeParallel(run, begin, end)) return;
    TakeElements(run, begin || end);
  }

  [[nodiscard]] SideTrackQuality& quality() { return quality_; }

 private:
  [[nodiscard]] std::optional<Meeting> MeetingAt(const Eigen::Vector2d& point_m) const;
  bool TakeCrossover(const TrackRun& run, const Meeting& begin, const Meeting& end);
  bool TakeParallel(const TrackRun& run,
                    const std::optional<Meeting>& begin,
                    const std::optional<Meeting>& end);
  void TakeElements(const TrackRun& run, bool meets_others);
  /// Where the sketch comes too near to others, apart from tracks that it meets near there.
  [[nodiscard]] bool IsApart(const TrackSketch& sketch,
                             const std::optional<Meeting>& begin,
                             const std::optional<Meeting>& end) const;
  [[nodiscard]] bool IsApartAt(double s_m, double d_m) const;
  void Accept(const TrackRun& run, TrackSketch sketch, WorldJson keys);
  [[nodiscard]] std::string NameOfNextTrack(const std::string& kind) {
    return kind + "_" + std::to_string(++num_of_kind_[kind]);
  }
  void LeaveOut(const TrackRun& run, const char* reason) {
    world_.left_out.push_back({run.kind + " track", run.points_m.front().x(), reason});
  }

  double length_m_;
  double sigma_m_;
  LineWorld& world_;
  std::vector<TrackSketch> tracks_;
  std::map<std::string, int> num_of_kind_;
  SideTrackQuality quality_;
};

std::optional<Meeting> SideTrackSearch::MeetingAt(const Eigen::Vector2d& point_m) const {
  constexpr double kFarthest_m = 1.5;
  std::optional<Meeting> nearest;
  double least_m = kFarthest_m;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (!tracks_[i].Has(point_m.x())) continue;
    const double d_m = tracks_[i].OffsetAt_m(point_m.x());
    if (std::abs(d_m - point_m.y()) >= least_m) continue;
    least_m = std::abs(d_m - point_m.y());
    nearest = Meeting{i, d_m};
  }
  return nearest;
}

/// Chainage at which a run's points cross an offset first, or last.
std::optional<double> CrossingOf(const TrackRun& run, double d_m, bool is_last) {
  std::optional<double> crossing_s_m;
  for (std::size_t i = 1; i < run.points_m.size(); ++i) {
    const Eigen::Vector2d& a = run.points_m[i - 1];
    const Eigen::Vector2d& b = run.points_m[i];
    if ((a.y() - d_m) * (b.y() - d_m) > 0.0 || a.y() == b.y()) continue;
    crossing_s_m = a.x() + (d_m - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (!is_last) break;
  }
  return crossing_s_m;
}

WorldJson TurnoutJson(const std::string& track, double s_m, const TurnoutShape& shape) {
  return {{"track", track}, {"s_m", RoundedTo(s_m, 1e3)}, {"turnout", shape.name}};
}

template <typename OffsetAt>
TrackSketch SketchOf(double begin_s_m, double end_s_m, const OffsetAt& offset_m) {
  TrackSketch sketch{"", begin_s_m, end_s_m, {}, {}, false};
  for (double s_m = begin_s_m; s_m < end_s_m + 1.0; ++s_m) {
    sketch.offsets_m.push_back(offset_m(std::min(s_m, end_s_m)));
  }
  sketch.offsets_m.push_back(sketch.offsets_m.back());
  return sketch;
}

/// Whether a sketch is where the run's points are: nearly all of them within 1 m, and none farther
/// off than turnouts may lie beside where the map has them.
bool Follows(const TrackSketch& sketch, const TrackRun& run) {
  constexpr double kNear_m = 1.0;
  constexpr double kFarthest_m = 2.5;
  constexpr double kShare = 0.8;
  int num_points = 0;
  int num_near = 0;
  for (const Eigen::Vector2d& point_m : run.points_m) {
    if (!sketch.Has(point_m.x())) continue;
    const double off_m = std::abs(sketch.OffsetAt_m(point_m.x()) - point_m.y());
    if (off_m > kFarthest_m) return false;
    ++num_points;
    if (off_m <= kNear_m) ++num_near;
  }
  return num_near >= kShare * num_points;
}

bool SideTrackSearch::TakeCrossover(const TrackRun& run, const Meeting& begin, const Meeting& end) {
  constexpr double kLongest_m = 150.0;
  if (run.points_m.back().x() - run.points_m.front().x() > kLongest_m) return false;
  const TrackSketch& from = tracks_[begin.track];
  const TrackSketch& to = tracks_[end.track];
  const auto middle_s_m = CrossingOf(run, 0.5 * (begin.d_m + end.d_m), false);
  if (!middle_s_m || !from.Has(*middle_s_m) || !to.Has(*middle_s_m)) return false;
  const TurnoutShape& shape = ShapeFor(run.speed_kmph);
  const double from_d_m = from.OffsetAt_m(*middle_s_m);
  const double apart_m = std::abs(to.OffsetAt_m(*middle_s_m) - from_d_m);
  const double half_m = 0.5 * apart_m * shape.ratio + shape.tangent_m();
  const double begin_s_m = *middle_s_m - half_m;
  const double end_s_m = *middle_s_m + half_m;
  // Both turnouts must have room on their tracks, and between each other.
  if (apart_m * shape.ratio < 2.0 * (shape.length_m - shape.tangent_m()) || !from.is_parallel ||
      !from.IsStraight(begin_s_m, begin_s_m + shape.length_m) || !to.is_parallel ||
      !to.IsStraight(end_s_m - shape.length_m, end_s_m)) {
    return false;
  }
  const double side = to.OffsetAt_m(*middle_s_m) > from_d_m ? 1.0 : -1.0;
  TrackSketch sketch = SketchOf(begin_s_m, end_s_m, [&](double s_m) {
    const bool is_first_half = s_m < *middle_s_m;
    const double x_m = is_first_half ? s_m - begin_s_m : end_s_m - s_m;
    const double off_m = shape.OffsetAt_m(x_m, std::numeric_limits<double>::infinity());
    return is_first_half ? from.OffsetAt_m(s_m) + side * off_m : to.OffsetAt_m(s_m) - side * off_m;
  });
  WorldJson keys = {{"begin", TurnoutJson(from.name, begin_s_m, shape)},
                    {"end", {{"track", to.name}, {"turnout", shape.name}}}};
  if (!Follows(sketch, run) || !IsApart(sketch, begin, end)) return false;
  quality_.num_turnouts += 2;
  Accept(run, std::move(sketch), std::move(keys));
  return true;
}

/// A turnout at one end of a parallel track.
struct Branch {
  double s_m{};
  double side{};  ///< 1 to the left.
  double distance_m{};
};

struct Branches {
  std::optional<Branch> begin;
  std::optional<Branch> end;
};

/// Adds `offset_m` or `offsets_m`.
void AddOffsets(const TrackLevels& levels, WorldJson& keys) {
  if (levels.levels.size() == 1) {
    keys["offset_m"] = RoundedTo(levels.levels.front().d_m, 1e3);
    return;
  }
  WorldJson offsets = WorldJson::array();
  for (const TrackLevel& level : levels.levels) {
    for (const double s_m : {level.begin_s_m, level.end_s_m}) {
      offsets.push_back({{"s_m", RoundedTo(s_m, 1e3)}, {"value", RoundedTo(level.d_m, 1e3)}});
    }
  }
  keys["offsets_m"] = std::move(offsets);
}

std::optional<Branch> BranchOf(const TrackRun& run,
                               double level_m,
                               const TrackSketch& other,
                               double forwards) {
  const TurnoutShape& shape = ShapeFor(run.speed_kmph);
  // Other tracks may be a little oblique: their offset half way counts.
  const bool is_end = forwards < 0.0;
  const Eigen::Vector2d& meeting_m = is_end ? run.points_m.back() : run.points_m.front();
  const std::optional<double> half_s_m =
      CrossingOf(run, 0.5 * (level_m + other.OffsetAt_m(meeting_m.x())), is_end);
  if (!half_s_m || !other.Has(*half_s_m)) return std::nullopt;
  const double off_m = level_m - other.OffsetAt_m(*half_s_m);
  const double distance_m = std::abs(off_m);
  if (distance_m < shape.least_distance_m() + 0.05) return std::nullopt;
  const double s_m = *half_s_m - forwards * (0.5 * distance_m * shape.ratio + shape.tangent_m());
  if (!other.IsStraight(s_m, s_m + forwards * shape.length_m)) return std::nullopt;
  return Branch{s_m, off_m > 0.0 ? 1.0 : -1.0, distance_m};
}

bool SideTrackSearch::TakeParallel(const TrackRun& run,
                                   const std::optional<Meeting>& begin,
                                   const std::optional<Meeting>& end) {
  const std::optional<TrackLevels> levels = LevelsOf(run);
  if (!levels) return false;
  const TrackLevel& first = levels->levels.front();
  const TrackLevel& last = levels->levels.back();
  Branches branches;
  if (begin) branches.begin = BranchOf(run, first.d_m, tracks_[begin->track], 1.0);
  if (end) branches.end = BranchOf(run, last.d_m, tracks_[end->track], -1.0);
  // Without a turnout, a track begins and ends where it is apart from others.
  double begin_s_m = branches.begin ? branches.begin->s_m : first.begin_s_m;
  double end_s_m = branches.end ? branches.end->s_m : last.end_s_m;
  while (!branches.begin && begin_s_m < end_s_m && !IsApartAt(begin_s_m, first.d_m)) ++begin_s_m;
  while (!branches.end && begin_s_m < end_s_m && !IsApartAt(end_s_m, last.d_m)) --end_s_m;
  const TurnoutShape& shape = ShapeFor(run.speed_kmph);
  const double level_from_m =
      begin_s_m + (branches.begin ? shape.Parallel_m(branches.begin->distance_m) : 0.0);
  const double level_to_m =
      end_s_m - (branches.end ? shape.Parallel_m(branches.end->distance_m) : 0.0);
  constexpr double kShortest_m = 20.0;
  if (end_s_m - begin_s_m < kShortest_m || level_from_m >= level_to_m ||
      level_from_m > first.end_s_m || level_to_m < last.begin_s_m) {
    return false;
  }
  TrackSketch sketch = SketchOf(begin_s_m, end_s_m, [&](double s_m) {
    double d_m = levels->OffsetAt_m(s_m);
    for (const auto& [branch, x_m] :
         {std::pair(branches.begin, s_m - begin_s_m), std::pair(branches.end, end_s_m - s_m)}) {
      if (!branch) continue;
      d_m += branch->side * (shape.OffsetAt_m(x_m, branch->distance_m) - branch->distance_m);
    }
    return d_m;
  });
  sketch.is_parallel = true;
  for (const TrackLevel& level : levels->levels) {
    sketch.straights_m.emplace_back(std::max(level.begin_s_m, level_from_m),
                                    std::min(level.end_s_m, level_to_m));
  }
  if (!Follows(sketch, run) ||
      !IsApart(sketch, branches.begin ? begin : std::nullopt, branches.end ? end : std::nullopt)) {
    return false;
  }
  WorldJson keys;
  if (branches.begin) {
    keys["begin"] = TurnoutJson(tracks_[begin->track].name, begin_s_m, shape);
  } else {
    keys["start_s_m"] = RoundedTo(begin_s_m, 1e3);
  }
  if (branches.end) {
    keys["end"] = TurnoutJson(tracks_[end->track].name, end_s_m, shape);
  } else {
    keys["end_s_m"] = RoundedTo(end_s_m, 1e3);
  }
  AddOffsets(*levels, keys);
  quality_.num_turnouts += (branches.begin ? 1U : 0U) + (branches.end ? 1U : 0U);
  Accept(run, std::move(sketch), std::move(keys));
  if ((begin && !branches.begin) || (end && !branches.end)) {
    LeaveOut(run, "it ends before another track, since no turnout fits there");
  }
  return true;
}

bool SideTrackSearch::IsApart(const TrackSketch& sketch,
                              const std::optional<Meeting>& begin,
                              const std::optional<Meeting>& end) const {
  for (std::size_t other = 0; other < tracks_.size(); ++other) {
    const TrackSketch& track = tracks_[other];
    // From a turnout on, tracks may be near until they are apart once.
    bool joined = begin && begin->track == other;
    double near_from_m = std::numeric_limits<double>::infinity();
    for (double s_m = sketch.begin_s_m; s_m <= sketch.end_s_m; ++s_m) {
      if (!track.Has(s_m)) continue;
      const bool is_near = std::abs(sketch.OffsetAt_m(s_m) - track.OffsetAt_m(s_m)) < kLeastApart_m;
      if (!is_near) joined = false;
      if (is_near && !joined) near_from_m = std::min(near_from_m, s_m);
      if (!is_near && near_from_m < s_m) return false;
    }
    // The last stretch of nearness must be that of the turnout at the end.
    if (std::isfinite(near_from_m) && !(end && end->track == other)) return false;
  }
  return true;
}

bool SideTrackSearch::IsApartAt(double s_m, double d_m) const {
  return std::ranges::none_of(tracks_, [&](const TrackSketch& track) {
    return track.Has(s_m) && std::abs(track.OffsetAt_m(s_m) - d_m) < kLeastApart_m;
  });
}

void SideTrackSearch::TakeElements(const TrackRun& run, bool meets_others) {
  constexpr double kShortest_m = 30.0;
  const LineFit fit = FitLine(
      run.points_m, {.sigma_m = sigma_m_, .speed_kmph = [&](double) { return run.speed_kmph; }});
  const PlanCourse course = fit.plan.Course();
  // The longest stretch that is apart from all others, with an end at a whole metre of the fit.
  double best_begin_m = 0.0;
  double best_end_m = 0.0;
  double begin_m = 0.0;
  for (double at_m = 0.0; at_m <= fit.plan.length_m(); ++at_m) {
    const PlanPoint at = course.At(at_m);
    const bool fits = at.x_m >= 0.0 && at.x_m <= length_m_ && IsApartAt(at.x_m, at.y_m);
    if (!fits) begin_m = at_m + 1.0;
    if (fits && at_m - begin_m > best_end_m - best_begin_m) {
      best_begin_m = begin_m;
      best_end_m = at_m;
    }
  }
  if (best_end_m - best_begin_m < kShortest_m) {
    LeaveOut(run, meets_others ? "it needs turnouts that do not fit the map's points"
                               : "it is nearer than 3 m to other tracks");
    return;
  }
  const PlanModel part = PartOf(fit.plan, best_begin_m, best_end_m);
  const PlanPoint start = course.At(best_begin_m);
  WorldJson elements = WorldJson::array();
  for (const AlignmentElement& element : part.Elements()) {
    WorldJson item = {{"type", NameOf(element.type)}, {"length_m", element.length_m}};
    if (element.radius_m) item["radius_m"] = *element.radius_m;
    elements.push_back(std::move(item));
  }
  WorldJson keys = {{"start_s_m", RoundedTo(start.x_m, 1e4)},
                    {"offset_m", RoundedTo(start.y_m, 1e4)},
                    {"heading_deg", RoundedTo(start.heading_rad * 180.0 / std::numbers::pi, 1e7)},
                    {"elements", std::move(elements)}};
  // As it is written.
  const PlanModel written = PlanOf(start, part.Elements());
  const PlanCourse written_course = written.Course();
  const double written_m = written.length_m();
  double along_m = 0.0;
  TrackSketch sketch = SketchOf(start.x_m, written_course.At(written_m).x_m, [&](double s_m) {
    for (int step = 0; step < 3; ++step) {
      along_m = std::clamp(along_m + s_m - written_course.At(along_m).x_m, 0.0, written_m);
    }
    return written_course.At(along_m).y_m;
  });
  if (!IsApart(sketch, std::nullopt, std::nullopt)) {
    LeaveOut(run, "it is nearer than 3 m to other tracks");
    return;
  }
  const PiecewiseLinear curvature = written.Curvature();
  for (std::size_t i = 0; i < curvature.pieces().size(); ++i) {
    const LinearPiece& piece = curvature.pieces()[i];
    // A turnout may be bent as much as moves its branch by 0.2 m.
    constexpr double kMostBent_per_m = 2e-4;
    if (piece.begin_value != piece.end_value || std::abs(piece.begin_value) > kMostBent_per_m) {
      continue;
    }
    const auto chainage_m = [&](double in_part_m) {
      return written_course.At(std::min(in_part_m, written_m)).x_m;
    };
    // Elements are rounded for files.
    constexpr double kRounding_m = 0.1;
    sketch.straights_m.emplace_back(chainage_m(piece.begin_s_m) + kRounding_m,
                                    chainage_m(curvature.EndOf(i)) - kRounding_m);
  }
  Accept(run, std::move(sketch), std::move(keys));
  if (best_begin_m > 1.0 || best_end_m + 1.0 < fit.plan.length_m()) {
    LeaveOut(run, "it is cut where it comes nearer than 3 m to others");
  }
}

void SideTrackSearch::Accept(const TrackRun& run, TrackSketch sketch, WorldJson keys) {
  sketch.name = NameOfNextTrack(run.kind);
  WorldJson track = {{"name", sketch.name}};
  track.update(keys);
  if (!run.is_electrified) track["electrified"] = false;
  world_.tracks.push_back(std::move(track));
  for (const Eigen::Vector2d& point_m : run.points_m) {
    if (!sketch.Has(point_m.x())) continue;
    quality_.distances_m.push_back(std::abs(sketch.OffsetAt_m(point_m.x()) - point_m.y()));
  }
  ++quality_.num_tracks;
  quality_.length_m += sketch.end_s_m - sketch.begin_s_m;
  tracks_.push_back(std::move(sketch));
}

}  // namespace

SideTrackQuality AddSideTracks(const RailMap& map,
                               const TrackLine& track,
                               const ImportedLine& line,
                               double sigma_m,
                               LineWorld& world) {
  const LinePlaces places(map, track, line);
  SideTrackSearch search(places, sigma_m, world);
  for (const TrackRun& run : FindRuns(map, track, places)) search.Take(run);
  std::ranges::sort(search.quality().distances_m);
  return search.quality();
}

}  // namespace railcast
