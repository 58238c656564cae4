#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "generator/extras/import/map/rail_map.h"

namespace railcast {

/// A way as OpenStreetMap's formats have it.
struct OsmWay {
  std::int64_t id{};
  std::vector<std::int64_t> nodes;  ///< Their ids; none if the file has only their places.
  /// Their places, where the way has them (`out geom;`): as many, or none.
  std::vector<std::optional<Eigen::Vector2d>> drawn_deg;
  MapTags tags;
};

/// Makes a map of OpenStreetMap's elements, in whatever order and format they come.
///
/// Ways that are tracks and things (IsTrack, IsThing) are kept. Nodes in one place are one,
/// whatever their ids. A way is cut where a node of it is not in the file, and goes on without
/// nodes that are deleted. What is there twice is taken once, and refused if it differs, as in
/// histories.
class OsmMapMaker {
 public:
  /// @returns A fault, whose place is left to the caller, if the node is another before.
  [[nodiscard]] std::optional<Fault> AddNode(std::int64_t id,
                                             const Eigen::Vector2d& place_deg,
                                             MapTags tags);
  /// @returns A fault likewise: fewer than two different nodes, or others than before.
  [[nodiscard]] std::optional<Fault> AddWay(OsmWay way);
  /// Platforms of several outlines are left out.
  void AddRelation(std::int64_t id, const MapTags& tags);
  /// @param kind "node", "way" or "relation".
  /// @returns A fault likewise if it is not deleted before.
  [[nodiscard]] std::optional<Fault> AddDeleted(const std::string& kind,
                                                std::int64_t id,
                                                const MapTags& tags);

  /// Says what of the source is not taken as it stands.
  void Tell(RemarkKind kind, std::string place, std::uint64_t number = 1, std::string detail = {});

  /// Whether a way that was added needs the place of a node.
  [[nodiscard]] bool Needs(std::int64_t node) const { return needed_.contains(node); }

  /// @throws InputError if there is no track.
  [[nodiscard]] RailMap Make();

 private:
  [[nodiscard]] std::optional<Fault> AddPlace(std::int64_t id, const Eigen::Vector2d& place_deg);
  std::size_t NodeAt(const Eigen::Vector2d& place_deg);
  [[nodiscard]] std::size_t TrackNode(const OsmWay& way,
                                      std::size_t i,
                                      const Eigen::Vector2d& place_deg);
  [[nodiscard]] std::optional<Eigen::Vector2d> PlaceOf_deg(const OsmWay& way, std::size_t i) const;
  void MakeTrack(const OsmWay& way);
  void MakeThing(OsmWay& way);

  RailMap map_;
  std::vector<OsmWay> ways_;
  std::unordered_map<std::int64_t, std::size_t> way_of_id_;
  std::unordered_map<std::int64_t, Eigen::Vector2d> places_deg_;  ///< By the ids of nodes.
  std::unordered_map<std::int64_t, MapTags> node_tags_;
  std::unordered_set<std::int64_t> needed_;
  std::unordered_map<std::int64_t, bool> deleted_;  ///< Nodes, and whether they are told.
  std::unordered_set<std::int64_t> deleted_ways_;
  std::map<std::pair<double, double>, std::size_t> node_at_;
  std::unordered_map<std::size_t, std::int64_t> id_of_node_;
  std::unordered_set<std::int64_t> joined_;
  std::size_t num_others_ = 0;
  std::unordered_set<std::int64_t> other_tracks_;  ///< Ways among those that are told.
};

/// Whether the attributes of an element say that it is deleted: `action` as JOSM has it, `visible`
/// as histories do. Null stands for none.
/// @returns A fault, without a place, if they are something else than both write.
[[nodiscard]] std::optional<Fault> CheckLife(const char* action,
                                             const char* visible,
                                             bool& is_deleted);

/// @throws InputError that quotes an answer's remark: with it, Overpass says why it is not whole.
[[noreturn]] void RefuseRemark(const std::string& place, std::string_view remark);

}  // namespace railcast
