#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/recipe/json_place.h"
#include "core/extras/recipe/random_weather.h"
#include "core/extras/recipe/recipe.h"
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

namespace {

[[nodiscard]] Limits NumberLimits() {
  return Within(-1e15, 1e15);
}

namespace fs = std::filesystem;

// Makes a base of each recording of a plan. They are read once, here.
void ReadRecordings(const RecordingReader& read_recording, Recipe& recipe) {
  ErrorList errors;
  std::vector<RecipeBase> bases;
  for (std::size_t i = 0; i < recipe.bases.size(); ++i) {
    RecipeBase& base = recipe.bases[i];
    base.pointer = "/bases/" + std::to_string(i);
    const std::vector<std::string> files = std::exchange(base.recordings.files, {});
    if (files.empty()) bases.push_back(base);
    if (!files.empty() && !read_recording) {
      errors.Add({ShownPath(recipe.file.lexically_normal()) + ": " + base.pointer + "/recordings",
                  "must be left out: only data sets are made of recordings", ""});
      continue;
    }
    for (std::size_t k = 0; k < files.size(); ++k) {
      RecipeBase& one = bases.emplace_back(base);
      one.weight = base.weight / static_cast<double>(files.size());
      one.recording_pointer = base.pointer + "/recordings/" + std::to_string(k);
      const auto run = Attempt("", errors, [&] {
        return read_recording(fs::path(base.file).lexically_proximate(fs::current_path()),
                              files[k]);
      });
      if (run) one.run = *run;
    }
  }
  errors.ThrowIfAny();
  recipe.bases = std::move(bases);
}

// Calls `read` with each pointer of an object whose keys are JSON pointers, and with its value.
template <class Read>
void ReadPointed(JsonSource& source, const Node& node, const Read& read) {
  if (!node.json->is_object()) {
    return source.Fault(node, "must be an object with JSON pointers as its keys");
  }
  for (const auto& [key, value] : node.json->items()) {
    const Node child = node.Child(key, value);
    if (const auto fault = PointerFault(key)) source.FaultWithoutValue(child, *fault);
    read(key, child);
  }
}

}  // namespace

// Values that are not checked here: the reader of scenarios checks them.
void ReadValue(JsonSource& source, const Node& node, JsonList& list) {
  if (!CheckListOfAtLeast(source, node, NonEmptyList())) return;
  for (const Json& value : *node.json) list.values.push_back(value);
}

void ReadValue(JsonSource& source, const Node& node, ChoiceWeights& weights) {
  if (!CheckListOfAtLeast(source, node, NonEmptyList())) return;
  const std::size_t num_faults = source.errors().size();
  double sum = 0.0;
  for (std::size_t i = 0; i < node.json->size(); ++i) {
    double weight = 0.0;
    ReadAs(source, node.Child(i), weight, Within(0, 1e9));
    sum += weight;
    weights.values.push_back(weight);
  }
  if (source.errors().size() > num_faults) return;
  if (sum <= 0.0) source.Fault(node, "must have a weight > 0");
}

void ReadValue(JsonSource& source, const Node& node, ObjectTemplate& object) {
  if (!node.json->is_object()) return source.Fault(node, "must be an object");
  object.json = *node.json;
  for (const char* const key :
       {"name", "s_m", "x_m", "y_m", "longitude_deg", "latitude_deg", "frame"}) {
    if (!node.json->contains(key)) continue;
    source.FaultWithoutValue(node.Child(key), "must not be given: it is drawn");
  }
}

void ReadValue(JsonSource& source, const Node& node, SetList& list) {
  ReadPointed(source, node, [&](const std::string& pointer, const Node& value) {
    list.values.push_back({pointer, *value.json});
  });
}

void ReadValue(JsonSource& source, const Node& node, DrawList& list) {
  ReadPointed(source, node, [&](const std::string& pointer, const Node& value) {
    Distribution distribution;
    ReadAs(source, value, distribution);
    list.draws.push_back({pointer, std::move(distribution)});
  });
}

void ReadValue(JsonSource& source, const Node& node, RecordingList& list) {
  std::vector<std::string> names;
  ReadAs(source, node, names, NonEmptyString());
  if (node.json->is_array() && names.empty()) source.Fault(node, "must have a recording");
  for (std::size_t i = 0; i < names.size(); ++i) {
    const fs::path file = (node.file->absolute.parent_path() / names[i]).lexically_normal();
    std::error_code error;
    if (!names[i].empty() && !fs::exists(file, error)) {
      source.Fault(node.Child(i), "must be an existing file or directory");
    }
    list.files.push_back(file.string());
  }
}

