#include "generator/extras/import/map/map_formats.h"

#include <cpl_minixml.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "generator/extras/import/map/gdal_errors.h"

namespace railcast {
namespace {

using XmlTree = std::unique_ptr<CPLXMLNode, decltype(&CPLDestroyXMLNode)>;

/// Visits the elements of a name at any depth, in the order of the file.
void VisitElements(const CPLXMLNode* node,
                   const char* name,
                   const std::function<void(const CPLXMLNode&)>& visit) {
  for (; node != nullptr; node = node->psNext) {
    if (node->eType != CXT_Element) continue;
    if (EQUAL(node->pszValue, name)) {
      visit(*node);
    } else {
      VisitElements(node->psChild, name, visit);
    }
  }
}

std::string Attribute(const CPLXMLNode& element, const char* name) {
  return CPLGetXMLValue(&element, name, "");
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
class RailMlReader {
 public:
  void Read(const CPLXMLNode* root) {
    VisitElements(root, "geometricPositioningSystem",
                  [&](const CPLXMLNode& element) { ReadSystem(element); });
    VisitElements(root, "netElement", [&](const CPLXMLNode& element) { ReadNetElement(element); });
    for (const auto& [id, first] : like_degrees_) {
      if (first.empty()) continue;
      errors_.Add({"geometricPositioningSystem " + ShownText(id),
                   "must have a point that is in metres, and no degrees", first});
    }
    VisitElements(root, "speedSection",
                  [&](const CPLXMLNode& element) { ReadSpeedSection(element); });
    VisitElements(root, "superelevationCurve",
                  [&](const CPLXMLNode& element) { ReadSuperelevation(element); });
  }

  [[nodiscard]] ErrorList& errors() { return errors_; }
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

 private:
  void ReadSystem(const CPLXMLNode& element) {
    const std::string id = Attribute(element, "id");
    const std::string definition = Attribute(element, "crsDefinition");
    OGRSpatialReference from;
    OGRSpatialReference to;
    to.SetFromUserInput("EPSG:4326");
    if (definition.empty() || from.SetFromUserInput(definition.c_str()) != OGRERR_NONE) {
      errors_.Add({"geometricPositioningSystem " + ShownText(id) + "/crsDefinition",
                   "must be a coordinate system that PROJ knows, such as EPSG:4326",
                   definition.empty() ? "none" : ShownText(definition)});
      systems_[id] = nullptr;
      return;
    }
    // x is longitude or easting, whatever the system says (RTM:geometricCoordinate).
    from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (from.IsProjected() != 0) like_degrees_[id];
    systems_[id] = ToDegrees(OGRCreateCoordinateTransformation(&from, &to));
  }

  void ReadNetElement(const CPLXMLNode& element) {
    NetElement net{Attribute(element, "id"), CPLGetXMLValue(&element, "name.name", ""), {}, {}, {}};
    const std::string place = "netElement " + ShownText(net.id);
    all_nets_.insert(net.id);
    const std::size_t num_faults = errors_.size();
    VisitElements(element.psChild, "intrinsicCoordinate",
                  [&](const CPLXMLNode& intrinsic) { ReadPoint(intrinsic, place, net); });
    if (net.points.empty() || errors_.size() > num_faults) return;
    std::ranges::stable_sort(net.points, {}, &RailMlPoint::intrinsic);
    const auto is_same = [](const RailMlPoint& a, const RailMlPoint& b) {
      return a.geographic_deg == b.geographic_deg;
    };
    // clang 14 cannot compile std::ranges::unique.
    net.points.erase(std::unique(net.points.begin(), net.points.end(), is_same), net.points.end());
    const auto twice = std::ranges::adjacent_find(net.points, {}, &RailMlPoint::intrinsic);
    if (twice != net.points.end()) {
      errors_.Add({place, "must have one point at each intrinsicCoord",
                   "two at " + NumberText(twice->intrinsic)});
      return;
    }
    const auto num_without = std::ranges::count_if(
        net.points, [](const RailMlPoint& point) { return !point.height_m.has_value(); });
    if (num_without > 0 && static_cast<std::size_t>(num_without) < net.points.size()) {
      remarks_.push_back(
          {RemarkKind::kHeightsMissing, place, static_cast<std::uint64_t>(num_without)});
    }
    if (net.points.size() < 2) {
      errors_.Add(
          {place, "must have two different points or more", std::to_string(net.points.size())});
      return;
    }
    if (!net_ids_.emplace(net.id, nets_.size()).second) {
      errors_.Add({place, "must be there once", "twice"});
      return;
    }
    nets_.push_back(std::move(net));
  }

  void ReadPoint(const CPLXMLNode& intrinsic, const std::string& place, NetElement& net) {
    const CPLXMLNode* coordinate = CPLGetXMLNode(&intrinsic, "geometricCoordinate");
    if (coordinate == nullptr) return;
    constexpr double kNeeded = std::numeric_limits<double>::quiet_NaN();
    const auto at = NumberOf(intrinsic, place, "intrinsicCoord", kNeeded);
    const auto x = NumberOf(*coordinate, place, "x", kNeeded);
    const auto y = NumberOf(*coordinate, place, "y", kNeeded);
    if (!at || !x || !y) return;
    const std::string id = Attribute(*coordinate, "positioningSystemRef");
    const auto system = systems_.find(id);
    if (system == systems_.end()) {
      errors_.Add({place + "/positioningSystemRef",
                   "must be a geometricPositioningSystem of this file",
                   id.empty() ? "none" : ShownText(id)});
      return;
    }
    if (!system->second) return;  // Its fault is known.
    if (const auto first = like_degrees_.find(id); first != like_degrees_.end()) {
      if (std::abs(*x) > kMostLongitude_deg || std::abs(*y) > kMostLatitude_deg) {
        like_degrees_.erase(first);
      } else if (first->second.empty()) {
        first->second = NumberText(*x) + ", " + NumberText(*y);
      }
    }
    RailMlPoint point{*at, {*x, *y}, {}};
    if (system->second->Transform(1, &point.geographic_deg.x(), &point.geographic_deg.y()) == 0 ||
        !(std::abs(point.geographic_deg.x()) <= kMostLongitude_deg &&
          std::abs(point.geographic_deg.y()) <= kMostLatitude_deg)) {
      errors_.Add({place, "must be a place in its coordinate system",
                   NumberText(*x) + ", " + NumberText(*y)});
      return;
    }
    if (!Attribute(*coordinate, "z").empty()) {
      const auto height_m = NumberOf(*coordinate, place, "z", kNeeded);
      if (!height_m) return;
      if (!IsHeight(*height_m)) {
        errors_.Add({place + "/z", kHeightRule, NumberText(*height_m)});
        return;
      }
      point.height_m = height_m;
    }
    net.points.push_back(point);
  }

  void ReadSpeedSection(const CPLXMLNode& element) {
    const std::string place = "speedSection " + ShownText(Attribute(element, "id"));
    const std::string speed = Attribute(element, "maxSpeed");
    const std::optional<double> value_kmph = NumberIn(speed);
    // Some say "end of track section" or refer to a profile.
    if (!value_kmph) {
      remarks_.push_back({RemarkKind::kSpeedsUnread, place, 1,
                          speed.empty() ? "no maxSpeed" : "maxSpeed=" + ShownText(speed)});
      return;
    }
    if (!(*value_kmph > 0.0)) {
      errors_.Add({place + "/maxSpeed", "must be > 0", ShownText(speed)});
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

  void ReadSuperelevation(const CPLXMLNode& element) {
    const std::string place = "superelevationCurve " + ShownText(Attribute(element, "id"));
    const auto begin_mm =
        NumberOf(element, place, "superelevation", std::numeric_limits<double>::quiet_NaN());
    const auto change_mm = NumberOf(element, place, "deltaSuperelevation", 0.0);
    if (!begin_mm || !change_mm) return;
    const double end_mm = *begin_mm + *change_mm;
    const auto is_cant = [](double cant_mm) { return cant_mm >= 0.0 && cant_mm <= 300.0; };
    if (!is_cant(*begin_mm) || !is_cant(end_mm)) {
      errors_.Add({place, "must have cants from 0 to 300 mm",
                   NumberText(*begin_mm) + ", " + NumberText(end_mm)});
      return;
    }
    VisitStretches(element, place, [&](NetElement& net, double begin, double end) {
      net.cants.push_back({begin, end, *begin_mm, end_mm});
    });
  }

  /// Visits the net elements with coordinates on which something is, with its intrinsic
  /// coordinates.
  void VisitStretches(const CPLXMLNode& element,
                      const std::string& place,
                      const std::function<void(NetElement&, double begin, double end)>& visit) {
    VisitElements(element.psChild, "associatedNetElement", [&](const CPLXMLNode& associated) {
      const std::string id = Attribute(associated, "netElementRef");
      const auto net = net_ids_.find(id);
      if (!all_nets_.contains(id)) {
        errors_.Add({place + "/netElementRef", "must be a netElement of this file", ShownText(id)});
      }
      // Net elements of upper levels have no coordinates.
      if (net == net_ids_.end()) return;
      const auto begin = NumberOf(associated, place, "intrinsicCoordBegin", 0.0);
      const auto end = NumberOf(associated, place, "intrinsicCoordEnd", 1.0);
      if (!begin || !end) return;
      if (!(*begin >= 0.0 && *end <= 1.0 && *begin < *end)) {
        errors_.Add({place, "must have intrinsicCoordBegin < intrinsicCoordEnd, both from 0 to 1",
                     NumberText(*begin) + ", " + NumberText(*end)});
        return;
      }
      visit(nets_[net->second], *begin, *end);
    });
  }

  /// A number; `otherwise` if it is not given, unless that is NaN.
  [[nodiscard]] std::optional<double> NumberOf(const CPLXMLNode& element,
                                               const std::string& place,
                                               const char* name,
                                               double otherwise) {
    const std::string text = Attribute(element, name);
    if (text.empty() && !std::isnan(otherwise)) return otherwise;
    const std::optional<double> value = NumberIn(text);
    if (!value) {
      errors_.Add(
          {place + "/" + name, "must be a number", text.empty() ? "none" : ShownText(text)});
    }
    return value;
  }

  ErrorList errors_;
  std::vector<Remark> remarks_;
  std::map<std::string, ToDegrees> systems_;  ///< By id.
  /// The first system in metres whose points may all be degrees.
  std::map<std::string, std::string> like_degrees_;
  std::set<std::string> all_nets_;  ///< Also those without coordinates.
  std::vector<NetElement> nets_;
  std::map<std::string, std::size_t> net_ids_;
};

/// Version 2 has a root in small letters.
void RefuseOlder(const CPLXMLNode& tree, const std::filesystem::path& file) {
  for (const CPLXMLNode* node = &tree; node != nullptr; node = node->psNext) {
    if (node->eType != CXT_Element || std::string_view(node->pszValue) != "railml") continue;
    throw InputError(ShownPath(file) +
                     ": must be railML 3, which has coordinates of its net (got "
                     "railML " +
                     ShownText(CPLGetXMLValue(node, "version", "2")) + ")");
  }
}

}  // namespace

bool IsRailMl(std::string_view begin) {
  // Version 2 has small letters.
  for (const std::string_view root : {"<railML", ":railML", "<railml", ":railml"}) {
    if (begin.find(root) != std::string_view::npos) return true;
  }
  return false;
}

RailMap ReadRailMl(const std::filesystem::path& file) {
  const std::string text = ReadTextWhole(file);
  GdalErrors gdal_errors;
  const XmlTree tree(CPLParseXMLString(text.c_str()), &CPLDestroyXMLNode);
  if (!tree) {
    throw InputError(ShownPath(file) + ": must be XML to its end (" +
                     ShownText(gdal_errors.first()) + ")");
  }
  CPLStripXMLNamespace(tree.get(), nullptr, 1);
  RefuseOlder(*tree, file);
  RailMlReader reader;
  reader.Read(tree.get());
  AtPlace(ShownPath(file) + ": ", [&] { reader.errors().ThrowIfAny(); });
  RailMap map = reader.Map();
  if (map.ways.empty()) {
    throw InputError(ShownPath(file) +
                     ": must have a netElement with geometricCoordinates (got none)");
  }
  return map;
}

}  // namespace railcast
