#include "core/rail/track/track_structure.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "core/rail/line/rail_section.h"
#include "core/rail/track/cross_section.h"

namespace railcast {
namespace {

/// Bearers nearer to each other than this, along their length, become one.
constexpr double kLeastBearerGap_m = 0.1;
/// Bearers over which a turnout in a track that is not parallel to the alignment turns its own.
constexpr double kTurningBearers = 8.0;
/// How far a bearer's end may lie ahead of its middle: more would meet the sleepers there, which
/// have 0.3 m between them.
constexpr double kMostAhead_m = 0.20;

/// Tracks at a chainage that rest on one bearer, or one with a sleeper of its own.
struct BearerGroup {
  std::vector<std::size_t> tracks;
  std::vector<double> headings_rad;  ///< Headings of turnouts and diamonds; none: a sleeper.
  double right_d_m{};
  double left_d_m{};
  SleeperType sleeper{};

  [[nodiscard]] bool is_long() const { return !headings_rad.empty(); }
};

BearerGroup GroupAt(const ChunkContext& context, double s_m, std::vector<std::size_t> tracks) {
  BearerGroup group{.tracks = std::move(tracks),
                    .headings_rad = {},
                    .right_d_m = std::numeric_limits<double>::infinity(),
                    .left_d_m = -std::numeric_limits<double>::infinity(),
                    .sleeper = {}};
  group.sleeper = context.spec.tracks[group.tracks.front()].sleeper;
  for (const std::size_t track : group.tracks) {
    const double d_m = context.tracks[track].OffsetAt(s_m).d_m;
    group.right_d_m = std::min(group.right_d_m, d_m - kSleeperHalfLength_m);
    group.left_d_m = std::max(group.left_d_m, d_m + kSleeperHalfLength_m);
  }
  return group;
}

double TurnoutBearerHeading_rad(const ChunkContext& context,
                                const LaidTurnout& turnout,
                                double s_m) {
  const ChainageRange& range = turnout.extent.bearers;
  const double end_s_m = turnout.site.opens_ahead() ? range.end_s_m : range.begin_s_m;
  const double num_left = std::abs(end_s_m - s_m) / kSleeperSpacing_m;
  return std::min(1.0, num_left / kTurningBearers) *
         std::atan(context.tracks[turnout.site.track].OffsetAt(s_m).slope);
}

double DiamondBearerHeading_rad(const ChunkContext& context, const DiamondSite& site, double s_m) {
  return 0.5 * (std::atan(context.tracks[site.first].OffsetAt(s_m).slope) +
                std::atan(context.tracks[site.second].OffsetAt(s_m).slope));
}

/// One group for each turnout and diamond that has bearers at the chainage.
std::vector<BearerGroup> LongGroupsAt(const ChunkContext& context, double s_m) {
  std::vector<BearerGroup> groups;
  for (const LaidTurnout& turnout : context.turnouts) {
    if (!HoldsChainage(turnout.extent.bearers, s_m)) continue;
    groups.push_back(GroupAt(context, s_m, {turnout.site.track, turnout.site.branch}));
    groups.back().headings_rad.push_back(TurnoutBearerHeading_rad(context, turnout, s_m));
  }
  for (const LaidDiamond& diamond : context.diamonds) {
    if (!HoldsChainage(diamond.extent.bearers, s_m)) continue;
    groups.push_back(GroupAt(context, s_m, {diamond.site.first, diamond.site.second}));
    groups.back().headings_rad.push_back(DiamondBearerHeading_rad(context, diamond.site, s_m));
  }
  return groups;
}

bool AreOne(const BearerGroup& a, const BearerGroup& b) {
  if (!a.is_long() && !b.is_long()) return false;
  const bool share_a_track = std::ranges::find_first_of(a.tracks, b.tracks) != a.tracks.end();
  const double gap_m = std::max(a.right_d_m, b.right_d_m) - std::min(a.left_d_m, b.left_d_m);
  return share_a_track || gap_m < kLeastBearerGap_m;
}

/// @pre `into` or `from` is long; `into` comes first.
void Merge(const BearerGroup& from, BearerGroup& into) {
  for (const std::size_t track : from.tracks) {
    if (std::ranges::find(into.tracks, track) == into.tracks.end()) into.tracks.push_back(track);
  }
  into.headings_rad.insert(into.headings_rad.end(), from.headings_rad.begin(),
                           from.headings_rad.end());
  into.right_d_m = std::min(into.right_d_m, from.right_d_m);
  into.left_d_m = std::max(into.left_d_m, from.left_d_m);
}

void MergeAll(std::vector<BearerGroup>& groups) {
  for (bool is_changed = true; is_changed;) {
    is_changed = false;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      for (std::size_t j = groups.size(); --j > i;) {
        if (!AreOne(groups[i], groups[j])) continue;
        Merge(groups[j], groups[i]);
        groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(j));
        is_changed = true;
      }
    }
  }
}

