#include "generator/dataset/object_template.h"

#include "generator/dataset/json_place.h"

namespace railcast {
namespace {

std::string PlaceOfObjects(std::size_t index) {
  return "/objects/" + std::to_string(index);
}

void AddTo(Json& object, const char* key, double amount_m) {
  if (object.is_object() && object.contains(key) && object[key].is_number()) {
    object[key] = object[key].get<double>() + amount_m;
  }
}

// Chainages of a motion count from the object's own place.
void ShiftMotion(Json& object, double s_m) {
  if (!object.contains("motion") || !object["motion"].is_object()) return;
  Json& motion = object["motion"];
  const auto shift_all = [&](Json& points) {
    if (!points.is_array()) return;
    for (Json& point : points) AddTo(point, "s_m", s_m);
  };
  if (motion.contains("profile")) shift_all(motion["profile"]);
  if (!motion.contains("path") || !motion["path"].is_object()) return;
  Json& path = motion["path"];
  AddTo(path, "start_at_vehicle_s_m", s_m);
  if (path.contains("points")) shift_all(path["points"]);
}

// The chainage of the vehicle and its direction of travel, 1 or -1.
std::pair<double, double> VehicleIn(const Json& scenario) {
  const Json vehicle = scenario.value("vehicle", Json::object());
  const Json motion = vehicle.value("motion", Json::object());
  const bool is_reverse = motion.is_object() && motion.value("reverse", Json()) == true;
  const Json start = vehicle.value("start_s_m", Json());
  return {start.is_number() ? start.get<double>() : 0.0, is_reverse ? -1.0 : 1.0};
}

}  // namespace

ObjectDraw DrawObject(const Recipe& recipe,
                      std::size_t index,
                      const ObjectTurn& turn,
                      DraftedScenario& draft) {
  const PlacedObjects& objects = recipe.objects[index];
  const std::string name = objects.name + "/" + std::to_string(turn.number);
  const std::string key = "object\n" + name + "\n";
  ObjectDraw result{objects.object.json, Json::object(), 0.0};
  for (const PointedDraw& draw : objects.draws.draws) {
    const auto known = turn.forced.find(draw.pointer);
    const Json value = known != turn.forced.end() ? known->second
                                                  : DrawValue(draw.distribution, turn.draws,
                                                              key + draw.pointer, turn.attempt);
    if (const auto obstacle = SetAt(result.object, draw.pointer, value)) {
      throw InputError(std::vector<Fault>{
          draft.FaultAt(PlaceOfObjects(index) + "/draws" + PointerStep(draw.pointer), *obstacle)});
    }
    result.drawn[draw.pointer] = value;
  }
  result.ahead_m =
      DrawValue(objects.ahead_m, turn.draws, key + "ahead_m", turn.attempt).get<double>();
  const auto [start_s_m, direction] = VehicleIn(draft.json());
  const double s_m = start_s_m + direction * result.ahead_m;
  result.object["name"] = name;
  result.object["s_m"] = s_m;
  ShiftMotion(result.object, s_m);
  return result;
}

void AddObject(const ObjectDraw& drawn,
               const Recipe& recipe,
               std::size_t index,
               DraftedScenario& draft) {
  Json& objects = draft.json()["world"]["objects"];
  const std::string pointer = "/world/objects/" + std::to_string(objects.size());
  const std::string place = PlaceOfObjects(index);
  draft.Note(pointer, place + "/object");
  for (const PointedDraw& draw : recipe.objects[index].draws.draws) {
    draft.Note(pointer + draw.pointer, place + "/draws" + PointerStep(draw.pointer));
  }
  draft.Note(pointer + "/s_m", place + "/ahead_m");
  objects.push_back(drawn.object);
}

}  // namespace railcast
