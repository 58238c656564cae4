#pragma once

#include <cmath>

#include "core/recipe/random_weather.h"
#include "core/recipe/recipe.h"
#include "core/scenario/json_reader.h"

namespace railcast {

template <>
inline constexpr const char* kTypeName<UniformDraw> = "uniform";
template <>
inline constexpr const char* kTypeName<NormalDraw> = "normal";
template <>
inline constexpr const char* kTypeName<LogUniformDraw> = "log_uniform";
template <>
inline constexpr const char* kTypeName<IntegerDraw> = "integer";
template <>
inline constexpr const char* kTypeName<ChoiceDraw> = "choice";

// Values that are not checked here: the reader of scenarios checks them.
void ReadValue(JsonSource& source, const Node& node, JsonList& list, Anything);
void ReadValue(JsonSource& source, const Node& node, ChoiceWeights& weights, Anything);
void ReadValue(JsonSource& source, const Node& node, ObjectTemplate& object, Anything);
void ReadValue(JsonSource& source, const Node& node, RecordingList& list, Anything);
// Objects whose keys are JSON pointers.
void ReadValue(JsonSource& source, const Node& node, SetList& list, Anything);
void ReadValue(JsonSource& source, const Node& node, DrawList& list, Anything);

[[nodiscard]] inline Limits NumberLimits() {
  return Within(-1e15, 1e15);
}

template <class Archive>
void Describe(Archive& a, UniformDraw& s) {
  a.Required("min", s.min, "Least value.", NumberLimits());
  a.Required("max", s.max, "Greatest value.", NumberLimits());
  a.Ensure({"max", "min"}, s.min <= s.max, "must be >= min");
}

template <class Archive>
void Describe(Archive& a, NormalDraw& s) {
  constexpr double kLeastShare = 1e-3;
  a.Required("mean", s.mean, "Mean, before it is cut off.", NumberLimits());
  a.Required("sd", s.sd, "Standard deviation, before it is cut off.", PositiveUpTo(1e15));
  a.Optional("min", s.min, "Least value; absent = none.", NumberLimits());
  a.Optional("max", s.max, "Greatest value; absent = none.", NumberLimits());
  const bool is_in_order = !s.min || !s.max || *s.min < *s.max;
  a.Ensure({"max", "min"}, is_in_order, "must be > min");
  a.Ensure({"", "mean", "sd", "min", "max"},
           s.sd <= 0.0 || !is_in_order || ShareWithin(s) >= kLeastShare,
           "must have at least a thousandth of its values between min and max");
}

template <class Archive>
void Describe(Archive& a, LogUniformDraw& s) {
  a.Required("min", s.min, "Least value.", PositiveUpTo(1e15));
  a.Required("max", s.max, "Greatest value.", PositiveUpTo(1e15));
  a.Ensure({"max", "min"}, s.min <= s.max, "must be >= min");
}

template <class Archive>
void Describe(Archive& a, IntegerDraw& s) {
  a.Required("min", s.min, "Least number.", NumberLimits());
  a.Required("max", s.max, "Greatest number.", NumberLimits());
  a.Ensure({"min"}, std::floor(s.min) == s.min, "must be a whole number");
  a.Ensure({"max"}, std::floor(s.max) == s.max, "must be a whole number");
  a.Ensure({"max", "min"}, s.min <= s.max, "must be >= min");
}

template <class Archive>
void Describe(Archive& a, ChoiceDraw& s) {
  a.Required("values", s.values, "Any JSON values.");
  a.Optional("weights", s.weights, "One for each value; absent = all equal.");
  const std::size_t num_weights = s.weights.values.size();
  a.Ensure({"weights", "values"}, num_weights == 0 || num_weights == s.values.values.size(),
           "must have one weight for each value");
}

template <class Archive>
void Describe(Archive& a, RecipeBase& s) {
  a.Required("file", s.file, "A scenario, or a plan for recordings.", ExistingFile());
  a.Optional("recordings", s.recordings, "Of a plan: files and directories of recordings.");
  a.Optional("weight", s.weight, "How often, relative to the others.", PositiveUpTo(1e9));
  a.Optional("split", s.split, "Part of all scenarios on its line.");
  a.Optional("start_s_m", s.start_s_m, "Instead of the recipe's.");
}

template <class Archive>
void Describe(Archive& a, GroupOption& s) {
  a.Required("name", s.name, "Unique in the group.", NonEmptyString());
  a.Optional("weight", s.weight, "How often, relative to the others.", PositiveUpTo(1e9));
  a.Optional("set", s.set, "Values by JSON pointer.");
  a.Optional("draws", s.draws, "Distributions by JSON pointer.");
}

template <class Archive>
void Describe(Archive& a, DrawGroup& s) {
  a.Required("name", s.name, "Unique.", NonEmptyString());
  std::optional<std::vector<GroupOption>> options;
  if (!s.options.empty()) options = s.options;
  a.Optional("options", options, "Of which one is drawn.", NonEmptyList());
  std::optional<std::vector<std::string>> families;
  if (!s.random_weather.empty()) families = s.random_weather;
  a.Optional("random_weather", families, "Families of weather of which one is drawn.",
             OneOf(NamesOf<WeatherFamily>()));
  a.Ensure({"", "options", "random_weather"}, options.has_value() != families.has_value(),
           "must have either options or random_weather");
  a.Ensure({"random_weather"}, !families || !families->empty(), "must name a family");
  if (options) s.options = *options;
  if (families) s.random_weather = *families;
}

template <class Archive>
void Describe(Archive& a, PlacedObjects& s) {
  a.Required("name", s.name, "Unique; they are called NAME/1, NAME/2, ...", NonEmptyString());
  a.Required("count", s.count, "How many.");
  a.Required("object", s.object, "As in world.objects, without name and s_m.");
  a.Optional("draws", s.draws, "Distributions by JSON pointer into the object.");
  a.Required("ahead_m", s.ahead_m, "From the vehicle's origin at time 0, along the track.");
  a.Optional("gauge", s.gauge, "Whether it stands in the way on a track.");
}

template <class Archive>
void Describe(Archive& a, SplitSpec& s) {
  constexpr double kRounding = 1e-9;
  a.Optional("by", s.by, "What is not divided between parts.");
  a.Optional("train", s.train, "Share.", Within(0, 1));
  a.Optional("val", s.val, "Share.", Within(0, 1));
  a.Optional("test", s.test, "Share.", Within(0, 1));
  a.Ensure({"", "train", "val", "test"}, std::abs(s.train + s.val + s.test - 1.0) < kRounding,
           "must have train, val and test with a sum of 1");
  a.Optional("cell_m", s.cell_m, "Length of the pieces of line that belong to one part.",
             Within(1, 1e6));
  a.Optional("sight_m", s.sight_m,
             "How far a scenario sees along the line; absent = the sensor's greatest range.",
             Within(0, 1e5));
}

template <class Archive>
void Describe(Archive& a, Recipe& s) {
  constexpr std::uint64_t kMostScenarios = 100'000'000;
  constexpr double kMostFrame = 1e9;
  const auto whole = [](double at_least, double at_most) { return Within(at_least, at_most); };
  a.Optional("seed", s.seed, "Seed of all draws.");
  a.Required("num_scenarios", s.num_scenarios, "How many scenarios.",
             whole(1, static_cast<double>(kMostScenarios)));
  a.Optional("num_frames", s.num_frames, "How many frames of each scenario.", whole(1, 1e6));
  a.Optional("stride", s.stride, "Every how many-th frame is made.", whole(1, 1e6));
  a.Optional("warm_up_frames", s.warm_up_frames, "Frames before the first one that is made.",
             whole(0, 1e6));
  const double last =
      s.warm_up_frames + (static_cast<double>(s.num_frames) - 1.0) * static_cast<double>(s.stride);
  a.Ensure({"", "num_frames", "stride", "warm_up_frames"}, last <= kMostFrame,
           "must lead to no frame after 1000000000");
  a.Optional("sensor", s.sensor,
             "Which sensor, where scenarios have several; absent = all of them.", NonEmptyString());
  a.Required("bases", s.bases, "Scenarios to draw from.", NonEmptyList());
  a.Optional("set", s.set, "Values by JSON pointer, for all scenarios.");
  a.Optional("groups", s.groups, "Values that belong together.");
  a.Unique("groups", s.groups, "name", &DrawGroup::name);
  a.Optional("draws", s.draws, "Distributions by JSON pointer.");
  a.Optional("start_s_m", s.start_s_m, "Chainage of the vehicle's origin at time 0.");
  a.Optional("objects", s.objects, "Objects that are placed by chance.");
  a.Unique("objects", s.objects, "name", &PlacedObjects::name);
  std::optional<SplitSpec> split;
  a.Optional("split", split, "How scenarios are divided into train, val and test.");
  s.has_split = split.has_value();
  if (split) s.split = *split;
}

}  // namespace railcast
