#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "generator/extras/import/map/gdal_errors.h"
#include "generator/extras/import/map/xml_file.h"

namespace railcast {
namespace {

/// An element that is read, with those in it.
struct RailMlElement {
  std::string name;
  std::map<std::string, std::string, std::less<>> attributes;
  std::uint64_t line{};
  std::vector<RailMlElement> inside;

  [[nodiscard]] std::string operator[](std::string_view attribute) const {
    const auto found = attributes.find(attribute);
    return found == attributes.end() ? "" : found->second;
  }
};

constexpr std::array<std::string_view, 7> kReadElements = {
    "associatedNetElement", "geometricCoordinate", "geometricPositioningSystem",
    "intrinsicCoordinate",  "netElement",          "speedSection",
    "superelevationCurve"};

/// Visits the elements of a name in another, in the order of the file.
void VisitElements(const RailMlElement& element,
                   std::string_view name,
                   const std::function<void(const RailMlElement&)>& visit) {
  for (const RailMlElement& inner : element.inside) {
    if (inner.name == name) visit(inner);
  }
}

struct RailMlPoint {
  double intrinsic{};  ///< 0 at the beginning of its net element, 1 at its end.
  Eigen::Vector2d geographic_deg;
  std::optional<double> height_m;
};

/// Where the outer rail is higher than the inner one; linear between the intrinsic coordinates.
struct CantedStretch {
  double begin{};
  double end{};
  double begin_mm{};
  double end_mm{};
};

struct NetElement {
  std::string id;
  std::string name;
  std::vector<RailMlPoint> points;
  std::map<double, std::string> speeds;  ///< From an intrinsic coordinate on; empty: none.
  std::vector<CantedStretch> cants;
};

using ToDegrees = std::unique_ptr<OGRCoordinateTransformation>;

/// The surveyed cant of a net element: 0 where it says nothing, the larger one where two meet; none
/// if it says nothing at all.
std::optional<double> CantOn(const NetElement& net, double intrinsic) {
  if (net.cants.empty()) return std::nullopt;
  double cant_mm = 0.0;
  for (const CantedStretch& stretch : net.cants) {
    if (intrinsic < stretch.begin || intrinsic > stretch.end) continue;
    const double share = (intrinsic - stretch.begin) / (stretch.end - stretch.begin);
    cant_mm = std::max(cant_mm, stretch.begin_mm + share * (stretch.end_mm - stretch.begin_mm));
  }
  return cant_mm;
}

/// The point at an intrinsic coordinate: a given one, or one between two.
RailMlPoint PointOnNet(const std::vector<RailMlPoint>& points, double intrinsic) {
  const auto after = std::ranges::lower_bound(points, intrinsic, {}, &RailMlPoint::intrinsic);
  if (after == points.end()) return points.back();
  if (after == points.begin() || after->intrinsic == intrinsic) return *after;
  const RailMlPoint& a = *std::prev(after);
  const double share = (intrinsic - a.intrinsic) / (after->intrinsic - a.intrinsic);
  RailMlPoint point{
      intrinsic, a.geographic_deg + share * (after->geographic_deg - a.geographic_deg), {}};
  if (a.height_m && after->height_m) {
    point.height_m = *a.height_m + share * (*after->height_m - *a.height_m);
  }
  return point;
}

/// The points of a net element and those at which its cant changes in another way than before.
std::vector<RailMlPoint> PointsWithCants(const NetElement& net) {
  std::set<double> added;
  for (const CantedStretch& stretch : net.cants) added.insert({stretch.begin, stretch.end});
  for (const RailMlPoint& point : net.points) added.erase(point.intrinsic);
  std::vector<RailMlPoint> points = net.points;
  for (const double intrinsic : added) points.push_back(PointOnNet(net.points, intrinsic));
  std::ranges::sort(points, {}, &RailMlPoint::intrinsic);
  return points;
}
/// Reads the tracks of railML 3: net elements with coordinates in a geometric positioning system,
/// whatever its coordinate system, and the speed sections and cants on them.
///
/// A net element is a way through its coordinates, in order of `intrinsicCoord`; `z` is its height.
/// Net elements without coordinates, as upper levels of the topology have none, are left out. Speed
/// sections divide the ways where they begin and end.
class RailMlReader final : public XmlMapReader {
 public:
  explicit RailMlReader(XmlFaults& faults) : faults_(faults) {}