LongBearer BearerOfGroup(const ChunkContext& context, double s_m, const BearerGroup& group) {
  const double heading_rad =
      std::accumulate(group.headings_rad.begin(), group.headings_rad.end(), 0.0) /
      static_cast<double>(group.headings_rad.size());
  const double most_rad = kMostAhead_m / (0.5 * (group.left_d_m - group.right_d_m));
  LongBearer bearer{.tracks = group.tracks,
                    .s_m = s_m,
                    .d_m = std::midpoint(group.right_d_m, group.left_d_m),
                    .heading_rad = std::clamp(heading_rad, -most_rad, most_rad),
                    .sleeper = group.sleeper};
  std::ranges::sort(bearer.tracks, {},
                    [&](std::size_t track) { return context.tracks[track].OffsetAt(s_m).d_m; });
  return bearer;
}

/// Tracks whose planes differ by more than this at their axes do not share a part of a bearer.
constexpr double kSamePlane_m = 0.010;
/// Parts of a bearer are cut only where the rails on both sides keep their feet on it.
constexpr double kLeastApartForCut_m = 1.7;
constexpr double kHalfCut_m = 0.03;

/// A track on a bearer.
struct TrackOnBearer {
  std::size_t track{};
  double s_m{};       ///< Its chainage where its axis passes the bearer.
  double at_m{};      ///< How far left of the bearer's own place that is, along the bearer.
  double turn_rad{};  ///< From the track's heading to that to which the bearer is square.
};

/// Neighbouring tracks in one plane.
struct BearerPart {
  std::vector<TrackOnBearer> tracks;
  double right_m{};  ///< Its ends, along the bearer.
  double left_m{};
  bool is_cut_right{};
  bool is_cut_left{};
};

/// Places a bearer with its plates, part by part.
class BearerPlacing {
 public:
  BearerPlacing(const ChunkContext& context, const LongBearer& bearer)
      : context_(context), bearer_(bearer) {}

  [[nodiscard]] std::vector<BearerPart> Parts() const {
    std::vector<BearerPart> parts;
    for (const std::size_t index : bearer_.tracks) {
      const TrackOnBearer track = OnBearer(index, 0.0);
      if (parts.empty()) {
        parts.push_back({.tracks = {track}, .right_m = track.at_m - kSleeperHalfLength_m});
      } else if (AreInOnePlane(parts.back().tracks.front(), track) ||
                 track.at_m - parts.back().tracks.back().at_m < kLeastApartForCut_m) {
        parts.back().tracks.push_back(track);
      } else {
        const double cut_m = std::midpoint(parts.back().tracks.back().at_m, track.at_m);
        parts.back().left_m = cut_m - kHalfCut_m;
        parts.back().is_cut_left = true;
        parts.push_back({.tracks = {track}, .right_m = cut_m + kHalfCut_m, .is_cut_right = true});
      }
    }
    parts.back().left_m = parts.back().tracks.back().at_m + kSleeperHalfLength_m;
    return parts;
  }

  void Add(const BearerPart& part, const TrackModels& models, Chunk& chunk) const {
    const MadeBearer bearer = BearerOf(models, bearer_.sleeper, part.left_m - part.right_m,
                                       part.is_cut_left && part.is_cut_right);
    // What it is longer than needed is where it is not cut.
    double middle_m = 0.5 * (part.left_m + part.right_m);
    if (part.is_cut_left != part.is_cut_right) {
      middle_m = part.is_cut_right ? part.right_m + 0.5 * bearer.length_m
                                   : part.left_m - 0.5 * bearer.length_m;
    }
    const TrackOnBearer& held = *std::ranges::min_element(
        part.tracks, {}, [](const TrackOnBearer& track) { return std::abs(track.turn_rad); });
    PlaceModel(bearer.model, ChunkFromBearer(held, middle_m), chunk);
    for (const TrackOnBearer& track : part.tracks) {
      for (const double side : {-1.0, 1.0}) AddPlate(track.track, side, models, chunk);
    }
  }

