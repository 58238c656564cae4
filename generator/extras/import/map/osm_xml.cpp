#include <algorithm>
#include <array>
#include <utility>

#include "core/base/text.h"
#include "generator/extras/import/map/osm_map.h"
#include "generator/extras/import/map/xml_file.h"

namespace railcast {
namespace {

bool IsOsmElement(std::string_view name) {
  return name == "node" || name == "way" || name == "relation";
}

/// What else OpenStreetMap's programs write, of which nothing is taken.
constexpr auto kOthers =
    std::to_array<std::string_view>({"osm", "bounds", "bound", "note", "meta", "nd", "tag",
                                     "member", "center", "remark", "changeset", "user", "gpx"});
class OsmXmlReader final : public XmlMapReader {
 public:
  explicit OsmXmlReader(XmlFaults& faults) : faults_(faults) {}

  void Begin(const XmlElement& element) override {
    if (IsOsmElement(element.name)) {
      BeginElement(element);
    } else if (element.name == "action") {
      throw InputError("line " + std::to_string(element.line) +
                       ": must be a map, and no changes from one to another (got <action>)");
    } else if (element.name == "nd" && kind_ == "way") {
      AddPoint(element);
    } else if (element.name == "tag" && !kind_.empty()) {
      const char* key = element.ValueOf("k");
      const char* value = element.ValueOf("v");
      if (key != nullptr && value != nullptr) tags_.emplace(key, value);
    } else if (std::ranges::find(kOthers, element.name) == kOthers.end()) {
      maker_.Tell(RemarkKind::kTagsUnread, "line " + std::to_string(element.line), 1,
                  "<" + ShownText(element.name) + ">");
    }
  }

  void End(std::string_view name, std::string_view text, std::uint64_t line) override {
    if (name == "remark") {
      RefuseRemark("line " + std::to_string(line) + ", remark", XmlTrimmed(text));
    }
    if (!IsOsmElement(name) || kind_.empty()) return;
    EndElement();
    kind_.clear();
  }

  RailMap Make() override { return maker_.Make(); }

 private:
  void BeginElement(const XmlElement& element) {
    kind_.clear();
    line_ = element.line;
    way_ = {};
    tags_.clear();
    place_deg_.reset();
    const auto id = XmlId(element, "id");
    if (!id) return;
    kind_ = element.name;
    id_ = *id;
    AddFault(CheckLife(element.ValueOf("action"), element.ValueOf("visible"), is_deleted_));
    // What is deleted may be without a place.
    if (kind_ != "node" || is_deleted_) return;
    place_deg_ = XmlPlace_deg(element, faults_);
    if (!place_deg_) kind_.clear();
  }

  void AddPoint(const XmlElement& element) {
    const bool is_drawn = element.ValueOf("lon") != nullptr || element.ValueOf("lat") != nullptr;
    const std::optional<Eigen::Vector2d> place_deg =
        is_drawn ? XmlPlace_deg(element, faults_) : std::nullopt;
    const bool has_id = element.ValueOf("ref") != nullptr || !is_drawn;
    if (const auto id = has_id ? XmlId(element, "ref") : std::nullopt) way_.nodes.push_back(*id);
    way_.drawn_deg.push_back(place_deg);
  }

  void EndElement() {
    if (is_deleted_) {
      AddFault(maker_.AddDeleted(kind_, id_, tags_));
    } else if (kind_ == "node") {
      AddFault(maker_.AddNode(id_, *place_deg_, std::move(tags_)));
    } else if (kind_ == "relation") {
      maker_.AddRelation(id_, tags_);
    } else if (!way_.nodes.empty() && way_.nodes.size() != way_.drawn_deg.size()) {
      AddFault(Fault{
          "nd", "must all have a ref or none",
          std::to_string(way_.nodes.size()) + " of " + std::to_string(way_.drawn_deg.size())});
    } else {
      way_.id = id_;
      way_.tags = std::move(tags_);
      AddFault(maker_.AddWay(std::move(way_)));
    }
  }

  [[nodiscard]] std::optional<std::int64_t> XmlId(const XmlElement& element, const char* key) {
    const char* value = element.ValueOf(key);
    const auto id = ParseNumber<std::int64_t>(value == nullptr ? "" : value);
    if (!id) {
      faults_.Add(element.line, std::string(element.name) + "/" + key,
                  "must be a whole number of 64 bits", value == nullptr ? "none" : Quoted(value));
    }
    return id;
  }

  [[nodiscard]] std::string Shown() const { return ShownText(kind_) + " " + std::to_string(id_); }
  void AddFault(std::optional<Fault> fault) {
    if (!fault) return;
    faults_.Add(line_, Shown() + (fault->place.empty() ? "" : "/") + fault->place, fault->rule,
                fault->value);
  }

  XmlFaults& faults_;
  OsmMapMaker maker_;
  // The node, way or relation that is open; without a kind there is none, or it is damaged.
  std::string kind_;
  std::uint64_t line_{};
  std::int64_t id_{};
  bool is_deleted_ = false;
  std::optional<Eigen::Vector2d> place_deg_;
  OsmWay way_;
  MapTags tags_;
};

}  // namespace

std::unique_ptr<XmlMapReader> MakeOsmXmlReader(XmlFaults& faults) {
  return std::make_unique<OsmXmlReader>(faults);
}

}  // namespace railcast
