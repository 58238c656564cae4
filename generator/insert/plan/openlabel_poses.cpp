#include "generator/insert/plan/openlabel_poses.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/openlabel.h"
#include "core/io/write_file.h"
#include "core/scenario/json_text.h"

namespace railcast {
namespace {

/// Leads from one coordinate system to another.
struct Link {
  std::string to;
  Transform to_from_here;
  bool is_of_frame = false;
};

/// "1631441453.299504000", or a number, in ns.
std::int64_t StampOf_ns(const Json& json, const OpenLabelPlace& place) {
  constexpr std::int64_t kMost_s = 9'000'000'000;
  if (json.is_number() && std::abs(json.get<double>()) <= static_cast<double>(kMost_s)) {
    return std::llround(json.get<double>() * static_cast<double>(kNsPerS));
  }
  const std::string text = json.is_string() ? json.get<std::string>() : "";
  const std::size_t point = text.find('.');
  std::string fraction = point == std::string::npos ? "" : text.substr(point + 1);
  constexpr std::size_t kDigits = 9;
  const auto seconds = ParseNumber<std::int64_t>(text.substr(0, point));
  const bool is_digits = std::ranges::all_of(fraction, [](char c) { return c >= '0' && c <= '9'; });
  if (!seconds || *seconds < 0 || *seconds > kMost_s || !is_digits || fraction.size() > kDigits) {
    place.Fail("must be a time in seconds");
  }
  fraction.resize(kDigits, '0');
  return *seconds * kNsPerS + ParseNumber<std::int64_t>(fraction).value();
}

class OpenLabel {
 public:
  OpenLabel(const Json& json, const OpenLabelPlace& place, const std::string& sensor)
      : json_(OpenLabelMember(json, "openlabel", place)),
        place_(place / "openlabel"),
        sensor_(sensor) {
    const OpenLabelPlace systems_place = place_ / "coordinate_systems";
    const Json& systems = OpenLabelMember(json_, "coordinate_systems", place_);
    if (!systems.is_object() || !systems.contains(sensor)) {
      systems_place.Fail("must have that of the sensor " + Quoted(sensor));
    }
    for (const auto& [name, system] : systems.items()) {
      const OpenLabelPlace own = systems_place / name;
      const std::string parent = OpenLabelText(system, "parent", own);
      if (parent.empty() || !system.contains("pose_wrt_parent")) continue;
      parents_[name] = {parent,
                        OpenLabelTransform(system.at("pose_wrt_parent"), own / "pose_wrt_parent")};
    }
  }

  [[nodiscard]] PoseFile Read() const {
    const OpenLabelPlace frames_place = place_ / "frames";
    const Json& frames = OpenLabelMember(json_, "frames", place_);
    if (!frames.is_object()) frames_place.Fail("must be an object");
    // Their numbers are texts, and those stand in any order.
    std::map<std::int64_t, std::string> keys;
    for (const auto& [key, frame] : frames.items()) {
      const auto number = ParseNumber<std::int64_t>(key);
      if (!number) (frames_place / key).Fail("must be named by its number");
      keys[*number] = key;
    }
    PoseFile poses;
    for (const auto& [number, key] : keys) {
      const OpenLabelPlace own = frames_place / key / "frame_properties";
      const Json& properties =
          OpenLabelMember(frames.at(key), "frame_properties", frames_place / key);
      poses.world_from_sensor.push_back(PoseIn(properties, own));
      if (properties.contains("timestamp")) {
        poses.stamps_ns.push_back(StampOf_ns(properties.at("timestamp"), own / "timestamp"));
      }
    }
    if (poses.stamps_ns.size() != keys.size()) poses.stamps_ns.clear();
    return poses;
  }

 private:
  [[nodiscard]] Transform PoseIn(const Json& properties, const OpenLabelPlace& place) const {
    std::multimap<std::string, Link> links;
    if (properties.is_object() && properties.contains("transforms")) {
      for (const auto& [name, transform] : properties.at("transforms").items()) {
        const OpenLabelPlace own = place / "transforms" / name;
        const std::string from = OpenLabelText(transform, "src", own);
        const std::string to = OpenLabelText(transform, "dst", own);
        const Transform to_from = OpenLabelTransform(
            OpenLabelMember(transform, "transform_src_to_dst", own), own / "transform_src_to_dst");
        links.emplace(from, Link{to, to_from, true});
        links.emplace(to, Link{from, to_from.inverse(), true});
      }
    }
    Transform root_from_sensor = Transform::Identity();
    std::string here = sensor_;
    std::set<std::string> passed = {here};
    bool has_moving = false;
    while (const auto link = LinkFrom(here, links, passed)) {
      root_from_sensor = link->to_from_here * root_from_sensor;
      has_moving = has_moving || link->is_of_frame;
      here = link->to;
      passed.insert(here);
    }
    if (!has_moving) {
      (place / "transforms").Fail("must lead from " + Quoted(sensor_) + " to the world");
    }
    return root_from_sensor;
  }

  // The way up: a transform of the frame goes before a place that never changes.
  [[nodiscard]] std::optional<Link> LinkFrom(const std::string& here,
                                             const std::multimap<std::string, Link>& links,
                                             const std::set<std::string>& passed) const {
    const auto [begin, end] = links.equal_range(here);
    for (auto link = begin; link != end; ++link) {
      if (!passed.contains(link->second.to)) return link->second;
    }
    const auto parent = parents_.find(here);
    if (parent == parents_.end() || passed.contains(parent->second.to)) return std::nullopt;
    return parent->second;
  }

  const Json& json_;
  OpenLabelPlace place_;
  std::string sensor_;
  std::map<std::string, Link> parents_;  ///< Of coordinate systems, by name.
};

}  // namespace

PoseFile ReadOpenLabelPoses(const std::filesystem::path& file, const std::string& sensor) {
  const OpenLabelPlace place{ShownPath(file), ""};
  const Json json = ParseOpenLabel(ReadFileWhole(file), place.file);
  return OpenLabel(json, place, sensor).Read();
}

}  // namespace railcast
