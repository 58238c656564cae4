#include "generator/extras/import/structures/line_structures.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/rail/network/world_tracks.h"
#include "core/rail/structures/structure_track.h"

namespace railcast {
namespace {

/// Shorter tunnels are not made.
constexpr double kShortest_m = 5.0;
/// Parts shorter than this may be wider than they need.
constexpr double kShortPart_m = 50.0;
/// By so much any part may be wider than it needs, on either side.
constexpr double kWider_m = 1.0;
/// A track that has been in a row stays in it up to this much farther away: there is still room in
/// the lining, and one that runs at the limit does not change rows at every metre.
constexpr double kStays_m = 0.3;
constexpr double kSame_m = 0.005;
/// Rounding of offsets, which are linear between whole metres here.
constexpr double kRounding_m = 0.01;

/// Tracks beside each other, from right to left, between two chainages.
struct Row {
  double begin_s_m{};
  double end_s_m{};
  std::vector<std::size_t> tracks;
  std::optional<std::size_t> stranger;  ///< The track for which it cannot be a tunnel.

  [[nodiscard]] double length_m() const { return end_s_m - begin_s_m; }
};

class TunnelRows {
 public:
  TunnelRows(const LineWorld& world, std::vector<TaggedStretch> tagged)
      : world_(world), core_(world), tagged_(std::move(tagged)) {}

  /// All rows with a track in a tunnel, by chainage; one for each stretch with the same tracks.
  [[nodiscard]] std::vector<Row> Find() {
    std::vector<Row> rows;
    std::vector<std::size_t> open;  // Rows that reach the chainage that is looked at.
    std::set<std::pair<std::size_t, std::size_t>> linked;
    const std::vector<double> places_m = Places_m();
    for (std::size_t i = 0; i + 1 < places_m.size(); ++i) {
      std::set<std::pair<std::size_t, std::size_t>> links;
      std::vector<std::size_t> going_on;
      for (Row& row : RowsBetween(places_m[i], places_m[i + 1], linked, links)) {
        const auto before = std::ranges::find_if(open, [&](std::size_t one) {
          return rows[one].tracks == row.tracks && rows[one].stranger == row.stranger;
        });
        if (before != open.end()) {
          rows[*before].end_s_m = row.end_s_m;
          going_on.push_back(*before);
        } else {
          going_on.push_back(rows.size());
          rows.push_back(std::move(row));
        }
      }
      open = std::move(going_on);
      linked = std::move(links);
    }
    return rows;
  }

  /// Joins parts of tunnels that follow each other.
  [[nodiscard]] std::vector<Row> Joined(std::vector<Row> rows) const {
    for (std::size_t i = 0; i < rows.size();) {
      const auto next = std::ranges::find_if(rows, [&](const Row& row) {
        return std::abs(row.begin_s_m - rows[i].end_s_m) < kSame_m && MayJoin(rows[i], row);
      });
      if (next == rows.end()) {
        ++i;
        continue;
      }
      rows[i] = JoinOf(rows[i], *next);
      const auto at = static_cast<std::size_t>(next - rows.begin());
      rows.erase(next);
      if (at < i) --i;
    }
    return rows;
  }

  /// The track along which the tunnel of a row runs: that of the line if it is in it, else that
  /// which is in a tunnel for the greatest length.
  [[nodiscard]] std::size_t OwnerOf(const Row& row) const {
    const auto tagged_m = [&](std::size_t track) {
      double length_m = 0.0;
      for (const TaggedStretch& stretch : tagged_) {
        if (stretch.track != track) continue;
        length_m += std::max(0.0, std::min(stretch.end_s_m, row.end_s_m) -
                                      std::max(stretch.begin_s_m, row.begin_s_m));
      }
      return length_m;
    };
    std::vector<std::size_t> whole;
    std::ranges::copy_if(row.tracks, std::back_inserter(whole), [&](std::size_t track) {
      const TrackCourse& course = world_.tracks[track].draft.course;
      return course.begin_s_m() <= row.begin_s_m && course.end_s_m() >= row.end_s_m;
    });
    if (whole.empty()) return row.tracks.front();
    return *std::ranges::max_element(
        whole, {}, [&](std::size_t track) { return std::pair(track == 0, tagged_m(track)); });
  }

