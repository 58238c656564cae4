#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railcast/transform.h"

namespace railcast {

class Archive;

/// An object's oriented box in some axes.
struct BoxRecord {
  Vector3 center_m = Vector3::Zero();
  Vector3 size_m = Vector3::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

  [[nodiscard]] Transform ToFromBox() const;
};
void Describe(Archive& a, BoxRecord& s);

/// Something that an object touches or overlaps.
struct ContactRecord {
  std::string with;  ///< Name of the other object.
  bool is_overlap{};
  double gap_m{};  ///< As ObjectContact::gap_m.
};
void Describe(Archive& a, ContactRecord& s);

/// An object of a line of objects.jsonl.
struct ObjectRecord {
  std::string name;
  std::string type;
  std::string label;
  std::uint32_t instance{};
  BoxRecord world{};   ///< At the stamp.
  BoxRecord sensor{};  ///< In the sensor's axes, right-handed whatever the points' are.
  BoxRecord output{};  ///< In the axes of the frame's points.
  Vector3 velocity_world_mps = Vector3::Zero();
  std::uint32_t points{};
  std::optional<std::uint32_t> points_time_ns{};  ///< Their mean time since the stamp.
  std::uint32_t firings_visible{};
  std::uint32_t firings_alone{};
  std::optional<double> occlusion{};  ///< 0 to 1; absent if no firing would meet it even alone.
  std::vector<ContactRecord> contacts{};
};
void Describe(Archive& a, ObjectRecord& s);

/// A line of objects.jsonl.
struct ObjectsRecord {
  std::uint32_t frame{};
  std::int64_t stamp_ns{};
  std::vector<ObjectRecord> objects{};
};
void Describe(Archive& a, ObjectsRecord& s);

/// @throws InputError "place: rule" if it is not a line of objects.jsonl, or belongs to another
///   frame.
[[nodiscard]] ObjectsRecord ReadObjectsRecord(std::string_view line,
                                              std::uint32_t frame,
                                              const std::string& place);

}  // namespace railcast
