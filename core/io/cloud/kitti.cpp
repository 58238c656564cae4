#include "core/io/cloud/kitti.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/cloud/scan_motion.h"
#include "core/io/field_layout.h"

namespace railcast {
namespace {

/// Writes the text as a YAML scalar. YAML understands JSON's strings and escapes except for
/// surrogate pairs (two escapes for one character beyond U+FFFF), so those characters are written
/// unescaped.
std::string YamlString(const std::string& text) {
  constexpr std::string_view kFirstBytesBeyondFfff = "\xF0\xF1\xF2\xF3\xF4";  // RFC 3629.
  constexpr std::size_t kNumBytesBeyondFfff = 4;
  const auto escaped = [](std::string_view part) {
    using nlohmann::json;
    const std::string quoted = json(part).dump(-1, ' ', true, json::error_handler_t::replace);
    return quoted.substr(1, quoted.size() - 2);
  };
  std::string scalar;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t num_escaped =
        std::min(rest.find_first_of(kFirstBytesBeyondFfff), rest.size());
    scalar += escaped(rest.substr(0, num_escaped));
    rest.remove_prefix(num_escaped);
    const std::size_t num_kept = std::min(kNumBytesBeyondFfff, rest.size());
    scalar += rest.substr(0, num_kept);
    rest.remove_prefix(num_kept);
  }
  return '"' + scalar + '"';
}

std::string YamlKey(std::size_t key) {
  return "  " + std::to_string(key) + ": ";
}

/// The classes that networks learn, numbered from 0. An object has one class, whether it moves or
/// not.
struct TrainingClasses {
  std::map<std::uint32_t, std::size_t> class_of;  ///< By SemanticKITTI id.
  std::vector<std::uint32_t> label_of;            ///< The first SemanticKITTI id of each class.
};

/// Class 0 is what SemanticKITTI calls unlabeled (0) or an outlier (1), such as rain and ghosts.
TrainingClasses TrainingClassesOf(const LabelTable& kitti) {
  constexpr std::uint16_t kOutlier = 1;
  TrainingClasses training{{}, {0}};
  for (const Label& label : kitti.labels()) {
    if (label.semantic_kitti_nearest <= kOutlier) {
      training.class_of[label.id] = 0;
      continue;
    }
    // A moving class has the id of the standing one as its label's, whose class is known.
    const auto standing = training.class_of.find(label.semantic_kitti);
    if (standing != training.class_of.end()) {
      training.class_of[label.id] = standing->second;
      continue;
    }
    training.class_of[label.id] = training.label_of.size();
    training.label_of.push_back(label.id);
  }
  return training;
}

// Sizes of a point in a .bin file, and of its label in a .label file.
constexpr std::size_t kPointBytes = 4 * sizeof(float);
constexpr std::size_t kLabelBytes = sizeof(std::uint32_t);

}  // namespace

void EncodeKittiPoints(const Frame& frame, std::string& bytes) {
  bytes.resize(frame.num_slots() * kPointBytes);
  const ScanMotion motion(frame);
  char* place = bytes.data();
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!HasPoint(frame.outcome[slot])) continue;
    const float intensity = frame.intensity[slot];
    const Vector3 point_m(static_cast<double>(frame.x[slot]), static_cast<double>(frame.y[slot]),
                          static_cast<double>(frame.z[slot]));
    const Eigen::Vector3f at_stamp_m = motion.AtStamp(point_m, frame.time_ns[slot]).cast<float>();
    const std::array<float, 4> point = {at_stamp_m.x(), at_stamp_m.y(), at_stamp_m.z(),
                                        std::isnan(intensity) ? 0.0F : intensity};
    std::memcpy(place, point.data(), kPointBytes);
    place += kPointBytes;
  }
  bytes.resize(static_cast<std::size_t>(place - bytes.data()));
}

std::uint16_t MovingSemanticKitti(std::uint16_t id) {
  // From semantic-kitti-all.yaml: car, bicyclist, person, motorcyclist, on-rails, bus, truck,
  // other.
  constexpr std::array<std::pair<std::uint16_t, std::uint16_t>, 8> kMovingFromStanding = {
      {{10, 252}, {31, 253}, {30, 254}, {32, 255}, {16, 256}, {13, 257}, {18, 258}, {20, 259}}};
  for (const auto& [standing, moving] : kMovingFromStanding) {
    if (standing == id) return moving;
  }
  return id;
}

bool IsMoving(const Vector3& velocity_mps) {
  constexpr double kRounding_mps = 1e-6;
  return velocity_mps.norm() > kRounding_mps;
}

