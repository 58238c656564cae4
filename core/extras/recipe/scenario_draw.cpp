#include "core/extras/recipe/scenario_draw.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/recipe/distribution.h"
#include "core/extras/recipe/drafted_scenario.h"
#include "core/extras/recipe/object_placement.h"
#include "core/extras/recipe/recipe_values.h"
#include "core/extras/recipe/seen_stretch.h"
#include "core/scenario/sensors.h"
#include "core/scenario/track_limits.h"
#include "railcast/lidar.h"
#include "railcast/rail_world.h"

namespace railcast {
namespace {

/// How often a start is drawn until what the scenario sees from there may be in its part.
constexpr std::uint32_t kMostGlances = 10'000;

/// Draws one scenario.
class OneDraw {
 public:
  OneDraw(const Recipe& recipe,
          const RecipeBases& bases,
          const SplitPlan& plan,
          std::uint32_t number,
          const GivenQuantiles& given)
      : recipe_(recipe),
        plan_(plan),
        number_(number),
        draws_(recipe.seed, number, given),
        split_(plan.PartOf(number % recipe.num_scenarios)),
        base_(IndexByWeight(plan.BaseWeights(split_), draws_.Unit("base"))),
        draft_(recipe, number, bases.json(base_), base_) {}

  DrawnScenario Run() {
    Json drawn = PutRecipeValues(recipe_, draws_, number_, {}, draft_);
    PutSeed();
    const std::shared_ptr<const RecordedBase>& run = recipe_.bases[base_].run;
    if (run) {
      FindFrames(*run);
    } else {
      FindStart();
    }
    const Json placed = PlaceObjects(recipe_, draws_, stamps_, world_, draft_);
    DrawnScenario result{.scenario = WithRecipeSensor(recipe_, draft_.Read()),
                         .run = run,
                         .first_frame = first_frame_,
                         .num_frames = recipe_.num_frames};
    if (run) drawn["recording"] = NameOfRecording(*run);
    const ScenarioSpec& scenario = result.scenario;
    const Json resolved = Json::parse(ResolvedScenarioJson(scenario));
    result.record = {
        .scenario = number_,
        .base = recipe_.bases[base_].file.substr(recipe_.bases[base_].file.rfind('/') + 1),
        .split = std::string(NameOf(split_)),
        .line = line_hash_,
        .seen_s_m = {seen_.begin_s_m, seen_.end_s_m},
        .seed = scenario.seed,
        .world_seed = scenario.world.seed,
        .start_s_m = run ? draft_.start().s_m : scenario.vehicle.start_s_m,
        .placed = placed,
        .weather = resolved.at("weather")};
    for (const auto& [name, value] : drawn.items()) result.record.drawn.emplace_back(name, value);
    if (run) result.record.first_frame = first_frame_;
    return result;
  }

 private:
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

  // Draws where the vehicle starts until everything fits.
  void FindStart() {
    const RecipeBase& base = recipe_.bases[base_];
    const std::optional<Distribution>& start = base.start_s_m ? base.start_s_m : recipe_.start_s_m;
    const std::string place = base.start_s_m ? base.pointer + "/start_s_m" : "/start_s_m";
    if (!start) {
      const std::string obstacle = TryStart();
      if (obstacle.empty()) return;
      throw InputError(std::vector<Fault>{draft_.FaultAt("/split/by", obstacle)});
    }
    const double sight_m = SightOf_m(recipe_, WithRecipeSensor(recipe_, draft_.Read()));
    from_start_ = {-sight_m, sight_m};
    std::string obstacle;
    std::uint32_t attempt = 0;
    for (std::uint32_t tried = 0; tried < kMostAttempts && attempt < kMostGlances; ++attempt) {
      const auto start_s_m = DrawValue(*start, draws_, "start_s_m", attempt).get<double>();
      seen_ = from_start_.ShiftedBy(start_s_m);
      obstacle = OtherGround();
      if (!obstacle.empty()) continue;
      draft_.Set("/vehicle/start_s_m", start_s_m, place);
      ++tried;
      try {
        obstacle = TryStart();
      } catch (const InputError& error) {
        obstacle = error.faults().front().Line();
      }
      if (obstacle.empty()) return;
    }
    throw InputError(
        std::vector<Fault>{draft_.FaultAt(place, "no start in " + std::to_string(attempt) +
                                                     " attempts; at the last one: " + obstacle)});
  }

