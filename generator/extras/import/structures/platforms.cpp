#include "generator/extras/import/structures/line_structures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/median.h"
#include "core/rail/line/track_course.h"
#include "generator/extras/import/lines/line_tags.h"

namespace railcast {
namespace {

/// Distances of a platform's side from the axis of its track, both on the map: nearer, it lies
/// across the track.
constexpr double kNearestEdge_m = 0.3;
constexpr double kFarthestEdge_m = 4.5;
constexpr double kShortestPlatform_m = 5.0;
/// Widths that a world can have.
constexpr double kNarrowest_m = 0.5;
constexpr double kWidest_m = 50.0;

/// A platform in chainage and offset.
struct PlatformShape {
  std::vector<Eigen::Vector2d> points_m;
  double begin_s_m = std::numeric_limits<double>::infinity();
  double end_s_m = -std::numeric_limits<double>::infinity();
  bool is_area{};
};

/// Absent if nothing of it lies beside the line.
std::optional<PlatformShape> ShapeOf(const MapThing& thing, const LinePlaces& places) {
  constexpr double kReach_m = 70.0;
  PlatformShape shape;
  for (const Eigen::Vector2d& place_m : thing.places_m) {
    const std::optional<LinePlace> at = places.Of(place_m, kReach_m);
    if (!at) continue;
    shape.points_m.emplace_back(at->s_m, at->d_m);
    shape.begin_s_m = std::min(shape.begin_s_m, at->s_m);
    shape.end_s_m = std::max(shape.end_s_m, at->s_m);
  }
  shape.is_area = IsOutline(thing);
  return shape.points_m.size() < 2 ? std::nullopt : std::optional(shape);
}

/// From where to where a platform reaches across a line at one chainage.
struct AcrossLine {
  double right_m = std::numeric_limits<double>::infinity();
  double left_m = -std::numeric_limits<double>::infinity();
};

AcrossLine AcrossAt(const PlatformShape& shape, double s_m) {
  AcrossLine across;
  for (std::size_t i = 0; i + 1 < shape.points_m.size(); ++i) {
    const Eigen::Vector2d& a_m = shape.points_m[i];
    const Eigen::Vector2d& b_m = shape.points_m[i + 1];
    if ((a_m.x() <= s_m) == (b_m.x() <= s_m)) continue;
    const double d_m = std::lerp(a_m.y(), b_m.y(), (s_m - a_m.x()) / (b_m.x() - a_m.x()));
    across.right_m = std::min(across.right_m, d_m);
    across.left_m = std::max(across.left_m, d_m);
  }
  return across;
}

/// A platform beside one track at one chainage.
struct EdgeMetre {
  double s_m{};
  std::optional<double> width_m;  ///< Absent where the map does not say.
  double room_m{};                ///< As far as to where the next track's edge would be.
};

/// One side of one track.
struct TrackEdge {
  std::size_t track{};
  TrackSide side{};

  auto operator<=>(const TrackEdge&) const = default;
};

class PlatformFinder {
 public:
  PlatformFinder(const PlatformShape& shape, const LineWorld& world)
      : shape_(shape), world_(world) {
    for (double s_m = std::ceil(shape.begin_s_m); s_m <= shape.end_s_m; s_m += 1.0) Look(s_m);
  }

  [[nodiscard]] const std::map<TrackEdge, std::vector<EdgeMetre>>& edges() const { return edges_; }
  /// The tracks across which it lies, and where.
  [[nodiscard]] const std::map<std::size_t, ChainageRange>& across() const { return across_; }

 private:
  struct Neighbour {
    std::size_t track{};
    double d_m{};
    double mapped_d_m{};
  };

