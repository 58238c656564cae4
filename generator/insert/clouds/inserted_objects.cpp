#include "generator/insert/clouds/inserted_objects.h"

#include <map>
#include <nlohmann/json.hpp>

#include "core/io/run/object_survey.h"

namespace railcast {
namespace {

using Json = nlohmann::ordered_json;

/// The points of an instance and the sum of their times.
struct TimedPoints {
  std::int64_t num{};
  std::int64_t time_ns{};
};

/// What instances have lost.
std::map<std::uint32_t, TimedPoints> LostPoints(const RecordedFirings& firings,
                                                const InsertedFrame& inserted) {
  const Frame& before = firings.recorded.frame;
  const Frame& after = inserted.recorded.frame;
  std::map<std::uint32_t, TimedPoints> lost;
  const auto count = [&](const Frame& frame, std::uint32_t slot, int change) {
    TimedPoints& points = lost[frame.instance[slot]];
    points.num += change;
    points.time_ns += change * std::int64_t{frame.time_ns[slot]};
  };
  for (const SlotEdit& edit : inserted.edits) {
    if (edit.had_point) count(before, edit.slot, 1);
    if (edit.has_point && (!edit.is_added || edit.is_merged)) count(after, edit.slot, -1);
  }
  return lost;
}

/// A line of objects.jsonl.
Json ObjectsJson(const Frame& frame, const std::vector<RecordedObject>& recorded) {
  std::vector<ObjectInFrame> objects;
  for (const RecordedObject& object : recorded) {
    ObjectInFrame entry{object.name, object.type, object.label, object.instance};
    entry.size_m = object.size_m;
    entry.world_from_box = frame.world_from_sensor * object.sensor_from_box;
    entry.output_from_box = object.sensor_from_box;
    entry.velocity_world_mps = object.velocity_world_mps;
    entry.points = object.points;
    entry.points_time_ns = object.points_time_ns.value_or(0);
    entry.view.firings_visible = object.firings_visible;
    entry.view.firings_alone = object.firings_alone;
    objects.push_back(std::move(entry));
  }
  // What is hidden was counted in rays, of which only the share is known here.
  Json line = Json::parse(ObjectsLine(frame, objects));
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (recorded[i].occlusion) line["objects"][i]["occlusion"] = *recorded[i].occlusion;
  }
  return line;
}

}  // namespace

std::string InsertedObjectsLine(const RecordedFirings& firings,
                                const InsertedFrame& inserted,
                                std::uint32_t number,
                                std::int64_t stamp_ns) {
  Json line = ObjectsJson(inserted.recorded.frame, inserted.recorded.objects);
  line["frame"] = number;
  line["stamp_ns"] = stamp_ns;
  return ObjectsWith(line.dump(), firings, inserted);
}

std::string ObjectsWith(const std::string& line,
                        const RecordedFirings& firings,
                        const InsertedFrame& inserted) {
  if (inserted.objects.empty() && inserted.edits.empty()) return line + "\n";
  Json json = Json::parse(line);
  const auto lost = LostPoints(firings, inserted);
  for (Json& object : json.at("objects")) {
    const auto found = lost.find(object.at("instance").get<std::uint32_t>());
    if (found == lost.end() || found->second.num == 0) continue;
    const auto points = object.at("points").get<std::int64_t>();
    const std::int64_t left = std::max<std::int64_t>(0, points - found->second.num);
    object["points"] = left;
    Json& mean_ns = object["points_time_ns"];
    if (left == 0 || !mean_ns.is_number()) {
      mean_ns = nullptr;
    } else {
      const std::int64_t sum_ns = mean_ns.get<std::int64_t>() * points - found->second.time_ns;
      mean_ns = std::max<std::int64_t>(0, sum_ns / left);
    }
  }
  const Json added = ObjectsJson(inserted.recorded.frame, inserted.objects);
  for (const Json& object : added.at("objects")) json["objects"].push_back(object);
  return json.dump() + "\n";
}

}  // namespace railcast
