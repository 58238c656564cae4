#include "generator/insert/plan/openlabel_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/strict_json.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

/// A place in the file, for messages.
struct Place {
  std::string file;
  std::string pointer;

  [[nodiscard]] Place operator/(const std::string& key) const {
    return {file, pointer + "/" + key};
  }
  [[noreturn]] void Fail(const std::string& rule) const {
    throw InputError(file + ": " + pointer + ": " + rule);
  }
};

const StrictJson& OpenLabelMember(const StrictJson& json,
                                  const std::string& key,
                                  const Place& place) {
  const auto found = json.is_object() ? json.find(key) : json.end();
  if (!json.is_object() || found == json.end()) (place / key).Fail("missing");
  return *found;
}

std::string TextOf(const StrictJson& json, const std::string& key, const Place& place) {
  const StrictJson& value = OpenLabelMember(json, key, place);
  if (!value.is_string()) (place / key).Fail("must be a text");
  return value.get<std::string>();
}

template <std::size_t kSize>
std::array<double, kSize> NumbersOf(const StrictJson& json, const Place& place) {
  const bool are_numbers = json.is_array() && json.size() == kSize &&
                           std::ranges::all_of(json, [](const StrictJson& number) {
                             return number.is_number() && std::isfinite(number.get<double>());
                           });
  if (!are_numbers) place.Fail("must be " + NumberText(kSize) + " numbers");
  return json.get<std::array<double, kSize>>();
}

/// The transform of a `transform_data`.
Transform TransformOf(const StrictJson& json, const Place& place) {
  constexpr double kRounding = 1e-3;
  Eigen::Matrix3d axes;
  Vector3 origin_m;
  if (json.is_object() && json.contains("matrix4x4")) {
    const auto rows = NumbersOf<16>(json.at("matrix4x4"), place / "matrix4x4");
    const Eigen::Matrix4d matrix =
        Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(rows.data());
    axes = matrix.topLeftCorner<3, 3>();
    origin_m = matrix.topRightCorner<3, 1>();
  } else {
    const auto turn =
        NumbersOf<4>(OpenLabelMember(json, "quaternion", place), place / "quaternion");
    const auto move =
        NumbersOf<3>(OpenLabelMember(json, "translation", place), place / "translation");
    axes = Eigen::Quaterniond(turn[3], turn[0], turn[1], turn[2]).toRotationMatrix();
    origin_m = {move[0], move[1], move[2]};
  }
  if (!(axes.transpose() * axes).isIdentity(kRounding) || axes.determinant() <= 0.0) {
    place.Fail("must be a rotation and a translation");
  }
  return MakeTransform(Eigen::Quaterniond(axes).normalized().toRotationMatrix(), origin_m);
}

/// Leads from one coordinate system to another.
struct Link {
  std::string to;
  Transform to_from_here;
  bool is_of_frame = false;
};

/// "1631441453.299504000", or a number, in ns.
std::int64_t StampOf_ns(const StrictJson& json, const Place& place) {
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
  OpenLabel(const StrictJson& json, const Place& place, const std::string& sensor)
      : json_(OpenLabelMember(json, "openlabel", place)),
        place_(place / "openlabel"),
        sensor_(sensor) {
    const Place systems_place = place_ / "coordinate_systems";
    const StrictJson& systems = OpenLabelMember(json_, "coordinate_systems", place_);
    if (!systems.is_object() || !systems.contains(sensor)) {
      systems_place.Fail("must have that of the sensor " + Quoted(sensor));
    }
    for (const auto& [name, system] : systems.items()) {
      const Place own = systems_place / name;
      const std::string parent = TextOf(system, "parent", own);
      if (parent.empty() || !system.contains("pose_wrt_parent")) continue;
      parents_[name] = {parent, TransformOf(system.at("pose_wrt_parent"), own / "pose_wrt_parent")};
    }
  }

  [[nodiscard]] PoseFile Read() const {
    const Place frames_place = place_ / "frames";
    const StrictJson& frames = OpenLabelMember(json_, "frames", place_);
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
      const Place own = frames_place / key / "frame_properties";
      const StrictJson& properties =
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
  [[nodiscard]] Transform PoseIn(const StrictJson& properties, const Place& place) const {
    std::multimap<std::string, Link> links;
    if (properties.is_object() && properties.contains("transforms")) {
      for (const auto& [name, transform] : properties.at("transforms").items()) {
        const Place own = place / "transforms" / name;
        const std::string from = TextOf(transform, "src", own);
        const std::string to = TextOf(transform, "dst", own);
        const Transform to_from = TransformOf(
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

  const StrictJson& json_;
  Place place_;
  std::string sensor_;
  std::map<std::string, Link> parents_;  ///< Of coordinate systems, by name.
};

}  // namespace

PoseFile ReadOpenLabelPoses(const std::filesystem::path& file, const std::string& sensor) {
  const std::string text = ReadFileWhole(file);
  const Place place{ShownPath(file), ""};
  const StrictJson json = [&] {
    try {
      return StrictJson::parse(text);
    } catch (const StrictJson::exception&) {
      throw InputError(place.file + ": must be a file of OpenLABEL");
    }
  }();
  return OpenLabel(json, place, sensor).Read();
}

}  // namespace railcast