  void Look(double s_m) {
    const AcrossLine at = AcrossAt(shape_, s_m);
    if (at.right_m > at.left_m) return;
    std::optional<Neighbour> right;
    std::optional<Neighbour> left;
    for (std::size_t i = 0; i < world_.tracks.size(); ++i) {
      const TrackDraft& track = world_.tracks[i].draft;
      if (!track.Has(s_m)) continue;
      const double d_m = track.OffsetNear_m(s_m);
      const double mapped_d_m = d_m + world_.tracks[i].OffAt_m(s_m);
      if (mapped_d_m > at.right_m - kNearestEdge_m && mapped_d_m < at.left_m + kNearestEdge_m) {
        across_.try_emplace(i, ChainageRange{s_m, s_m}).first->second.end_s_m = s_m;
        return;
      }
      const Neighbour one{i, d_m, mapped_d_m};
      if (mapped_d_m < at.right_m && (!right || d_m > right->d_m)) right = one;
      if (mapped_d_m > at.left_m && (!left || d_m < left->d_m)) left = one;
    }
    const bool is_right = right && at.right_m - right->mapped_d_m <= kFarthestEdge_m;
    const bool is_left = left && left->mapped_d_m - at.left_m <= kFarthestEdge_m;
    const double between_m = right && left ? left->d_m - right->d_m - 2.0 * edge_m_
                                           : std::numeric_limits<double>::infinity();
    std::optional<double> width_m;
    if (shape_.is_area) width_m = at.left_m - at.right_m;
    if (is_right && is_left) width_m = 0.5 * between_m;
    if (is_right) edges_[{right->track, TrackSide::kLeft}].push_back({s_m, width_m, between_m});
    if (is_left) edges_[{left->track, TrackSide::kRight}].push_back({s_m, width_m, between_m});
  }

