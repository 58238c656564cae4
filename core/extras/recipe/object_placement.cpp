#include "core/extras/recipe/object_placement.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/extras/recipe/json_place.h"
#include "core/extras/recipe/structure_contacts.h"
#include "core/rail/world/gauge_entries.h"
#include "core/scene/object_contacts.h"
#include "railcast/scenario.h"

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

// Until then an object is at its own place, which a profile says for time 0.
void StandUntil(double time_s, Json& profile) {
  constexpr double kStart_s = 1e-3;
  if (!profile.is_array() || profile.empty() || !profile.front().contains("time_s")) return;
  Json begin = {{{"time_s", 0.0}, {"speed_mps", 0.0}}};
  if (time_s > kStart_s) begin.push_back({{"time_s", time_s - kStart_s}, {"speed_mps", 0.0}});
  profile.insert(profile.begin(), begin.begin(), begin.end());
}

// Chainages and times of a motion count from the object's own place and the first frame.
void ShiftMotion(Json& object, double s_m, double time_s) {
  if (!object.contains("motion") || !object["motion"].is_object()) return;
  Json& motion = object["motion"];
  const auto shift_all = [&](Json& points) {
    if (!points.is_array()) return;
    for (Json& point : points) AddTo(point, "s_m", s_m);
    for (Json& point : points) AddTo(point, "time_s", time_s);
  };
  if (motion.contains("profile")) {
    shift_all(motion["profile"]);
    if (time_s > 0.0) StandUntil(time_s, motion["profile"]);
  }
  if (!motion.contains("path") || !motion["path"].is_object()) return;
  Json& path = motion["path"];
  if (time_s > 0.0 && !path.contains("start_at_vehicle_s_m") && !path.contains("start_s")) {
    path["start_s"] = 0.0;
  }
  AddTo(path, "start_s", time_s);
  AddTo(path, "start_at_vehicle_s_m", s_m);
  if (path.contains("points")) shift_all(path["points"]);
}

std::string AtFrame(std::uint32_t frame) {
  return " in frame " + std::to_string(frame);
}

// The line without its plants, whose models take longer to make than all that may be in the way.
std::shared_ptr<const RailWorld> LineWithoutPlants(ScenarioSpec scenario) {
  VegetationSpec& vegetation = scenario.world.vegetation;
  vegetation.trees_per_hectare = 0.0;
  vegetation.bushes_per_hectare = 0.0;
  vegetation.grass = false;
  scenario.world.objects.clear();
  return MakeWorld(scenario);
}

/// Looks whether an object of a world may stand where it stands.
class PlaceCheck {
 public:
  PlaceCheck(const RailWorld& world, const std::string& name, const MadeStamps& stamps)
      : world_(world), stamps_(stamps) {
    const auto same = std::ranges::find(world.objects(), name, &SceneObject::name);
    Check(same != world.objects().end(), "a placed object is in its world");
    object_ = static_cast<std::size_t>(same - world.objects().begin());
  }

  /// What it meets; nothing if it meets nothing.
  [[nodiscard]] std::optional<std::string> Collision() const {
    ContactFinder finder(world_);
    for (std::size_t i = 0; i < stamps_.frames.size(); ++i) {
      for (const ObjectContact& contact : finder.FindAll(stamps_.stamps_ns[i])) {
        if (contact.one != object_ && contact.other != object_) continue;
        const std::size_t other = contact.one == object_ ? contact.other : contact.one;
        return "it meets \"" + world_.objects()[other].name + "\"" + AtFrame(stamps_.frames[i]);
      }
      if (AreStillBetween(world_, stamps_.stamps_ns[i], stamps_.stamps_ns.back())) break;
    }
    return std::nullopt;
  }

  /// What of the line it is in; nothing if it is in nothing.
  [[nodiscard]] std::optional<std::string> StructureFault(const ObjectSpec& spec,
                                                          StructureContacts& structures) const {
    // Rails lead wagons past everything.
    if (IsOnItsTrack(spec)) return std::nullopt;
    for (std::size_t i = 0; i < NumPlaces(); ++i) {
      if (const auto label = structures.Find(world_, object_, stamps_.stamps_ns[i])) {
        return "it is in \"" + *label + "\" of the line" + AtFrame(stamps_.frames[i]);
      }
    }
    return std::nullopt;
  }

  /// How it breaks the rule; nothing if it does not.
  [[nodiscard]] std::optional<std::string> GaugeFault(const ScenarioSpec& scenario,
                                                      GaugeRule rule) const {
    if (rule == GaugeRule::kAny) return std::nullopt;
    const bool is_on_its_track = IsOnItsTrack(scenario.world.objects.back());
    for (std::size_t i = 0; i < NumPlaces(); ++i) {
      const std::vector<GaugeEntry> entries = FindObjectInTheWay(
          scenario.world, world_, object_, is_on_its_track, stamps_.stamps_ns[i]);
      if (entries.empty()) continue;
      if (rule == GaugeRule::kFoul) return std::nullopt;
      return "it is in the gauge of track \"" + entries.front().track + "\"" +
             AtFrame(stamps_.frames[i]);
    }
    if (rule == GaugeRule::kClear) return std::nullopt;
    return "it is in no track's gauge";
  }

 private:
  [[nodiscard]] static bool IsOnItsTrack(const ObjectSpec& spec) {
    return IsRailVehicle(spec.type) && spec.d_m == 0.0;
  }
  // In how many of the frames it may be elsewhere than before.
  [[nodiscard]] std::size_t NumPlaces() const {
    return world_.objects()[object_].moves ? stamps_.frames.size() : 1;
  }

