#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <initializer_list>
#include <string>
#include <vector>

#include "generator/extras/import/import_files.h"
#include "generator/extras/import/lines/imported_line.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/rail_map.h"
#include "generator/extras/import/network/line_world.h"
#include "generator/extras/import/structures/line_structures.h"
#include "generator/extras/import/structures/map_account.h"

namespace railcast {

/// Straight tracks of 2000 m to the east, in metres, of which something is tagged from 800 to
/// 1200 m.
class MadeMap {
 public:
  struct Track {
    double y_m{};
    MapTags middle_tags;  ///< Between 800 and 1200 m.
  };
  MadeMap(std::initializer_list<Track> tracks) {
    for (const auto& [y_m, middle_tags] : tracks) {
      // Only the track at y = 0 is a line of its own.
      const double inset_m = y_m == 0.0 ? 0.0 : 100.0;
      AddWay({{inset_m, y_m}, {400.0, y_m}, {800.0, y_m}}, {});
      AddWay({{800.0, y_m}, {1000.0, y_m}, {1200.0, y_m}}, middle_tags);
      AddWay({{1200.0, y_m}, {1600.0, y_m}, {2000.0 - inset_m, y_m}}, {});
    }
  }
  void AddWay(const std::vector<Eigen::Vector2d>& points_m, MapTags tags) {
    tags.insert({{"railway", "rail"}, {"maxspeed", "80"}});
    MapWay way{static_cast<std::int64_t>(map_.ways.size()), {}, std::move(tags)};
    for (const Eigen::Vector2d& point_m : points_m) {
      const auto known = std::ranges::find(map_.nodes, point_m, &MapNode::place_m);
      way.nodes.push_back(static_cast<std::size_t>(known - map_.nodes.begin()));
      if (known == map_.nodes.end()) map_.nodes.push_back({.place_m = point_m, .tags = {}});
    }
    map_.ways.push_back(std::move(way));
  }
  void AddThing(const std::vector<Eigen::Vector2d>& points_m, const MapTags& tags) {
    map_.things.push_back({{}, points_m, tags});
  }
  void AddPlatformArea(double begin_x_m, double end_x_m, double begin_y_m, double end_y_m) {
    AddThing({{begin_x_m, begin_y_m},
              {end_x_m, begin_y_m},
              {end_x_m, end_y_m},
              {begin_x_m, end_y_m},
              {begin_x_m, begin_y_m}},
             {{"railway", "platform"}});
  }

  void Make() {
    track_ = FindLines(map_, 1900.0).front();
    runs_east_ = map_.nodes[track_.nodes.front()].place_m.x() < 1000.0;
    line_ = ImportLine(map_, track_, {});
    world_ = MakeLineWorld(map_, track_, line_);
    AddSideTracks(map_, track_, line_, {}, world_);
    AddStructures(map_, track_, line_, world_);
  }

  [[nodiscard]] LineWorld& world() { return world_; }
  /// What of the map the world has.
  [[nodiscard]] std::vector<AccountRow> Account() const { return AccountWith({world_}); }
  /// What of the map is in several worlds of its line.
  [[nodiscard]] std::vector<AccountRow> AccountWith(const std::vector<LineWorld>& worlds) const {
    const std::vector<TrackLine> tracks(worlds.size(), track_);
    const std::vector<ImportedLine> lines(worlds.size(), line_);
    return AccountOf(map_, {tracks, lines, worlds, {}, kNearNoLine});
  }
  [[nodiscard]] AccountRow Sum(const std::string& what) const { return SumOf(Account(), what); }
  [[nodiscard]] const RailMap& map() const { return map_; }
  [[nodiscard]] const ImportedLine& line() const { return line_; }
  [[nodiscard]] bool runs_east() const { return runs_east_; }
  /// What stands on the northern side of a track.
  [[nodiscard]] TrackSide north() const {
    return runs_east_ ? TrackSide::kLeft : TrackSide::kRight;
  }
  [[nodiscard]] TrackSide south() const {
    return runs_east_ ? TrackSide::kRight : TrackSide::kLeft;
  }
  [[nodiscard]] double ChainageAt_m(double x_m) const { return runs_east_ ? x_m : 2000.0 - x_m; }
  /// From where to where something runs, westernmost first.
  [[nodiscard]] std::vector<double> PlacesOf_x_m(const StretchSpec& stretch) const {
    std::vector<double> places_m = {ChainageAt_m(stretch.begin_s_m), ChainageAt_m(stretch.end_s_m)};
    std::ranges::sort(places_m);
    return places_m;
  }
  /// The structures of a type, in their order.
  template <class Structure>
  [[nodiscard]] std::vector<Structure> All() const {
    std::vector<Structure> all;
    for (const StructureSpec& structure : world_.structures) {
      if (const auto* one = std::get_if<Structure>(&structure)) all.push_back(*one);
    }
    return all;
  }
  /// The structure of a type of which there must be one.
  template <class Structure>
  [[nodiscard]] Structure Only() const {
    const std::vector<Structure> all = All<Structure>();
    EXPECT_EQ(all.size(), 1U);
    return all.empty() ? Structure{} : all[0];
  }
  /// Why things of a kind were left out.
  [[nodiscard]] std::vector<std::string> ReasonsFor(const std::string& what) const {
    std::vector<std::string> reasons;
    for (const LeftOut& thing : world_.left_out) {
      if (thing.what == what) reasons.push_back(thing.reason);
    }
    return reasons;
  }

 private:
  RailMap map_{.nodes = {}, .ways = {}, .things = {}, .attribution = "Test"};
  bool runs_east_ = true;
  TrackLine track_;
  ImportedLine line_;
  LineWorld world_;
};

/// A map of these tracks and nothing else, made.
[[nodiscard]] inline MadeMap ImportedTracks(std::initializer_list<MadeMap::Track> tracks) {
  MadeMap map(tracks);
  map.Make();
  return map;
}

}  // namespace railcast