  // Draws with which frame of the recording a plan begins, until what it sees is in its part.
  void FindFrames(const RecordedBase& run) {
    const ScenarioSpec scenario = draft_.OnLine(draft_.Read());
    const double sight_m = SightOf_m(recipe_, scenario);
    const std::uint32_t num_starts = NumStartsIn(recipe_, run);
    std::string obstacle;
    for (std::uint32_t attempt = 0; attempt < kMostGlances; ++attempt) {
      first_frame_ = static_cast<std::uint32_t>(draws_.Unit("first_frame", attempt) * num_starts);
      seen_ = SeenStretchFrom(recipe_, run, first_frame_, sight_m);
      obstacle = OtherGround();
      if (obstacle.empty()) return BeginWith(run, scenario);
    }
    throw InputError(std::vector<Fault>{
        draft_.FaultAt("/split", "no first frame in " + NumberText(kMostGlances) +
                                     " attempts; at the last one: " + obstacle)});
  }

  void BeginWith(const RecordedBase& run, const ScenarioSpec& on_line) {
    for (std::uint32_t i = 0; i < recipe_.num_frames; ++i) {
      stamps_.frames.push_back(first_frame_ + i);
      stamps_.stamps_ns.push_back(run.frames().at(first_frame_ + i).time_ns);
    }
    const RecordedBase::FramePlace& first = run.frames().at(first_frame_);
    draft_.StartAt({first.s_m, first.faces_up ? 1.0 : -1.0, SecondsFromNs(first.time_ns)});
    world_ = draft_.Located([&] { return MakeWorld(on_line); });
    line_hash_ = LineHash(Json::parse(ResolvedScenarioJson(on_line)));
  }

  [[nodiscard]] std::string NameOfRecording(const RecordedBase& run) const {
    const auto folder = std::filesystem::absolute(recipe_.file).lexically_normal().parent_path();
    return run.recording().lexically_proximate(folder).generic_string();
  }

  // Says that what the scenario sees is not all in its part; empty if it is.
  [[nodiscard]] std::string OtherGround() const {
    if (recipe_.split.by != SplitBy::kPlace || plan_.PartOf(base_, seen_) == split_) return "";
    return "what it sees, " + NumberText(std::round(seen_.begin_s_m)) + " to " +
           NumberText(std::round(seen_.end_s_m)) + " m, is not all in places of " +
           std::string(NameOf(split_));
  }

  // Returns what is wrong with the part; empty if nothing is.
  // @throws InputError if the vehicle cannot run from there.
  std::string TryStart() {
    const ScenarioSpec scenario = WithRecipeSensor(recipe_, draft_.Read());
    const std::vector<SensorPlace> sensors = SensorsOf(scenario);
    const ScanPattern pattern = BuildScanPattern(sensors.front().lidar.scan);
    stamps_ = StampsOf(recipe_, pattern);
    draft_.Located([&] {
      world_ = MakeWorld(scenario);
      // Where it leads says where else it may start, also if it cannot start here.
      seen_ = SeenStretchOf(*world_, stamps_, SightOf_m(recipe_, scenario));
      from_start_ = seen_.ShiftedBy(-scenario.vehicle.start_s_m);
      CheckStaysOnTracks(scenario, *world_, pattern, 0, recipe_.last_frame());
      CheckVehicleIsClear(scenario, *world_, pattern, 0, recipe_.last_frame());
      for (const SensorPlace& other : std::span(sensors).subspan(1)) {
        CheckOther(scenario, pattern, BuildScanPattern(other.lidar.scan), other.pointer);
      }
    });
    line_hash_ = LineHash(Json::parse(ResolvedScenarioJson(scenario)));
    return OtherGround();
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
  const SplitPlan& plan_;
  std::uint32_t number_;
  KeyedDraws draws_;
  Split split_;
  std::size_t base_;
  DraftedScenario draft_;
  std::shared_ptr<const RailWorld> world_;
  MadeStamps stamps_;
  SeenStretch seen_;
  SeenStretch from_start_;  ///< What is seen from a start at 0, as far as is known.
  std::string line_hash_;
  std::uint32_t first_frame_ = 0;  ///< Where a plan begins.
};

}  // namespace

DrawnScenario ScenarioDrawer::Draw(std::uint32_t number, const GivenQuantiles& given) const {
  return OneDraw(recipe_, bases_, plan_, number, given).Run();
}

}  // namespace railcast