 private:
  /// Chainages between which tracks are looked at once: whole metres and the ends of tunnels.
  [[nodiscard]] std::vector<double> Places_m() const {
    std::vector<double> places_m;
    for (const TaggedStretch& stretch : tagged_) {
      places_m.push_back(stretch.begin_s_m);
      for (double s_m = std::floor(stretch.begin_s_m) + 1.0; s_m < stretch.end_s_m; ++s_m) {
        places_m.push_back(s_m);
      }
      places_m.push_back(stretch.end_s_m);
    }
    std::ranges::sort(places_m);
    const auto same = std::ranges::unique(
        places_m, [](double one_m, double other_m) { return other_m - one_m < kSame_m; });
    places_m.erase(same.begin(), same.end());
    return places_m;
  }

  [[nodiscard]] bool IsTagged(std::size_t track, double s_m, double slack_m) const {
    return std::ranges::any_of(tagged_, [&](const TaggedStretch& stretch) {
      return stretch.track == track && s_m > stretch.begin_s_m - slack_m &&
             s_m < stretch.end_s_m + slack_m;
    });
  }

  [[nodiscard]] std::vector<Row> RowsBetween(
      double begin_s_m,
      double end_s_m,
      const std::set<std::pair<std::size_t, std::size_t>>& linked,
      std::set<std::pair<std::size_t, std::size_t>>& links) const {
    const double s_m = 0.5 * (begin_s_m + end_s_m);
    std::vector<std::pair<double, std::size_t>> across;
    for (std::size_t i = 0; i < world_.tracks.size(); ++i) {
      const TrackDraft& track = world_.tracks[i].draft;
      if (track.Has(s_m)) across.emplace_back(track.OffsetNear_m(s_m), i);
    }
    std::ranges::sort(across);
    std::vector<Row> rows;
    for (std::size_t i = 0; i < across.size(); ++i) {
      const bool goes_on = i > 0 && [&] {
        const auto pair = std::minmax(across[i - 1].second, across[i].second);
        const double stays_m = linked.contains(pair) ? kStays_m : 0.0;
        if (Distance_m(pair, begin_s_m, end_s_m) > kSharedTunnel_m + kRounding_m + stays_m) {
          return false;
        }
        links.insert(pair);
        return true;
      }();
      if (!goes_on) rows.push_back({begin_s_m, end_s_m, {}, {}});
      rows.back().tracks.push_back(across[i].second);
    }
    std::erase_if(rows, [&](const Row& row) {
      return std::ranges::none_of(row.tracks,
                                  [&](std::size_t track) { return IsTagged(track, s_m, 0.0); });
    });
    for (Row& row : rows) {
      row.stranger = StrangerIn(row, s_m);
      std::ranges::sort(row.tracks);
    }
    return rows;
  }

  /// The least distance of two tracks between two chainages. A tunnel of one of them would take the
  /// other one in wherever it is near enough, were it for a millimetre.
  [[nodiscard]] double Distance_m(const std::pair<std::size_t, std::size_t>& tracks,
                                  double begin_s_m,
                                  double end_s_m) const {
    double least_m = std::numeric_limits<double>::infinity();
    for (const double s_m : {begin_s_m, 0.5 * (begin_s_m + end_s_m), end_s_m}) {
      least_m = std::min(least_m, std::abs(world_.tracks[tracks.first].draft.OffsetNear_m(s_m) -
                                           world_.tracks[tracks.second].draft.OffsetNear_m(s_m)));
    }
    return least_m;
  }