void Describe(Archive& a, UniformDraw& s) {
  a.Required("min", s.min, "Least value.", NumberLimits());
  a.Required("max", s.max, "Greatest value.", NumberLimits());
  a.Ensure({"max", "min"}, s.min <= s.max, "must be >= min");
}

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

void Describe(Archive& a, LogUniformDraw& s) {
  a.Required("min", s.min, "Least value.", PositiveUpTo(1e15));
  a.Required("max", s.max, "Greatest value.", PositiveUpTo(1e15));
  a.Ensure({"max", "min"}, s.min <= s.max, "must be >= min");
}

void Describe(Archive& a, IntegerDraw& s) {
  a.Required("min", s.min, "Least number.", NumberLimits());
  a.Required("max", s.max, "Greatest number.", NumberLimits());
  a.Ensure({"min"}, std::floor(s.min) == s.min, "must be a whole number");
  a.Ensure({"max"}, std::floor(s.max) == s.max, "must be a whole number");
  a.Ensure({"max", "min"}, s.min <= s.max, "must be >= min");
}

void Describe(Archive& a, ChoiceDraw& s) {
  a.Required("values", s.values, "Any JSON values.");
  a.Optional("weights", s.weights, "One for each value; absent = all equal.");
  const std::size_t num_weights = s.weights.values.size();
  a.Ensure({"weights", "values"}, num_weights == 0 || num_weights == s.values.values.size(),
           "must have one weight for each value");
}

void Describe(Archive& a, RecipeBase& s) {
  a.Required("file", s.file, "A scenario, or a plan for recordings.", ExistingFile());
  a.Optional("recordings", s.recordings, "Files and directories of recordings, for a plan.");
  a.Optional("weight", s.weight, "How often, relative to the others.", PositiveUpTo(1e9));
  a.Optional("split", s.split, "Part of all scenarios on its line.");
  a.Optional("start_s_m", s.start_s_m, "Instead of the recipe's.");
}

void Describe(Archive& a, GroupOption& s) {
  a.Required("name", s.name, "Unique in the group.", NonEmptyString());
  a.Optional("weight", s.weight, "How often, relative to the others.", PositiveUpTo(1e9));
  a.Optional("set", s.set, "Values by JSON pointer.");
  a.Optional("draws", s.draws, "Distributions by JSON pointer.");
}

void Describe(Archive& a, DrawGroup& s) {
  a.Required("name", s.name, "Unique.", NonEmptyString());
  std::optional<std::vector<GroupOption>> options;
  if (!s.options.empty()) options = s.options;
  a.Optional("options", options, "Options of which one is drawn.", NonEmptyList());
  std::optional<std::vector<std::string>> families;
  if (!s.random_weather.empty()) families = s.random_weather;
  a.Optional("random_weather", families, "Families of weather of which one is drawn.",
             OneOf(NamesOf<WeatherFamily>()));
  a.Ensure({"", "options", "random_weather"}, options.has_value() != families.has_value(),
           "must have either options or random_weather");
  a.Ensure({"random_weather"}, !families || !families->empty(), "must name a family");
  if (families) s.random_weather = *families;
  if (!options) return;
  s.options = *options;
  a.Unique("options", s.options, "name", &GroupOption::name);
}

void Describe(Archive& a, PlacedObjects& s) {
  a.Required("name", s.name, "Unique; they are called NAME/1, NAME/2, ...", NonEmptyString());
  a.Required("count", s.count, "How many.");
  a.Required("object", s.object, "As in world.objects, without name and s_m.");
  a.Optional("draws", s.draws, "Distributions by JSON pointer into the object.");
  a.Required("ahead_m", s.ahead_m, "From the vehicle's origin at time 0, along the track.");
  a.Optional("gauge", s.gauge, "Whether it stands in the way on a track.");
}

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
           "must not lead beyond frame 1000000000");
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

Recipe ReadRecipe(const std::filesystem::path& file, const RecordingReader& read_recording) {
  JsonSource source;
  Recipe recipe;
  if (const auto root = source.Open(file)) {
    if (auto list = source.PlainMembers(*root)) {
      ReadMembers(source, *root, std::move(*list), recipe);
    }
  }
  source.errors().ThrowIfAny();
  recipe.file = file;
  ReadRecordings(read_recording, recipe);
  CheckRecipe(recipe);
  return recipe;
}

}  // namespace railcast
