#include "generator/import/map/railml_map.h"

#include <cpl_minixml.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <charconv>
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

#include "core/base/attempt.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/write_file.h"
#include "generator/import/map/gdal_errors.h"

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

std::optional<double> NumberIn(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

struct RailMlPoint {
  double intrinsic{};  ///< 0 at the beginning of its net element, 1 at its end.
  Eigen::Vector2d geographic_deg;
  std::optional<double> height_m;
};

struct NetElement {
  std::string id;
  std::string name;
  std::vector<RailMlPoint> points;
  std::map<double, std::string> speeds;  ///< From an intrinsic coordinate on; empty: none.
};

using ToDegrees = std::unique_ptr<OGRCoordinateTransformation>;

class RailMlReader {
 public:
  void Read(const CPLXMLNode* root);
  [[nodiscard]] ErrorList& errors() { return errors_; }
  [[nodiscard]] RailMap Map() const;

 private:
  void ReadSystem(const CPLXMLNode& element);
  void ReadNetElement(const CPLXMLNode& element);
  void ReadPoint(const CPLXMLNode& intrinsic, const std::string& place, NetElement& net);
  void ReadSpeedSection(const CPLXMLNode& element);
  void ReadSpeedOn(const CPLXMLNode& associated,
                   const std::string& place,
                   const std::string& speed);
  [[nodiscard]] std::optional<double> NumberOf(const CPLXMLNode& element,
                                               const std::string& place,
                                               const char* name,
                                               double otherwise);

  ErrorList errors_;
  std::map<std::string, ToDegrees> systems_;  ///< By id.
  std::vector<NetElement> nets_;
  std::map<std::string, std::size_t> net_ids_;
};

/// A number; `otherwise` if it is not given, unless that is NaN.
std::optional<double> RailMlReader::NumberOf(const CPLXMLNode& element,
                                             const std::string& place,
                                             const char* name,
                                             double otherwise) {
  const std::string text = Attribute(element, name);
  if (text.empty() && !std::isnan(otherwise)) return otherwise;
  const std::optional<double> value = NumberIn(text);
  if (!value) {
    errors_.Add({place + "/" + name, "must be a number", text.empty() ? "none" : ShownText(text)});
  }
  return value;
}

void RailMlReader::ReadSystem(const CPLXMLNode& element) {
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
  systems_[id] = ToDegrees(OGRCreateCoordinateTransformation(&from, &to));
}

void RailMlReader::ReadPoint(const CPLXMLNode& intrinsic,
                             const std::string& place,
                             NetElement& net) {
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
  RailMlPoint point{*at, {*x, *y}, {}};
  if (system->second->Transform(1, &point.geographic_deg.x(), &point.geographic_deg.y()) == 0 ||
      !(std::abs(point.geographic_deg.x()) <= 180.0 &&
        std::abs(point.geographic_deg.y()) <= 90.0)) {
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

void RailMlReader::ReadNetElement(const CPLXMLNode& element) {
  NetElement net{Attribute(element, "id"), CPLGetXMLValue(&element, "name.name", ""), {}, {}};
  const std::string place = "netElement " + ShownText(net.id);
  const std::size_t num_faults = errors_.size();
  VisitElements(element.psChild, "intrinsicCoordinate",
                [&](const CPLXMLNode& intrinsic) { ReadPoint(intrinsic, place, net); });
  if (net.points.empty() || errors_.size() > num_faults) return;
  std::ranges::stable_sort(net.points, {}, &RailMlPoint::intrinsic);
  const auto is_same = [](const RailMlPoint& a, const RailMlPoint& b) {
    return a.geographic_deg == b.geographic_deg;
  };
  const auto repeated = std::ranges::unique(net.points, is_same);
  net.points.erase(repeated.begin(), repeated.end());
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

void RailMlReader::ReadSpeedOn(const CPLXMLNode& associated,
                               const std::string& place,
                               const std::string& speed) {
  const auto net = net_ids_.find(Attribute(associated, "netElementRef"));
  // Those of upper levels have no coordinates.
  if (net == net_ids_.end()) return;
  const auto begin = NumberOf(associated, place, "intrinsicCoordBegin", 0.0);
  const auto end = NumberOf(associated, place, "intrinsicCoordEnd", 1.0);
  if (!begin || !end) return;
  if (!(*begin >= 0.0 && *end <= 1.0 && *begin < *end)) {
    errors_.Add({place, "must have intrinsicCoordBegin < intrinsicCoordEnd, both from 0 to 1",
                 NumberText(*begin) + ", " + NumberText(*end)});
    return;
  }
  std::map<double, std::string>& speeds = nets_[net->second].speeds;
  const auto after = speeds.upper_bound(*end);
  const std::string behind = after == speeds.begin() ? "" : std::prev(after)->second;
  speeds.erase(speeds.lower_bound(*begin), after);
  speeds[*begin] = speed;
  speeds[*end] = behind;
}

void RailMlReader::ReadSpeedSection(const CPLXMLNode& element) {
  const std::string place = "speedSection " + ShownText(Attribute(element, "id"));
  const std::string speed = Attribute(element, "maxSpeed");
  const std::optional<double> value_kmph = NumberIn(speed);
  // Some say "end of track section" or refer to a profile.
  if (!value_kmph) return;
  if (!(*value_kmph > 0.0)) {
    errors_.Add({place + "/maxSpeed", "must be > 0", ShownText(speed)});
    return;
  }
  VisitElements(element.psChild, "associatedNetElement",
                [&](const CPLXMLNode& associated) { ReadSpeedOn(associated, place, speed); });
}

void RailMlReader::Read(const CPLXMLNode* root) {
  VisitElements(root, "geometricPositioningSystem",
                [&](const CPLXMLNode& element) { ReadSystem(element); });
  VisitElements(root, "netElement", [&](const CPLXMLNode& element) { ReadNetElement(element); });
  VisitElements(root, "speedSection",
                [&](const CPLXMLNode& element) { ReadSpeedSection(element); });
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

RailMap RailMlReader::Map() const {
  RailMap map;
  std::map<std::pair<double, double>, std::size_t> nodes;
  const auto append = [&](const RailMlPoint& point, MapWay& way) {
    const auto [entry, is_new] =
        nodes.try_emplace({point.geographic_deg.x(), point.geographic_deg.y()}, map.nodes.size());
    if (is_new) {
      map.nodes.push_back(
          {.geographic_deg = point.geographic_deg, .height_m = point.height_m, .tags = {}});
    }
    AppendNode(entry->second, way);
  };
  for (const NetElement& net : nets_) {
    std::set<double> ends = {0.0, 1.0};
    for (const auto& [begin, speed] : net.speeds) ends.insert(begin);
    for (auto end = std::next(ends.begin()); end != ends.end(); ++end) {
      const double begin = *std::prev(end);
      MapWay way{static_cast<std::int64_t>(map.ways.size()), {}, {{"railway", "rail"}}};
      if (!net.name.empty()) way.tags["name"] = net.name;
      const auto after = net.speeds.upper_bound(begin);
      if (after != net.speeds.begin() && !std::prev(after)->second.empty()) {
        way.tags["maxspeed"] = std::prev(after)->second;
      }
      append(PointOnNet(net.points, begin), way);
      for (const RailMlPoint& point : net.points) {
        if (point.intrinsic > begin && point.intrinsic < *end) append(point, way);
      }
      append(PointOnNet(net.points, *end), way);
      if (way.nodes.size() >= 2) map.ways.push_back(std::move(way));
    }
  }
  return map;
}

}  // namespace

bool IsRailMl(std::string_view begin) {
  return begin.find("<railML") != std::string_view::npos ||
         begin.find(":railML") != std::string_view::npos;
}

RailMap ReadRailMl(const std::filesystem::path& file) {
  const std::string text = ReadFileWhole(file);
  GdalErrors gdal_errors;
  const XmlTree tree(CPLParseXMLString(text.c_str()), &CPLDestroyXMLNode);
  if (!tree) {
    throw InputError(ShownPath(file) + ": must be XML to its end (" +
                     ShownText(gdal_errors.first()) + ")");
  }
  CPLStripXMLNamespace(tree.get(), nullptr, 1);
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