  [[nodiscard]] std::optional<std::size_t> StrangerIn(const Row& row, double s_m) const {
    std::vector<std::size_t> outside;
    std::ranges::copy_if(row.tracks, std::back_inserter(outside),
                         [&](std::size_t track) { return !IsTagged(track, s_m, kSameEnd_m); });
    const bool has_line = std::ranges::count(row.tracks, std::size_t{0}) > 0;
    const bool is_line_outside = std::ranges::count(outside, std::size_t{0}) > 0;
    if (is_line_outside) return 0;
    if (has_line || 2 * outside.size() <= row.tracks.size()) return std::nullopt;
    return outside.front();
  }

  [[nodiscard]] TrackSpread SpreadAlong(const Row& row, std::size_t owner) const {
    return SpreadOf(core_.tracks(),
                    {.name = "",
                     .track = world_.tracks[owner].draft.spec.name,
                     .begin_s_m = row.begin_s_m,
                     .end_s_m = row.end_s_m},
                    kSharedTunnel_m);
  }

  [[nodiscard]] static Row JoinOf(const Row& one, const Row& next) {
    Row joined{one.begin_s_m, next.end_s_m, {}, {}};
    std::ranges::set_union(one.tracks, next.tracks, std::back_inserter(joined.tracks));
    return joined;
  }

  /// Whether one tunnel may go on as the other without being too wide for long.
  [[nodiscard]] bool MayJoin(const Row& one, const Row& next) const {
    std::vector<std::size_t> in_both;
    std::ranges::set_intersection(one.tracks, next.tracks, std::back_inserter(in_both));
    if (in_both.empty()) return false;
    const Row joined = JoinOf(one, next);
    // What is in one of them must begin or end there: else it goes on in a tunnel of its own.
    const bool leaves = std::ranges::any_of(joined.tracks, [&](std::size_t track) {
      if (std::ranges::count(in_both, track) > 0) return false;
      const TrackCourse& course = world_.tracks[track].draft.course;
      return course.begin_s_m() < one.end_s_m - 1.0 && course.end_s_m() > one.end_s_m + 1.0;
    });
    if (leaves) return false;
    const std::size_t owner = OwnerOf(joined);
    const TrackCourse& course = world_.tracks[owner].draft.course;
    if (course.begin_s_m() > joined.begin_s_m || course.end_s_m() < joined.end_s_m) return false;
    if (std::min(one.length_m(), next.length_m()) < kShortPart_m) return true;
    const TrackSpread whole = SpreadAlong(joined, owner);
    const auto is_near = [&](const Row& part) {
      const TrackSpread spread = SpreadAlong(part, owner);
      return whole.left_m - spread.left_m < kWider_m && spread.right_m - whole.right_m < kWider_m;
    };
    return is_near(one) && is_near(next);
  }

  const LineWorld& world_;
  TracksOfLine core_;
  std::vector<TaggedStretch> tagged_;
};

}  // namespace

void AddTunnels(const RailMap& map, LineWorld& world) {
  TunnelRows search(world, StretchesOfAll(map, world, IsTunnel));
  std::vector<Row> rows = search.Find();
  for (const Row& row : rows) {
    if (!row.stranger) continue;
    world.left_out.push_back({"tunnel", row.begin_s_m, row.end_s_m,
                              "track " + world.tracks[*row.stranger].draft.spec.name +
                                  ", which has none on the map, would run in it"});
  }
  std::erase_if(rows, [](const Row& row) { return row.stranger.has_value(); });
  rows = search.Joined(std::move(rows));
  for (const Row& row : rows) {
    const bool goes_on = std::ranges::any_of(rows, [&](const Row& other) {
      return std::abs(other.begin_s_m - row.end_s_m) < kSame_m ||
             std::abs(other.end_s_m - row.begin_s_m) < kSame_m;
    });
    if (row.length_m() < kShortest_m && !goes_on) {
      world.left_out.push_back(
          {"tunnel", row.begin_s_m, row.end_s_m, "it would be shorter than 5 m"});
      continue;
    }
    TunnelSpec tunnel;
    tunnel.track = world.tracks[search.OwnerOf(row)].draft.spec.name;
    tunnel.begin_s_m = row.begin_s_m;
    tunnel.end_s_m = row.end_s_m;
    world.structures.push_back(std::move(tunnel));
  }
}

}  // namespace railcast