  const RailWorld& world_;
  const MadeStamps& stamps_;
  std::size_t object_ = 0;
};

/// Places objects in one scenario.
class ObjectPlacer {
 public:
  ObjectPlacer(const Recipe& recipe,
               const KeyedDraws& draws,
               const MadeStamps& stamps,
               std::shared_ptr<const RailWorld> world,
               DraftedScenario& draft)
      : recipe_(recipe), draws_(draws), stamps_(stamps), world_(std::move(world)), draft_(draft) {}

  Json PlaceAll() {
    for (std::size_t i = 0; i < recipe_.objects.size(); ++i) {
      const PlacedObjects& objects = recipe_.objects[i];
      const auto count =
          DrawValue(objects.count, draws_, "object\n" + objects.name + "\ncount").get<double>();
      for (std::uint32_t k = 1; k <= static_cast<std::uint32_t>(count); ++k) Place(i, k);
    }
    return std::move(placed_);
  }

 private:
  void Place(std::size_t index, std::uint32_t number) {
    std::string obstacle;
    for (std::uint32_t attempt = 0; attempt < kMostAttempts; ++attempt) {
      const ObjectDraw drawn = DrawObject(recipe_, index, {draws_, number, attempt, {}}, draft_);
      DraftedScenario trial = draft_;
      AddObject(drawn, recipe_, index, trial);
      obstacle = TryPlace(trial, recipe_.objects[index].gauge);
      if (!obstacle.empty()) continue;
      draft_ = std::move(trial);
      placed_.push_back({{"name", drawn.object["name"]},
                         {"s_m", drawn.object["s_m"]},
                         {"ahead_m", drawn.ahead_m},
                         {"attempt", attempt + 1},
                         {"drawn", drawn.drawn}});
      return;
    }
    const std::string name = recipe_.objects[index].name + "/" + std::to_string(number);
    throw InputError(std::vector<Fault>{draft_.FaultAt(
        "/objects/" + std::to_string(index), "no place for \"" + name + "\" in " +
                                                 std::to_string(kMostAttempts) +
                                                 " attempts; at the last one " + obstacle)});
  }

  // Returns why the trial's last object cannot stand there; empty if it can: then it is in world_.
  std::string TryPlace(const DraftedScenario& trial, GaugeRule rule) {
    ScenarioSpec scenario = trial.Read();
    std::shared_ptr<const RailWorld> world;
    try {
      scenario = trial.OnLine(std::move(scenario));
      world = world_->WithObject(scenario.world.objects.back(), 0);
    } catch (const InputError& error) {
      return std::string("it cannot stand there: ") + error.what();
    }
    const ObjectSpec& object = scenario.world.objects.back();
    const PlaceCheck check(*world, object.name, stamps_);
    if (auto fault = check.GaugeFault(scenario, rule)) return *fault;
    if (auto fault = check.Collision()) return *fault;
    // What stands beside the line of a recording is known to its points alone.
    if (!trial.is_plan()) {
      if (!structures_) {
        structures_.emplace(LineWithoutPlants(scenario), LabelTable(scenario.labels));
      }
      if (auto fault = check.StructureFault(object, *structures_)) return *fault;
    }
    world_ = std::move(world);
    return "";
  }

  const Recipe& recipe_;
  const KeyedDraws& draws_;
  const MadeStamps& stamps_;
  std::shared_ptr<const RailWorld> world_;
  std::optional<StructureContacts> structures_;
  DraftedScenario& draft_;
  Json placed_ = Json::array();
};

}  // namespace

ObjectDraw DrawObject(const Recipe& recipe,
                      std::size_t index,
                      const ObjectTurn& turn,
                      DraftedScenario& draft) {
  const PlacedObjects& objects = recipe.objects[index];
  const std::string name = objects.name + "/" + std::to_string(turn.number);
  ObjectDraw result{objects.object.json, Json::object(), 0.0};
  for (const PointedDraw& draw : objects.draws.draws) {
    const auto known = turn.forced.find(draw.pointer);
    const Json value = known != turn.forced.end()
                           ? known->second
                           : DrawValue(draw.distribution, turn.draws,
                                       NameOfObjectDraw(name, draw.pointer), turn.attempt);
    if (const auto obstacle = SetAt(result.object, draw.pointer, value)) {
      throw InputError(std::vector<Fault>{
          draft.FaultAt(PlaceOfObjects(index) + "/draws" + PointerStep(draw.pointer), *obstacle)});
    }
    result.drawn[draw.pointer] = value;
  }
  result.ahead_m =
      DrawValue(objects.ahead_m, turn.draws, NameOfObjectDraw(name, "ahead_m"), turn.attempt)
          .get<double>();
  const DraftedScenario::Start start = draft.start();
  const double s_m = start.s_m + start.direction * result.ahead_m;
  result.object["name"] = name;
  result.object["s_m"] = s_m;
  ShiftMotion(result.object, s_m, start.time_s);
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

Json PlaceObjects(const Recipe& recipe,
                  const KeyedDraws& draws,
                  const MadeStamps& stamps,
                  std::shared_ptr<const RailWorld> world,
                  DraftedScenario& draft) {
  return ObjectPlacer(recipe, draws, stamps, std::move(world), draft).PlaceAll();
}

}  // namespace railcast
