#include "generator/extras/import/map/osm_map.h"

#include <algorithm>
#include <utility>

#include "core/base/text.h"
#include "generator/extras/import/map/map_formats.h"

namespace railcast {
namespace {

std::string ShownDegrees(const Eigen::Vector2d& place_deg) {
  return NumberText(place_deg.x()) + ", " + NumberText(place_deg.y());
}

std::string NameOfElement(const std::string& kind, std::int64_t id) {
  return kind + " " + std::to_string(id);
}

constexpr const char* kOneTime = "must be the same wherever it is: histories are not read";

bool IsKept(const MapTags& tags) {
  return IsTrack(TagOf(tags, "railway")) || IsThing(tags);
}

}  // namespace

std::optional<Fault> CheckLife(const char* action, const char* visible, bool& is_deleted) {
  const std::string_view act = action == nullptr ? "modify" : action;
  const std::string_view seen = visible == nullptr ? "true" : visible;
  is_deleted = act == "delete" || seen == "false";
  if (!is_deleted && act != "modify" && act != "create") {
    return Fault{"action", "must be create, modify or delete", Quoted(act)};
  }
  if (seen == "true" || seen == "false") return std::nullopt;
  return Fault{"visible", "must be true or false", Quoted(seen)};
}

void RefuseRemark(const std::string& place, std::string_view remark) {
  throw InputError(place +
                   ": the answer is not whole; ask again with a smaller area or a longer timeout " +
                   "(got \"" + ShownPath(std::filesystem::path(remark)) + "\")");
}

void OsmMapMaker::Tell(RemarkKind kind,
                       std::string place,
                       std::uint64_t number,
                       std::string detail) {
  map_.remarks.push_back({kind, std::move(place), number, std::move(detail)});
}

std::optional<Fault> OsmMapMaker::AddPlace(std::int64_t id, const Eigen::Vector2d& place_deg) {
  const auto [entry, is_new] = places_deg_.try_emplace(id, place_deg);
  if (entry->second == place_deg) return std::nullopt;
  return Fault{
      "",
      "must be where node " + std::to_string(id) + " is before, at " + ShownDegrees(entry->second),
      ShownDegrees(place_deg)};
}

std::optional<Fault> OsmMapMaker::AddNode(std::int64_t id,
                                          const Eigen::Vector2d& place_deg,
                                          MapTags tags) {
  if (deleted_.contains(id)) return Fault{"", kOneTime, "deleted, and not deleted"};
  if (auto fault = AddPlace(id, place_deg)) return fault;
  // An answer may repeat nodes, with their tags or without.
  if (tags.empty()) return std::nullopt;
  if (const auto known = node_tags_.find(id); known != node_tags_.end()) {
    if (known->second == tags) return std::nullopt;
    return Fault{"", kOneTime, "other tags than before"};
  }
  if (IsThing(tags)) map_.things.push_back({{place_deg}, {}, tags});
  node_tags_.emplace(id, std::move(tags));
  return std::nullopt;
}

std::optional<Fault> OsmMapMaker::AddWay(OsmWay way) {
  if (deleted_ways_.contains(way.id)) return Fault{"", kOneTime, "deleted, and not deleted"};
  const auto before = way_of_id_.find(way.id);
  const bool has_other_tags =
      before != way_of_id_.end() && !way.tags.empty() && ways_[before->second].tags != way.tags;
  if (has_other_tags) return Fault{"", kOneTime, "other tags than before"};
  if (!IsKept(way.tags)) {
    ++num_others_;
    const std::string unread = UnreadTrackTag(way.tags);
    if (!unread.empty() && other_tracks_.insert(way.id).second) {
      Tell(RemarkKind::kLinesLeftOut, NameOfElement("way", way.id), 1, unread);
    }
    return std::nullopt;
  }
  const auto [known, is_new] = way_of_id_.try_emplace(way.id, ways_.size());
  if (!is_new) {
    if (ways_[known->second].nodes == way.nodes) return std::nullopt;
    return Fault{"", "must have the same nodes wherever it is", "others than before"};
  }
  for (std::size_t i = 0; i < std::min(way.nodes.size(), way.drawn_deg.size()); ++i) {
    if (!way.drawn_deg[i]) continue;
    if (auto fault = AddPlace(way.nodes[i], *way.drawn_deg[i])) return fault;
  }
  const bool has_two =
      way.nodes.empty()
          ? std::ranges::adjacent_find(way.drawn_deg, std::not_equal_to{}) != way.drawn_deg.end()
          : std::ranges::adjacent_find(way.nodes, std::not_equal_to{}) != way.nodes.end();
  if (!has_two) {
    const bool is_empty = way.nodes.empty() && way.drawn_deg.empty();
    return Fault{"", "must have two different nodes or more", is_empty ? "0" : "1"};
  }
  needed_.insert(way.nodes.begin(), way.nodes.end());
  ways_.push_back(std::move(way));
  return std::nullopt;
}

void OsmMapMaker::AddRelation(std::int64_t id, const MapTags& tags) {
  if (!IsPlatform(tags)) return;
  Tell(RemarkKind::kOutlinesLeftOut, NameOfElement("relation", id), 1, "it has several parts");
}

std::optional<Fault> OsmMapMaker::AddDeleted(const std::string& kind,
                                             std::int64_t id,
                                             const MapTags& tags) {
  const bool is_alive =
      (kind == "node" && places_deg_.contains(id)) || (kind == "way" && way_of_id_.contains(id));
  if (is_alive) return Fault{"", kOneTime, "deleted, and not deleted"};
  if (kind == "way") deleted_ways_.insert(id);
  if (kind == "node" && !deleted_.try_emplace(id, IsThing(tags)).second) return std::nullopt;
  if (IsKept(tags)) Tell(RemarkKind::kDeletedLeftOut, NameOfElement(kind, id));
  return std::nullopt;
}

std::size_t OsmMapMaker::NodeAt(const Eigen::Vector2d& place_deg) {
  const auto [entry, is_new] =
      node_at_.try_emplace({place_deg.x(), place_deg.y()}, map_.nodes.size());
  if (is_new) map_.nodes.push_back({.geographic_deg = place_deg, .tags = {}});
  return entry->second;
}

std::size_t OsmMapMaker::TrackNode(const OsmWay& way,
                                   std::size_t i,
                                   const Eigen::Vector2d& place_deg) {
  const std::size_t index = NodeAt(place_deg);
  if (way.nodes.empty()) return index;
  const std::int64_t id = way.nodes[i];
  const std::int64_t first = id_of_node_.try_emplace(index, id).first->second;
  if (first != id && joined_.insert(id).second) {
    Tell(RemarkKind::kPlacesJoined, NameOfElement("node", id), 1,
         "it is where node " + std::to_string(first) + " is");
  }
  const auto tags = node_tags_.find(id);
  MapNode& node = map_.nodes[index];
  if (tags == node_tags_.end() || !node.tags.empty()) return index;
  node.tags = tags->second;
  const std::string_view height = TagOf(node.tags, "ele");
  const std::optional<double> height_m = NumberIn(height);
  if (height_m && IsHeight(*height_m)) {
    node.height_m = height_m;
  } else if (!height.empty()) {
    Tell(RemarkKind::kTagsUnread, NameOfElement("node", id), 1, "ele=" + ShownText(height));
  }
  return index;
}

std::optional<Eigen::Vector2d> OsmMapMaker::PlaceOf_deg(const OsmWay& way, std::size_t i) const {
  if (i < way.drawn_deg.size() && way.drawn_deg[i]) return way.drawn_deg[i];
  if (way.nodes.empty()) return std::nullopt;
  const auto found = places_deg_.find(way.nodes[i]);
  return found == places_deg_.end() ? std::nullopt : std::optional(found->second);
}

void OsmMapMaker::MakeTrack(const OsmWay& way) {
  MapWay run{way.id, {}, way.tags, NameOfElement("way", way.id)};
  std::uint64_t num_missing = 0;
  const auto end_run = [&] {
    if (run.nodes.size() >= 2) map_.ways.push_back(run);
    run.nodes.clear();
  };
  for (std::size_t i = 0; i < std::max(way.nodes.size(), way.drawn_deg.size()); ++i) {
    const auto deleted = i < way.nodes.size() ? deleted_.find(way.nodes[i]) : deleted_.end();
    if (deleted != deleted_.end()) {
      if (!std::exchange(deleted->second, true)) {
        Tell(RemarkKind::kDeletedLeftOut, NameOfElement("node", way.nodes[i]));
      }
    } else if (const auto place_deg = PlaceOf_deg(way, i)) {
      AppendNode(TrackNode(way, i, *place_deg), run);
    } else {
      ++num_missing;
      end_run();
    }
  }
  end_run();
  if (num_missing > 0) {
    Tell(RemarkKind::kNodesMissing, NameOfElement("way", way.id), num_missing);
  }
}

void OsmMapMaker::MakeThing(OsmWay& way) {
  MapThing thing{{}, {}, std::move(way.tags)};
  std::uint64_t num_missing = 0;
  for (std::size_t i = 0; i < std::max(way.nodes.size(), way.drawn_deg.size()); ++i) {
    if (i < way.nodes.size() && deleted_.contains(way.nodes[i])) continue;
    const auto place_deg = PlaceOf_deg(way, i);
    if (!place_deg) {
      ++num_missing;
    } else if (thing.geographic_deg.empty() || thing.geographic_deg.back() != *place_deg) {
      thing.geographic_deg.push_back(*place_deg);
    }
  }
  // An outline with a gap is another outline.
  if (num_missing > 0) {
    Tell(RemarkKind::kOutlinesLeftOut, NameOfElement("way", way.id), 1,
         std::to_string(num_missing) + " of its nodes are missing");
  } else if (!thing.geographic_deg.empty()) {
    map_.things.push_back(std::move(thing));
  }
}

RailMap OsmMapMaker::Make() {
  std::size_t num_tracks = 0;
  for (OsmWay& way : ways_) {
    if (IsTrack(TagOf(way.tags, "railway"))) {
      ++num_tracks;
      MakeTrack(way);
    } else {
      MakeThing(way);
    }
  }
  if (map_.ways.empty()) {
    const std::size_t num_ways = num_others_ + ways_.size();
    throw InputError(num_tracks > 0
                         ? "must have the nodes of its tracks (ask Overpass for the nodes, too: >; "
                           "out;) (got no two neighbours of any track)"
                         : "must have a way with railway=rail or another kind of track (got " +
                               std::to_string(num_ways) + " other ways)");
  }
  map_.attribution = kOpenStreetMapAttribution;
  return std::move(map_);
}

}  // namespace railcast