  const PlatformShape& shape_;
  const LineWorld& world_;
  double edge_m_ = PlatformSpec{}.edge_distance_m;
  std::map<TrackEdge, std::vector<EdgeMetre>> edges_;
  std::map<std::size_t, ChainageRange> across_;
};

/// Divides the metres of an edge where there is a gap, or the width changes.
std::vector<std::vector<EdgeMetre>> PiecesOf(const std::vector<EdgeMetre>& metres) {
  constexpr double kLongestGap_m = 10.0;
  constexpr double kShortestPiece_m = 20.0;
  constexpr double kSameWidth_m = 0.5;
  std::vector<std::vector<EdgeMetre>> pieces;
  for (const EdgeMetre& metre : metres) {
    bool goes_on = !pieces.empty() && metre.s_m - pieces.back().back().s_m <= kLongestGap_m;
    if (goes_on) {
      const EdgeMetre& first = pieces.back().front();
      const bool is_same =
          first.width_m.has_value() == metre.width_m.has_value() &&
          std::abs(first.width_m.value_or(0.0) - metre.width_m.value_or(0.0)) <= kSameWidth_m;
      goes_on = is_same || metre.s_m - first.s_m < kShortestPiece_m;
      // Without a gap between them.
      if (!goes_on) pieces.back().push_back(metre);
    }
    if (!goes_on) pieces.emplace_back();
    pieces.back().push_back(metre);
  }
  return pieces;
}

double MedianWidth_m(const std::vector<EdgeMetre>& piece) {
  std::vector<double> widths_m;
  for (const EdgeMetre& metre : piece) {
    widths_m.push_back(metre.width_m.value_or(PlatformSpec{}.width_m));
  }
  return MedianOf(widths_m);
}

/// Whether a platform of the world stands on the same side of the same track.
bool IsTaken(const PlatformSpec& platform, const LineWorld& world) {
  return std::ranges::any_of(world.structures, [&](const StructureSpec& structure) {
    const auto* other = std::get_if<PlatformSpec>(&structure);
    return other != nullptr && other->track == platform.track && other->side == platform.side &&
           std::min(other->end_s_m, platform.end_s_m) -
                   std::max(other->begin_s_m, platform.begin_s_m) >
               kShortestPlatform_m;
  });
}

/// What the tags of a platform say.
PlatformSpec TaggedPlatform(const MapTags& tags) {
  constexpr double kLowest_m = 0.2;
  constexpr double kHighest_m = 1.3;
  PlatformSpec platform;
  const std::optional<double> height_m = MetresIn(TagOf(tags, "height"));
  if (height_m && *height_m >= kLowest_m && *height_m <= kHighest_m) platform.height_m = *height_m;
  if (TagOf(tags, "covered") == "yes") platform.roof = PlatformRoofSpec{};
  return platform;
}

/// Ends within a metre of the outline's are its ends.
void SetEnds(const std::vector<EdgeMetre>& piece,
             const PlatformShape& shape,
             const TrackCourse& course,
             PlatformSpec& platform) {
  constexpr double kSteps_per_m = 100.0;
  double begin_s_m = piece.front().s_m;
  double end_s_m = piece.back().s_m;
  if (begin_s_m - shape.begin_s_m <= 1.0) begin_s_m = shape.begin_s_m;
  if (shape.end_s_m - end_s_m <= 1.0) end_s_m = shape.end_s_m;
  platform.begin_s_m = std::max(RoundedTo(begin_s_m, kSteps_per_m),
                                std::ceil(course.begin_s_m() * kSteps_per_m) / kSteps_per_m);
  platform.end_s_m = std::min(RoundedTo(end_s_m, kSteps_per_m),
                              std::floor(course.end_s_m() * kSteps_per_m) / kSteps_per_m);
}

}  // namespace

bool IsOutline(const MapThing& platform) {
  constexpr std::size_t kFewest = 4;
  return platform.places_m.size() >= kFewest &&
         platform.places_m.front() == platform.places_m.back();
}

void AddPlatform(const MapThing& thing,
                 std::size_t number,
                 const LinePlaces& places,
                 LineWorld& world) {
  const std::optional<PlatformShape> shape = ShapeOf(thing, places);
  if (!shape) return;
  const auto leave_out = [&](double begin_s_m, double end_s_m, const std::string& reason) {
    world.left_out.push_back({"platform", begin_s_m, end_s_m, reason, number});
  };
  if (shape->end_s_m - shape->begin_s_m < kShortestPlatform_m) {
    return leave_out(shape->begin_s_m, shape->end_s_m, "it is shorter than 5 m along the line");
  }
  const PlatformFinder found(*shape, world);
  bool is_beside = false;
  for (const auto& [edge, metres] : found.edges()) {
    const TrackDraft& track = world.tracks[edge.track].draft;
    for (const std::vector<EdgeMetre>& piece : PiecesOf(metres)) {
      PlatformSpec platform = TaggedPlatform(thing.tags);
      platform.track = track.spec.name;
      platform.side = edge.side;
      SetEnds(piece, *shape, track.course, platform);
      is_beside = true;
      if (platform.end_s_m - platform.begin_s_m < kShortestPlatform_m) {
        leave_out(platform.begin_s_m, platform.end_s_m,
                  "it runs along track " + platform.track + " for less than 5 m there");
        continue;
      }
      const double room_m = std::ranges::min_element(piece, {}, &EdgeMetre::room_m)->room_m;
      platform.width_m = RoundedTo(std::min({MedianWidth_m(piece), room_m, kWidest_m}), 100.0);
      if (platform.width_m < kNarrowest_m) {
        leave_out(platform.begin_s_m, platform.end_s_m,
                  "there is no room for it beside track " + platform.track);
      } else if (IsTaken(platform, world)) {
        leave_out(platform.begin_s_m, platform.end_s_m,
                  "another one stands on its side of track " + platform.track);
      } else {
        world.structures.push_back(std::move(platform));
      }
    }
  }
  for (const auto& [track, range] : found.across()) {
    leave_out(range.begin_s_m, range.end_s_m,
              "it lies across track " + world.tracks[track].draft.spec.name + " on the map");
  }
  if (!is_beside && found.across().empty()) {
    leave_out(shape->begin_s_m, shape->end_s_m, "no track of the world runs along it");
  }
}

}  // namespace railcast
