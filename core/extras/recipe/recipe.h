#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/recipe/distribution.h"
#include "core/scenario/json_text.h"
#include "railcast/enum_names.h"
#include "railcast/scenario.h"

namespace railcast {

/// The parts that a data set is divided into.
enum class Split { kTrain, kVal, kTest };
template <>
inline constexpr auto kEnumNames<Split> = std::to_array<EnumName<Split>>({{Split::kTrain, "train"},
                                                                          {Split::kVal, "val"},
                                                                          {Split::kTest, "test"}});

/// What is not divided between parts.
enum class SplitBy {
  kScenario,  ///< All frames of a scenario are in one part.
  kPlace,     ///< No part sees ground that another one sees.
  kLine,      ///< All scenarios on a line are in one part.
};
template <>
inline constexpr auto kEnumNames<SplitBy> = std::to_array<EnumName<SplitBy>>(
    {{SplitBy::kScenario, "scenario"}, {SplitBy::kPlace, "place"}, {SplitBy::kLine, "line"}});

/// Whether placed objects stand in the way on any track (VehicleOutline).
enum class GaugeRule {
  kAny,
  kClear,  ///< Nowhere, in no frame.
  kFoul,   ///< In at least one frame.
};
template <>
inline constexpr auto kEnumNames<GaugeRule> = std::to_array<EnumName<GaugeRule>>(
    {{GaugeRule::kAny, "any"}, {GaugeRule::kClear, "clear"}, {GaugeRule::kFoul, "foul"}});

/// A plan beside its recording, as far as drawing from them asks. The generator, which reads
/// recordings for plans, provides it.
class RecordedBase {
 public:
  /// Where the vehicle is when a frame of the recording begins.
  struct FramePlace {
    std::int64_t time_ns{};
    double s_m{};     ///< As plans count chainages.
    bool faces_up{};  ///< Whether it faces rising chainage.
  };

  virtual ~RecordedBase() = default;

  /// The plan as it was written, with the recording's sensor if it names none.
  [[nodiscard]] virtual const ScenarioSpec& plan() const = 0;
  [[nodiscard]] virtual const std::filesystem::path& recording() const = 0;
  [[nodiscard]] virtual const std::vector<FramePlace>& frames() const = 0;
  /// What tells recordings apart: names and hashes of their files.
  [[nodiscard]] virtual const std::string& Traits() const = 0;
  /// A plan for the recording as a scenario: with the recording's line in place of that, so that a
  /// world can be made of it.
  /// @param plan With the poses, the line and the sensor's mount and scan of plan().
  /// @throws InputError for what the plan has, and for places of objects.
  [[nodiscard]] virtual ScenarioSpec OnLine(ScenarioSpec plan) const = 0;

  [[nodiscard]] std::uint32_t num_frames() const {
    return static_cast<std::uint32_t>(frames().size());
  }
};

/// Reads a plan and the way that its recording's sensor took.
/// @throws InputError if either cannot be read.
using RecordingReader = std::function<std::shared_ptr<const RecordedBase>(
    const std::filesystem::path& plan_file, const std::filesystem::path& recording)>;

/// Names of recordings.
struct RecordingList {
  std::vector<std::string> files;  ///< Absolute.
};

/// A scenario that others are drawn from, or a plan for a recording (docs/insert.md) that others
/// for the same recording are drawn from.
struct RecipeBase {
  std::string file;          ///< Absolute.
  RecordingList recordings;  ///< A plan's recordings; each makes a base.
  double weight = 1.0;
  std::optional<Split> split;  ///< Part of all scenarios on its line; for SplitBy::kLine only.
  std::optional<Distribution> start_s_m;  ///< Instead of the recipe's.
  std::string pointer;                    ///< Its place in the recipe: "/bases/0".
  std::string recording_pointer;  ///< Where its recording is named: "/bases/0/recordings/1".
  std::shared_ptr<const RecordedBase> run;  ///< The plan and its recording; null for a scenario.
};

/// A value for one place of a scenario.
struct PointedValue {
  std::string pointer;  ///< JSON pointer.
  Json value;
};
struct SetList {
  std::vector<PointedValue> values;  ///< In the order of the file.
};

/// A distribution for one place of a scenario.
struct PointedDraw {
  std::string pointer;
  Distribution distribution;
};
struct DrawList {
  std::vector<PointedDraw> draws;  ///< In the order of the file.
};

/// Values that belong together.
struct GroupOption {
  std::string name;
  double weight = 1.0;
  SetList set;
  DrawList draws;
};

/// A choice between options, or a weather of the published families.
struct DrawGroup {
  std::string name;
  std::vector<GroupOption> options;
  std::vector<std::string> random_weather;  ///< Instead of options: names of families.
};

/// A JSON object as it was written.
struct ObjectTemplate {
  Json json;
};

/// Objects that are placed by chance.
struct PlacedObjects {
  std::string name;  ///< They are called NAME/1, NAME/2, ...
  Distribution count;
  /// As in world.objects, without name and s_m. Chainages in its motion count from its own place.
  ObjectTemplate object;
  DrawList draws;        ///< Pointers into the object.
  Distribution ahead_m;  ///< From the vehicle's origin at time 0, in its direction of travel.
  GaugeRule gauge = GaugeRule::kAny;
};

struct SplitSpec {
  SplitBy by = SplitBy::kScenario;
  double train = 0.8;  ///< Shares; their sum is 1.
  double val = 0.1;
  double test = 0.1;
  double cell_m = 2000.0;  ///< For kPlace: length of the pieces of line that belong to one part.
  /// For kPlace: how far a scenario sees along the line. Absent = the sensor's greatest range.
  std::optional<double> sight_m;
};

/// What a data set is drawn from. Scenario k is a function of the recipe and k.
struct Recipe {
  std::filesystem::path file;
  std::uint64_t seed = 1;
  std::uint32_t num_scenarios{};
  std::uint32_t num_frames = 10;      ///< Frames of each scenario.
  std::uint32_t stride = 1;           ///< Every how many-th frame is made.
  std::uint32_t warm_up_frames = 0;   ///< Frames before the first one that is made.
  std::optional<std::string> sensor;  ///< Which one, where scenarios have several.
  std::vector<RecipeBase> bases;
  SetList set;
  std::vector<DrawGroup> groups;
  DrawList draws;
  std::optional<Distribution> start_s_m;  ///< Chainage of the vehicle at time 0.
  std::vector<PlacedObjects> objects;
  SplitSpec split;
  bool has_split = false;  ///< Whether the recipe asks for the shares, which then must hold.

  /// Whether things are put into recordings: bases are either all plans or all scenarios.
  [[nodiscard]] bool has_plans() const { return bases.front().run != nullptr; }
  /// Number of the last frame that is made of a scenario.
  [[nodiscard]] std::uint32_t last_frame() const {
    return warm_up_frames + (num_frames - 1) * stride;
  }
};

/// Reads a recipe as strictly as a scenario, its bases, and the ways of their recordings.
/// @param read_recording Null where a recipe must do without recordings.
/// @throws InputError with a line for every fault: "file: /pointer: rule (got value)".
[[nodiscard]] Recipe ReadRecipe(const std::filesystem::path& file,
                                const RecordingReader& read_recording = nullptr);

/// Checks a recipe beyond its own rules: that no value overwrites another one, and that the reader
/// of scenarios accepts what is drawn, with every extreme of every distribution and with every
/// option, on every base.
/// @throws InputError with a line for every fault, which names the recipe's key.
void CheckRecipe(const Recipe& recipe);

}  // namespace railcast
