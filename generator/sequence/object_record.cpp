#include "generator/sequence/object_record.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "generator/sequence/pose_record.h"

namespace railcast {
namespace {

using Json = nlohmann::ordered_json;

Json List(const Vector3& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

double ToTenthOfMillimetre(double length_m) {
  constexpr double kSteps_per_m = 1e4;
  // Adding zero makes -0 the same as 0.
  return std::round(length_m * kSteps_per_m) / kSteps_per_m + 0.0;
}

Json Box(const Transform& to_from_box, const Vector3& size_m) {
  const Eigen::Quaterniond turn = CanonicalRotation(to_from_box);
  return {{"center_m", List(to_from_box.translation())},
          {"size_m", List(size_m)},
          {"quaternion_xyzw", {turn.x(), turn.y(), turn.z(), turn.w()}}};
}

}  // namespace

std::string ObjectsLine(const Frame& frame, const std::vector<ObjectInFrame>& objects) {
  const Transform sensor_from_world = frame.world_from_sensor.inverse();
  Json list = Json::array();
  for (const ObjectInFrame& object : objects) {
    Json occlusion;  // Default-constructed, it is written as null.
    if (object.firings_alone > 0) {
      occlusion = 1.0 - static_cast<double>(object.firings_visible) /
                            static_cast<double>(object.firings_alone);
    }
    Json contacts = Json::array();
    for (const ContactInFrame& contact : object.contacts) {
      contacts.push_back({{"with", contact.with},
                          {"overlap", contact.is_overlap},
                          {"gap_m", ToTenthOfMillimetre(contact.gap_m)}});
    }
    list.push_back({{"name", object.name},
                    {"type", object.type},
                    {"label", object.label},
                    {"instance", object.instance},
                    {"world", Box(object.world_from_box, object.size_m)},
                    {"sensor", Box(sensor_from_world * object.world_from_box, object.size_m)},
                    {"output", Box(object.output_from_box, object.size_m)},
                    {"velocity_mps", List(object.velocity_world_mps)},
                    {"points", object.points},
                    {"firings_visible", object.firings_visible},
                    {"firings_alone", object.firings_alone},
                    {"occlusion", occlusion},
                    {"contacts", contacts}});
  }
  const Json line = {{"frame", frame.index}, {"stamp_ns", frame.stamp_ns}, {"objects", list}};
  return line.dump() + "\n";
}

}  // namespace railcast
