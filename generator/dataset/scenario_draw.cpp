#include "generator/dataset/scenario_draw.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "core/base/attempt.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scenario/sensors.h"
#include "core/scenario/track_limits.h"
#include "core/scenario/vehicle_clearance.h"
#include "generator/dataset/dataset_split.h"
#include "generator/dataset/drafted_scenario.h"
#include "generator/dataset/keyed_draws.h"
#include "generator/dataset/object_placement.h"
#include "generator/dataset/recipe_values.h"
#include "railcast/lidar.h"
#include "railcast/rail_world.h"

namespace railcast {
namespace {

MadeStamps StampsOf(const Recipe& recipe, const ScanPattern& pattern) {
  MadeStamps stamps;
  if (recipe.warm_up_frames > 0) stamps.frames.push_back(0);
  for (std::uint32_t i = 0; i < recipe.num_frames; ++i) {
    stamps.frames.push_back(recipe.warm_up_frames + i * recipe.stride);
  }
  for (const std::uint32_t frame : stamps.frames) {
    stamps.stamps_ns.push_back(pattern.StampNs(frame));
  }
  return stamps;
}

/// Draws one scenario.
class OneDraw {
 public:
  OneDraw(const Recipe& recipe, const RecipeBases& bases, std::uint32_t number)
      : recipe_(recipe),
        number_(number),
        draws_(recipe.seed, number),
        base_(DrawBase()),
        draft_(recipe, number, bases.json(base_), base_) {}

  DrawnScenario Run() {
    Json drawn = PutRecipeValues(recipe_, draws_, number_, {}, draft_);
    PutSeed();
    FindStart();
    const Json placed = PlaceObjects(recipe_, draws_, stamps_, world_, draft_);
    DrawnScenario result{PickIn(draft_.Read()), {}};
    const ScenarioSpec& scenario = result.scenario;
    const Json resolved = Json::parse(ResolvedScenarioJson(scenario));
    result.record = {
        {"scenario", number_},
        {"base", recipe_.bases[base_].file.substr(recipe_.bases[base_].file.rfind('/') + 1)},
        {"split", NameOf(split_)},
        {"line", line_hash_},
        {"seen_s_m", {seen_.begin_s_m, seen_.end_s_m}},
        {"seed", scenario.seed},
        {"world_seed", scenario.world.seed},
        {"start_s_m", scenario.vehicle.start_s_m},
        {"drawn", std::move(drawn)},
        {"placed", placed},
        {"weather", resolved.at("weather")}};
    return result;
  }

 private:
  [[nodiscard]] std::size_t DrawBase() const {
    std::vector<double> weights;
    for (const RecipeBase& base : recipe_.bases) weights.push_back(base.weight);
    return IndexByWeight(weights, draws_.Unit("base"));
  }

  // Sensor and weather draw anew in each scenario unless the recipe says otherwise.
  void PutSeed() {
    const auto is_seed = [](const auto& value) { return value.pointer == "/seed"; };
    bool is_given = std::ranges::any_of(recipe_.set.values, is_seed) ||
                    std::ranges::any_of(recipe_.draws.draws, is_seed);
    for (const DrawGroup& group : recipe_.groups) {
      for (const GroupOption& option : group.options) {
        is_given = is_given || std::ranges::any_of(option.set.values, is_seed) ||
                   std::ranges::any_of(option.draws.draws, is_seed);
      }
    }
    constexpr std::uint64_t kMostSeed = (std::uint64_t{1} << 53U) - 1;  // Exact in all JSON.
    if (!is_given) draft_.Set("/seed", draws_.Seed("seed") & kMostSeed, "/seed");
  }

  // Without a choice, frames are made of all sensors.
  [[nodiscard]] ScenarioSpec PickIn(const ScenarioSpec& scenario) const {
    if (!recipe_.sensor && scenario.lidars.size() > 1) return scenario;
    return AtPlace(ShownPath(recipe_.file.lexically_normal()) + ": /",
                   [&] { return PickSensor(scenario, recipe_.sensor); });
  }

  // Draws where the vehicle starts until everything fits.
  void FindStart() {
    const RecipeBase& base = recipe_.bases[base_];
    const std::optional<Distribution>& start = base.start_s_m ? base.start_s_m : recipe_.start_s_m;
    const std::string place =
        base.start_s_m ? "/bases/" + std::to_string(base_) + "/start_s_m" : "/start_s_m";
    if (!start) {
      const std::string obstacle = TryStart();
      if (obstacle.empty()) return;
      throw InputError(std::vector<Fault>{draft_.FaultAt("/split/by", obstacle)});
    }
    std::string obstacle;
    for (std::uint32_t attempt = 0; attempt < kMostAttempts; ++attempt) {
      const Json start_s_m = DrawValue(*start, draws_, "start_s_m", attempt);
      draft_.Set("/vehicle/start_s_m", start_s_m, place);
      if (IsAcrossParts(start_s_m.get<double>())) {
        obstacle = AcrossParts();
        continue;
      }
      try {
        obstacle = TryStart();
      } catch (const InputError& error) {
        obstacle = error.faults().front().Line();
      }
      if (obstacle.empty()) return;
    }
    throw InputError(
        std::vector<Fault>{draft_.FaultAt(place, "no start in " + std::to_string(kMostAttempts) +
                                                     " attempts; at the last one: " + obstacle)});
  }

