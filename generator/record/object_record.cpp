#include "generator/record/object_record.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "generator/record/frame_record.h"

namespace railcast {
namespace {

using Json = nlohmann::ordered_json;

// The line is put together as text: of hundreds of objects, a tree of JSON values costs as much as
// tracing the frame.

std::string Dumped(const Json& value) {
  return value.dump();
}

std::string List(const Vector3& vector) {
  return Dumped({vector.x(), vector.y(), vector.z()});
}

double ToTenthOfMillimetre(double length_m) {
  constexpr double kSteps_per_m = 1e4;
  // Adding zero makes -0 the same as 0.
  return std::round(length_m * kSteps_per_m) / kSteps_per_m + 0.0;
}

// @param size The list of the box's size.
void AppendBox(const char* key,
               const Transform& to_from_box,
               const std::string& size,
               std::string& line) {
  const Eigen::Quaterniond turn = CanonicalRotation(to_from_box);
  line.append(",\"").append(key).append("\":{\"center_m\":");
  line.append(List(to_from_box.translation())).append(",\"size_m\":").append(size);
  line.append(",\"quaternion_xyzw\":");
  line.append(Dumped({turn.x(), turn.y(), turn.z(), turn.w()})).append("}");
}

std::string Contacts(const ObjectInFrame& object) {
  Json contacts = Json::array();
  for (const ContactInFrame& contact : object.contacts) {
    contacts.push_back({{"with", contact.with},
                        {"overlap", contact.is_overlap},
                        {"gap_m", ToTenthOfMillimetre(contact.gap_m)}});
  }
  return Dumped(contacts);
}

void AppendObject(const ObjectInFrame& object,
                  const Transform& sensor_from_world,
                  std::string& line) {
  const std::string size = List(object.size_m);
  line.append("{\"name\":").append(Dumped(object.name));
  line.append(",\"type\":").append(Dumped(object.type));
  line.append(",\"label\":").append(Dumped(object.label));
  line.append(",\"instance\":").append(std::to_string(object.instance));
  AppendBox("world", object.world_from_box, size, line);
  AppendBox("sensor", sensor_from_world * object.world_from_box, size, line);
  AppendBox("output", object.output_from_box, size, line);
  line.append(",\"velocity_mps\":").append(List(object.velocity_world_mps));
  line.append(",\"points\":").append(std::to_string(object.points));
  line.append(",\"points_time_ns\":");
  line.append(object.points > 0 ? std::to_string(object.points_time_ns) : "null");
  line.append(",\"firings_visible\":").append(std::to_string(object.view.firings_visible));
  line.append(",\"firings_alone\":").append(std::to_string(object.view.firings_alone));
  Json occlusion;  // Default-constructed, it is written as null.
  if (const auto hidden = object.view.occlusion()) occlusion = *hidden;
  line.append(",\"occlusion\":").append(Dumped(occlusion));
  line.append(",\"contacts\":").append(Contacts(object)).append("}");
}

}  // namespace

std::string ObjectsLine(const Frame& frame, const std::vector<ObjectInFrame>& objects) {
  const Transform sensor_from_world = frame.world_from_sensor.inverse();
  std::string line = "{\"frame\":" + std::to_string(frame.index) +
                     ",\"stamp_ns\":" + std::to_string(frame.stamp_ns) + ",\"objects\":[";
  for (const ObjectInFrame& object : objects) {
    if (&object != objects.data()) line += ',';
    AppendObject(object, sensor_from_world, line);
  }
  return line + "]}\n";
}

}  // namespace railcast