  void Begin(const XmlElement& element) override {
    // Version 2 has a root in small letters.
    if (open_.empty() && element.name == "railml") {
      const char* const version = element.ValueOf("version");
      throw InputError("must be railML 3, which has coordinates of its net (got railML " +
                       ShownText(version == nullptr ? "2" : version) + ")");
    }
    RailMlElement& outer = open_.empty() ? root_ : *open_.back().nearest;
    const bool is_read = std::ranges::find(kReadElements, element.name) != kReadElements.end();
    if (element.name == "name" && !open_.empty() && open_.back().is_read) {
      const char* const name = element.ValueOf("name");
      if (name != nullptr) outer.attributes["name"] = name;
    }
    if (is_read) {
      RailMlElement& inner = outer.inside.emplace_back();
      inner.name = element.name;
      inner.line = element.line;
      for (const char* const* at = element.attributes; *at != nullptr; at += 2) {
        inner.attributes.emplace(at[0], at[1]);
      }
      open_.push_back({&inner, true});
    } else {
      open_.push_back({&outer, false});
    }
  }
  void End(std::string_view /*name*/, std::string_view /*text*/, std::uint64_t /*line*/) override {
    open_.pop_back();
  }

  RailMap Make() override {
    const GdalErrors not_printed;
    Read();
    faults_.list().ThrowIfAny();
    RailMap map = Map();
    if (!map.ways.empty()) return map;
    throw InputError("must have a netElement with geometricCoordinates (got none)");
  }

 private:
  void Read() {
    VisitElements(root_, "geometricPositioningSystem",
                  [&](const RailMlElement& element) { ReadSystem(element); });
    VisitElements(root_, "netElement",
                  [&](const RailMlElement& element) { ReadNetElement(element); });
    for (const auto& [id, first] : like_degrees_) {
      if (first.place.empty()) continue;
      faults_.Add(first.line, "geometricPositioningSystem " + ShownText(id),
                  "must have a point that is in metres, and no degrees", first.place);
    }
    VisitElements(root_, "speedSection",
                  [&](const RailMlElement& element) { ReadSpeedSection(element); });
    VisitElements(root_, "superelevationCurve",
                  [&](const RailMlElement& element) { ReadSuperelevation(element); });
  }

  [[nodiscard]] RailMap Map() const {
    RailMap map;
    map.remarks = remarks_;
    std::map<std::pair<double, double>, std::size_t> nodes;
    const auto append = [&](const NetElement& net, const RailMlPoint& point, MapWay& way) {
      const auto [entry, is_new] =
          nodes.try_emplace({point.geographic_deg.x(), point.geographic_deg.y()}, map.nodes.size());
      if (is_new) {
        map.nodes.push_back({.geographic_deg = point.geographic_deg,
                             .height_m = point.height_m,
                             .cant_mm = std::nullopt,
                             .tags = {}});
      }
      // Where two net elements meet, one that says nothing of its cant leaves it to the other.
      std::optional<double>& cant_mm = map.nodes[entry->second].cant_mm;
      if (!cant_mm) cant_mm = CantOn(net, point.intrinsic);
      AppendNode(entry->second, way);
    };
    for (const NetElement& net : nets_) {
      const std::vector<RailMlPoint> points = PointsWithCants(net);
      std::set<double> ends = {0.0, 1.0};
      for (const auto& [begin, speed] : net.speeds) ends.insert(begin);
      for (auto end = std::next(ends.begin()); end != ends.end(); ++end) {
        const double begin = *std::prev(end);
        MapWay way{static_cast<std::int64_t>(map.ways.size()), {}, {{"railway", "rail"}}};
        way.place = "netElement " + ShownText(net.id);
        if (!net.name.empty()) way.tags["name"] = net.name;
        const auto after = net.speeds.upper_bound(begin);
        if (after != net.speeds.begin() && !std::prev(after)->second.empty()) {
          way.tags["maxspeed"] = std::prev(after)->second;
        }
        append(net, PointOnNet(net.points, begin), way);
        for (const RailMlPoint& point : points) {
          if (point.intrinsic > begin && point.intrinsic < *end) append(net, point, way);
        }
        append(net, PointOnNet(net.points, *end), way);
        if (way.nodes.size() >= 2) map.ways.push_back(std::move(way));
      }
    }
    return map;
  }

  void ReadSystem(const RailMlElement& element) {
    const std::string id = element["id"];
    const std::string definition = element["crsDefinition"];
    OGRSpatialReference from;
    OGRSpatialReference to;
    to.SetFromUserInput("EPSG:4326");
    if (definition.empty() || from.SetFromUserInput(definition.c_str()) != OGRERR_NONE) {
      faults_.Add(element.line, "geometricPositioningSystem " + ShownText(id) + "/crsDefinition",
                  "must be a coordinate system that PROJ knows, such as EPSG:4326",
                  definition.empty() ? "none" : ShownText(definition));
      systems_[id] = nullptr;
      return;
    }
    // x is longitude or easting, whatever the system says (RTM:geometricCoordinate).
    from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (from.IsProjected() != 0) like_degrees_[id].line = element.line;
    systems_[id] = ToDegrees(OGRCreateCoordinateTransformation(&from, &to));
  }