  // A quick check of the surroundings of the start alone.
  bool IsAcrossParts(double start_s_m) {
    if (recipe_.split.by != SplitBy::kPlace || !recipe_.split.sight_m) return false;
    const double sight_m = *recipe_.split.sight_m;
    seen_ = {start_s_m - sight_m, start_s_m + sight_m};
    line_hash_ = LineHash(draft_.json());
    return !SplitOfStretch(recipe_, line_hash_, seen_);
  }

  [[nodiscard]] std::string AcrossParts() const {
    return "what it sees, " + NumberText(std::round(seen_.begin_s_m)) + " to " +
           NumberText(std::round(seen_.end_s_m)) + " m, reaches into cells of several parts";
  }

  // Returns what is wrong with the part; empty if nothing is.
  // @throws InputError if the vehicle cannot run from there.
  std::string TryStart() {
    const ScenarioSpec scenario = PickIn(draft_.Read());
    const std::vector<SensorPlace> sensors = SensorsOf(scenario);
    const ScanPattern pattern = BuildScanPattern(sensors.front().lidar.scan);
    stamps_ = StampsOf(recipe_, pattern);
    draft_.Located([&] {
      world_ = MakeWorld(scenario);
      CheckStaysOnTracks(scenario, *world_, pattern, 0, recipe_.last_frame());
      CheckVehicleIsClear(scenario, *world_, pattern, 0, recipe_.last_frame());
      for (const SensorPlace& other : std::span(sensors).subspan(1)) {
        CheckOther(scenario, pattern, BuildScanPattern(other.lidar.scan), other.pointer);
      }
    });
    line_hash_ = LineHash(Json::parse(ResolvedScenarioJson(scenario)));
    double range_max_m = 0.0;
    for (const SensorPlace& sensor : sensors) {
      range_max_m = std::max(range_max_m, sensor.lidar.range_max_m);
    }
    const double sight_m = recipe_.split.sight_m.value_or(range_max_m);
    const auto [least, most] = std::ranges::minmax(VehicleChainages());
    seen_ = {least - sight_m, most + sight_m};
    switch (recipe_.split.by) {
      case SplitBy::kScenario:
        split_ = SplitOfScenario(recipe_, number_);
        return "";
      case SplitBy::kLine:
        split_ = SplitOfLine(recipe_, line_hash_, recipe_.bases[base_].split);
        return "";
      case SplitBy::kPlace:
        break;
    }
    const std::optional<Split> split = SplitOfStretch(recipe_, line_hash_, seen_);
    if (!split) return AcrossParts();
    split_ = *split;
    return "";
  }

  [[nodiscard]] std::vector<double> VehicleChainages() const {
    std::vector<double> chainages_m;
    for (const std::int64_t stamp_ns : stamps_.stamps_ns) {
      chainages_m.push_back(world_->VehicleChainage_m(stamp_ns));
    }
    return chainages_m;
  }

  // Checks the frames of another sensor, which begin while those of the first one last.
  void CheckOther(const ScenarioSpec& scenario,
                  const ScanPattern& first,
                  const ScanPattern& pattern,
                  const std::string& pointer) const {
    const std::int64_t begin_ns = first.StampNs(recipe_.warm_up_frames);
    const std::int64_t end_ns = first.StampNs(recipe_.last_frame() + 1);
    const std::uint32_t last = LastFrameBefore(pattern, end_ns);
    if (pattern.StampNs(last) < begin_ns || pattern.StampNs(last) >= end_ns) {
      throw InputError(std::vector<Fault>{
          draft_.FaultAt("/num_frames", "must last until a frame of " + pointer + " begins")});
    }
    CheckStaysOnTracks(scenario, *world_, pattern, 0, last);
  }

  const Recipe& recipe_;
  std::uint32_t number_;
  KeyedDraws draws_;
  std::size_t base_;
  DraftedScenario draft_;
  std::shared_ptr<const RailWorld> world_;
  MadeStamps stamps_;
  SeenStretch seen_;
  std::string line_hash_;
  Split split_ = Split::kTrain;
};

}  // namespace

DrawnScenario ScenarioDrawer::Draw(std::uint32_t number) const {
  return OneDraw(recipe_, bases_, number).Run();
}

}  // namespace railcast