 private:
  /// Where the bearer passes a track, `aside_m` left of its axis.
  [[nodiscard]] TrackOnBearer OnBearer(std::size_t index, double aside_m) const {
    const TrackCourse& course = context_.tracks[index];
    const double sin_turn = std::sin(bearer_.heading_rad);
    const double cos_turn = std::cos(bearer_.heading_rad);
    TrackOnBearer track{.track = index, .s_m = bearer_.s_m};
    constexpr int kNumSteps = 8;
    for (int i = 0; i < kNumSteps; ++i) {
      const TrackOffset offset = course.OffsetAt(track.s_m);
      const double heading_rad = std::atan(offset.slope);
      const double ahead_m = track.s_m - aside_m * std::sin(heading_rad) - bearer_.s_m;
      const double left_m = offset.d_m + aside_m * std::cos(heading_rad) - bearer_.d_m;
      track.at_m = left_m * cos_turn - ahead_m * sin_turn;
      track.turn_rad = bearer_.heading_rad - heading_rad;
      track.s_m -= ahead_m * cos_turn + left_m * sin_turn;
    }
    return track;
  }

  [[nodiscard]] Transform ChunkFromTrack(const TrackOnBearer& track, double d_m) const {
    return StationOf(context_, {track.track, track.track}, false, {track.s_m, d_m});
  }

  /// The frame of a bearer whose middle is there, in the plane of a track.
  [[nodiscard]] Transform ChunkFromBearer(const TrackOnBearer& held, double middle_m) const {
    return ChunkFromTrack(held, 0.0) * Eigen::AngleAxisd(held.turn_rad, Vector3::UnitZ()) *
           Eigen::Translation3d(0.0, middle_m - held.at_m, 0.0);
  }

  [[nodiscard]] bool AreInOnePlane(const TrackOnBearer& a, const TrackOnBearer& b) const {
    if (context_.alignment.At(bearer_.s_m).cant_rad == 0.0) return true;
    const Vector3 b_from_a =
        ChunkFromTrack(a, 0.0).inverse() * Vector3(ChunkFromTrack(b, 0.0).translation());
    return std::abs(b_from_a.z()) <= kSamePlane_m;
  }

  /// On the bearer, below a rail's foot.
  void AddPlate(std::size_t index, double side, const TrackModels& models, Chunk& chunk) const {
    const double foot_m = side * RailFootMiddle_m().x();
    PlaceModel(PlateOf(models, bearer_.sleeper), ChunkFromTrack(OnBearer(index, foot_m), foot_m),
               chunk);
  }

  const ChunkContext& context_;
  const LongBearer& bearer_;
};

}  // namespace

std::vector<LongBearer> LongBearersAt(const ChunkContext& context, double s_m) {
  std::vector<BearerGroup> groups = LongGroupsAt(context, s_m);
  if (groups.empty()) return {};
  for (std::size_t track = 0; track < context.tracks.size(); ++track) {
    const TrackCourse& course = context.tracks[track];
    const bool is_known = std::ranges::any_of(groups, [&](const BearerGroup& group) {
      return std::ranges::find(group.tracks, track) != group.tracks.end();
    });
    if (is_known || s_m < course.begin_s_m() || s_m > course.end_s_m()) continue;
    groups.push_back(GroupAt(context, s_m, {track}));
  }
  MergeAll(groups);
  std::vector<LongBearer> bearers;
  for (const BearerGroup& group : groups) {
    if (group.is_long()) bearers.push_back(BearerOfGroup(context, s_m, group));
  }
  return bearers;
}

std::vector<LongBearer> LongBearersIn(const ChunkContext& context) {
  std::vector<LongBearer> bearers;
  for (const double s_m : SleeperPlaces(context)) {
    for (LongBearer& bearer : LongBearersAt(context, s_m)) bearers.push_back(std::move(bearer));
  }
  return bearers;
}

bool ReplacesSleeper(const std::vector<LongBearer>& bearers, std::size_t track, double s_m) {
  auto at = std::ranges::lower_bound(bearers, s_m, {}, &LongBearer::s_m);
  for (; at != bearers.end() && at->s_m == s_m; ++at) {
    if (std::ranges::find(at->tracks, track) != at->tracks.end()) return true;
  }
  return false;
}

void AddLongBearer(const ChunkContext& context,
                   const LongBearer& bearer,
                   const TrackModels& models,
                   Chunk& chunk) {
  const BearerPlacing placing(context, bearer);
  for (const BearerPart& part : placing.Parts()) placing.Add(part, models, chunk);
}

}  // namespace railcast