  void ReadNetElement(const RailMlElement& element) {
    NetElement net{element["id"], element["name"], {}, {}, {}};
    const std::string place = "netElement " + ShownText(net.id);
    all_nets_.insert(net.id);
    const std::size_t num_faults = faults_.list().size();
    VisitElements(element, "intrinsicCoordinate",
                  [&](const RailMlElement& intrinsic) { ReadPoint(intrinsic, place, net); });
    if (net.points.empty() || faults_.list().size() > num_faults) return;
    std::ranges::stable_sort(net.points, {}, &RailMlPoint::intrinsic);
    const auto is_same = [](const RailMlPoint& a, const RailMlPoint& b) {
      return a.geographic_deg == b.geographic_deg;
    };
    // clang 14 cannot compile std::ranges::unique.
    net.points.erase(std::unique(net.points.begin(), net.points.end(), is_same), net.points.end());
    const auto twice = std::ranges::adjacent_find(net.points, {}, &RailMlPoint::intrinsic);
    if (twice != net.points.end()) {
      faults_.Add(element.line, place, "must have one point at each intrinsicCoord",
                  "two at " + NumberText(twice->intrinsic));
      return;
    }
    const auto num_without = std::ranges::count_if(
        net.points, [](const RailMlPoint& point) { return !point.height_m.has_value(); });
    if (num_without > 0 && static_cast<std::size_t>(num_without) < net.points.size()) {
      remarks_.push_back(
          {RemarkKind::kHeightsMissing, place, static_cast<std::uint64_t>(num_without)});
    }
    if (net.points.size() < 2) {
      faults_.Add(element.line, place, "must have two different points or more",
                  std::to_string(net.points.size()));
      return;
    }
    if (!net_ids_.emplace(net.id, nets_.size()).second) {
      faults_.Add(element.line, place, "must be there once", "twice");
      return;
    }
    nets_.push_back(std::move(net));
  }

  void ReadPoint(const RailMlElement& intrinsic, const std::string& place, NetElement& net) {
    const auto coordinate =
        std::ranges::find(intrinsic.inside, "geometricCoordinate", &RailMlElement::name);
    if (coordinate == intrinsic.inside.end()) return;
    constexpr double kNeeded = std::numeric_limits<double>::quiet_NaN();
    const auto at = NumberOf(intrinsic, place, "intrinsicCoord", kNeeded);
    const auto x = NumberOf(*coordinate, place, "x", kNeeded);
    const auto y = NumberOf(*coordinate, place, "y", kNeeded);
    if (!at || !x || !y) return;
    const std::string id = (*coordinate)["positioningSystemRef"];
    const auto system = systems_.find(id);
    if (system == systems_.end()) {
      faults_.Add(coordinate->line, place + "/positioningSystemRef",
                  "must be a geometricPositioningSystem of this file",
                  id.empty() ? "none" : ShownText(id));
      return;
    }
    if (!system->second) return;  // Its fault is known.
    if (const auto first = like_degrees_.find(id); first != like_degrees_.end()) {
      if (std::abs(*x) > kMostLongitude_deg || std::abs(*y) > kMostLatitude_deg) {
        like_degrees_.erase(first);
      } else if (first->second.place.empty()) {
        first->second.place = NumberText(*x) + ", " + NumberText(*y);
      }
    }
    RailMlPoint point{*at, {*x, *y}, {}};
    if (system->second->Transform(1, &point.geographic_deg.x(), &point.geographic_deg.y()) == 0 ||
        !(std::abs(point.geographic_deg.x()) <= kMostLongitude_deg &&
          std::abs(point.geographic_deg.y()) <= kMostLatitude_deg)) {
      faults_.Add(coordinate->line, place, "must be a place in its coordinate system",
                  NumberText(*x) + ", " + NumberText(*y));
      return;
    }
    if (!(*coordinate)["z"].empty()) {
      const auto height_m = NumberOf(*coordinate, place, "z", kNeeded);
      if (!height_m) return;
      if (!IsHeight(*height_m)) {
        faults_.Add(coordinate->line, place + "/z", kHeightRule, NumberText(*height_m));
        return;
      }
      point.height_m = height_m;
    }
    net.points.push_back(point);
  }