void EncodeKittiLabels(const Frame& frame,
                       const LabelTable& labels,
                       const std::set<std::uint32_t>& moving,
                       std::string& bytes) {
  constexpr std::uint32_t kMaxInstance = 0xFFFF;
  std::map<std::uint32_t, std::uint16_t> kitti_from_label;
  for (const Label& label : labels.labels()) kitti_from_label[label.id] = label.semantic_kitti;
  bytes.resize(frame.num_slots() * kLabelBytes);
  char* place = bytes.data();
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!HasPoint(frame.outcome[slot])) continue;
    if (frame.instance[slot] > kMaxInstance) {
      throw InputError("--format kitti: instance must be <= 65535 (got " +
                       std::to_string(frame.instance[slot]) + ")");
    }
    const auto label = kitti_from_label.find(frame.label[slot]);
    Check(label != kitti_from_label.end(), "a frame's labels are in its label table");
    const bool is_moving = moving.contains(frame.instance[slot]);
    const std::uint16_t id = is_moving ? MovingSemanticKitti(label->second) : label->second;
    StoreAt<std::uint32_t>(place, (frame.instance[slot] << 16U) | id);
    place += kLabelBytes;
  }
  bytes.resize(static_cast<std::size_t>(place - bytes.data()));
}

std::string KittiPoseLine(const Transform& first_from_sensor) {
  std::string line;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      if (!line.empty()) line += ' ';
      line += NumberText(first_from_sensor.matrix()(row, column));
    }
  }
  return line + "\n";
}

std::string KittiCalibration() {
  std::string text;
  for (const char* name : {"P0", "P1", "P2", "P3", "Tr"}) {
    text += std::string(name) + ": 1 0 0 0 0 1 0 0 0 0 1 0\n";
  }
  return text;
}

LabelTable SemanticKittiLabels(const LabelTable& labels) {
  std::map<std::uint16_t, Label> classes;
  const auto add = [&](std::uint16_t id, const Label& label) {
    const auto [entry, is_first] = classes.try_emplace(id, label);
    entry->second.id = id;
    if (!is_first) entry->second.name.append("/").append(label.name);
  };
  for (const Label& label : labels.labels()) {
    add(label.semantic_kitti, label);
    const std::uint16_t moving_id = MovingSemanticKitti(label.semantic_kitti);
    if (moving_id == label.semantic_kitti) continue;
    Label moving = label;
    moving.name.insert(0, "moving ");
    moving.semantic_kitti_nearest = MovingSemanticKitti(label.semantic_kitti_nearest);
    add(moving_id, moving);
  }
  std::vector<Label> kitti;
  for (const auto& [id, label] : classes) kitti.push_back(label);
  return LabelTable(std::move(kitti));
}

std::string SemanticKittiYaml(const LabelTable& labels) {
  const LabelTable kitti = SemanticKittiLabels(labels);
  const TrainingClasses training = TrainingClassesOf(kitti);
  std::string names = "labels:\n";
  std::string colours = "color_map: # bgr\n";
  std::string content = "content: # shares of points; 0 = not counted\n";
  std::string learning = "learning_map: # to the classes of training\n";
  std::string nearest = "nearest_map: # to the nearest of SemanticKITTI's own labels\n";
  for (const Label& label : kitti.labels()) {
    const std::string key = YamlKey(label.id);
    const auto& [red, green, blue] = label.rgb;
    names += key + YamlString(label.name) + "\n";
    colours += key + "[" + std::to_string(blue) + ", " + std::to_string(green) + ", " +
               std::to_string(red) + "]\n";
    content += key + "0.0\n";
    learning += key + std::to_string(training.class_of.at(label.id)) + "\n";
    nearest += key + std::to_string(label.semantic_kitti_nearest) + "\n";
  }
  std::string inverse = "learning_map_inv:\n";
  std::string ignore = "learning_ignore: # nothing, and points that are of no surface\n";
  for (std::size_t i = 0; i < training.label_of.size(); ++i) {
    inverse += YamlKey(i) + std::to_string(training.label_of[i]) + "\n";
    ignore += YamlKey(i) + (i == 0 ? "true" : "false") + "\n";
  }
  return "# Classes of the .label files beside; ids above 259 are railcast's own.\n"
         "name: \"railcast\"\n" +
         names + colours + content + learning + inverse + ignore +
         "split: # sequence numbers\n  train: [0]\n  valid: []\n  test: []\n" + nearest;
}

}  // namespace railcast