  void ReadSpeedSection(const RailMlElement& element) {
    const std::string place = "speedSection " + ShownText(element["id"]);
    const std::string speed = element["maxSpeed"];
    const std::optional<double> value_kmph = NumberIn(speed);
    // Some say "end of track section" or refer to a profile.
    if (!value_kmph) {
      remarks_.push_back({RemarkKind::kSpeedsUnread, place, 1,
                          speed.empty() ? "no maxSpeed" : "maxSpeed=" + ShownText(speed)});
      return;
    }
    if (!(*value_kmph > 0.0)) {
      faults_.Add(element.line, place + "/maxSpeed", "must be > 0", ShownText(speed));
      return;
    }
    VisitStretches(element, place, [&](NetElement& net, double begin, double end) {
      const auto after = net.speeds.upper_bound(end);
      const std::string behind = after == net.speeds.begin() ? "" : std::prev(after)->second;
      net.speeds.erase(net.speeds.lower_bound(begin), after);
      net.speeds[begin] = speed;
      net.speeds[end] = behind;
    });
  }

  void ReadSuperelevation(const RailMlElement& element) {
    const std::string place = "superelevationCurve " + ShownText(element["id"]);
    const auto begin_mm =
        NumberOf(element, place, "superelevation", std::numeric_limits<double>::quiet_NaN());
    const auto change_mm = NumberOf(element, place, "deltaSuperelevation", 0.0);
    if (!begin_mm || !change_mm) return;
    const double end_mm = *begin_mm + *change_mm;
    const auto is_cant = [](double cant_mm) { return cant_mm >= 0.0 && cant_mm <= 300.0; };
    if (!is_cant(*begin_mm) || !is_cant(end_mm)) {
      faults_.Add(element.line, place, "must have cants from 0 to 300 mm",
                  NumberText(*begin_mm) + ", " + NumberText(end_mm));
      return;
    }
    VisitStretches(element, place, [&](NetElement& net, double begin, double end) {
      net.cants.push_back({begin, end, *begin_mm, end_mm});
    });
  }

  /// Visits the net elements with coordinates on which something is, with its intrinsic
  /// coordinates.
  void VisitStretches(const RailMlElement& element,
                      const std::string& place,
                      const std::function<void(NetElement&, double begin, double end)>& visit) {
    VisitElements(element, "associatedNetElement", [&](const RailMlElement& associated) {
      const std::string id = associated["netElementRef"];
      const auto net = net_ids_.find(id);
      if (!all_nets_.contains(id)) {
        faults_.Add(associated.line, place + "/netElementRef", "must be a netElement of this file",
                    ShownText(id));
      }
      // Net elements of upper levels have no coordinates.
      if (net == net_ids_.end()) return;
      const auto begin = NumberOf(associated, place, "intrinsicCoordBegin", 0.0);
      const auto end = NumberOf(associated, place, "intrinsicCoordEnd", 1.0);
      if (!begin || !end) return;
      if (!(*begin >= 0.0 && *end <= 1.0 && *begin < *end)) {
        faults_.Add(associated.line, place,
                    "must have intrinsicCoordBegin < intrinsicCoordEnd, both from 0 to 1",
                    NumberText(*begin) + ", " + NumberText(*end));
        return;
      }
      visit(nets_[net->second], *begin, *end);
    });
  }

  /// A number; `otherwise` if it is not given, unless that is NaN.
  [[nodiscard]] std::optional<double> NumberOf(const RailMlElement& element,
                                               const std::string& place,
                                               const char* name,
                                               double otherwise) {
    const std::string text = element[name];
    if (text.empty() && !std::isnan(otherwise)) return otherwise;
    const std::optional<double> value = NumberIn(text);
    if (!value) {
      faults_.Add(element.line, place + "/" + name, "must be a number",
                  text.empty() ? "none" : ShownText(text));
    }
    return value;
  }

  struct Open {
    RailMlElement* nearest;  ///< The innermost that is read; nothing is added beside it meanwhile.
    bool is_read;            ///< Whether it is the open element itself.
  };

  XmlFaults& faults_;
  RailMlElement root_;
  std::vector<Open> open_;  ///< Elements, outermost first.
  std::vector<Remark> remarks_;
  std::map<std::string, ToDegrees> systems_;  ///< By id.
  /// By id: systems in metres whose points may all be degrees.
  struct LikeDegrees {
    std::uint64_t line{};
    std::string place;  ///< Its first point, if it has one.
  };
  std::map<std::string, LikeDegrees> like_degrees_;
  std::set<std::string> all_nets_;  ///< Also those without coordinates.
  std::vector<NetElement> nets_;
  std::map<std::string, std::size_t> net_ids_;
};

}  // namespace

std::unique_ptr<XmlMapReader> MakeRailMlReader(XmlFaults& faults) {
  return std::make_unique<RailMlReader>(faults);
}

}  // namespace railcast
