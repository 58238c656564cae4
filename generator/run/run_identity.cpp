#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/record/record_text.h"
#include "core/io/run/bag_lines_name.h"
#include "core/io/run/motion_files.h"
#include "core/io/run/run_record.h"
#include "generator/run/run_directory.h"

namespace railcast {
namespace {

using Json = nlohmann::ordered_json;

RunRecord RunRecordOf(const SequenceSpec& spec) {
  RunRecord run{.version = spec.version,
                .embree = spec.embree_version,
                .isa = spec.isa,
                .seed = spec.seed,
                .scenario_hash = spec.identity.scenario_hash,
                .format = std::string(spec.files.format->name),
                .trace = spec.trace,
                .start_frame = spec.start_frame,
                .num_frames = spec.num_frames};
  for (const InputFile& input : spec.identity.inputs) {
    run.inputs.push_back({input.name, input.hash, input.folder});
  }
  if (!spec.commands_jsonl.empty()) run.commands_hash = ContentHash(spec.commands_jsonl);
  if (!spec.bag.empty()) {
    run.fields = ros::TextOf(spec.clouds);
    run.bag = {spec.bag, spec.cloud_topics, std::string(kBagLinesFile)};
  } else if (spec.trace.empty() && !spec.files.format->dataset) {
    run.fields = spec.files.fields.Text();
  }
  if (spec.motion_sensors) {
    for (const MotionFile& file : MotionFilesOf(*spec.motion_sensors)) {
      run.motion_sensors.push_back(file.sensor);
    }
  }
  if (spec.stride != 1) run.stride_if_not_1 = spec.stride;
  return run;
}

// Returns a reference, because the library copies and writes recursively and the member may be
// deeply nested.
const Json& Member(const Json& object, const std::string& key) {
  static const Json kNothing;
  const auto member = object.find(key);
  return member == object.end() ? kNothing : *member;
}

// Explains a different scenario: it names the file whose content differs where the names of all
// files are the same.
std::string ScenarioDifference(const Json& found, const Json& ours) {
  const bool has_same_names =
      found.is_array() && std::equal(found.begin(), found.end(), ours.begin(), ours.end(),
                                     [](const Json& theirs, const Json& own) {
                                       return theirs.is_object() &&
                                              Member(theirs, "name") == own.at("name");
                                     });
  const auto changed = has_same_names
                           ? std::mismatch(ours.begin(), ours.end(), found.begin(),
                                           [](const Json& own, const Json& theirs) {
                                             return Member(theirs, "xxh3") == own.at("xxh3");
                                           })
                                 .first
                           : ours.end();
  if (changed == ours.end()) return "holds a run of another scenario";
  return "holds a run with another content of " + changed->at("name").get<std::string>();
}

std::string Text(const Json& value) {
  if (value.is_null()) return "nothing";
  if (value.is_string()) return ShownText(value.get_ref<const std::string&>());
  return value.is_primitive() ? value.dump() : value.type_name();
}

// Frames of two program versions or instruction sets must not be mixed: neither would have made the
// same sequence.
std::string ProgramDifference(const std::string& key,
                              const Json& found,
                              const Json& ours,
                              bool is_complete) {
  const std::string other = "choose another --out";
  const bool is_isa = key == "isa";
  const std::string what = is_isa ? "instruction set" : key == "embree" ? "Embree" : "railcast";
  const std::string got = Text(found) + " (got " + Text(ours) + "); ";
  const std::string same = is_isa ? "add --isa " + Text(found) : "use that one";
  if (is_complete) {
    return "is complete, made " + std::string(is_isa ? "with " : "by ") + what + " " + got + same +
           ", or " + other;
  }
  return "must be continued " +
         (is_isa ? "with the " + what + " that it was begun with, "
                 : "by the " + what + " that began it, ") +
         got + same + ", or " + other;
}

// Returns the name of the command-line option for a key.
std::string NameOf(const std::string& key) {
  if (key == "num_frames") return "--frames";
  if (key == "start_frame") return "--start-frame";
  if (key == "stride") return "--stride";
  return key;
}

}  // namespace

std::string RunJson(const SequenceSpec& spec) {
  return RecordFile(RunRecordOf(spec));
}

void CheckSameRun(const SequenceSpec& spec, const std::string& run_json, bool is_complete) {
  // Members nested deeper than railcast writes them are dropped, since the library copies
  // recursively.
  constexpr int kDepth = 8;
  const Json found = Json::parse(
      run_json, [](int depth, auto /*event*/, const auto& /*parsed*/) { return depth <= kDepth; },
      false);
  const std::string place = ShownPath(spec.directory) + ": ";
  if (!found.is_object()) throw InputError(place + "holds a run.json that is not railcast's");
  const Json ours = Json::parse(RunJson(spec));
  if (found.contains("commands_xxh3") && spec.commands_jsonl.empty()) {
    throw InputError(place + "holds a run with commands; choose another --out");
  }
  if (found.contains("stride") && spec.stride == 1) {
    throw InputError(place + "holds another run: its --stride is " + Text(found["stride"]) +
                     " (got 1); choose another --out");
  }
  for (const auto& [key, value] : ours.items()) {
    const Json& other = Member(found, key);
    if (other == value) continue;
    if (key == "version" || key == "embree" || key == "isa") {
      throw InputError(place + ProgramDifference(key, other, value, is_complete));
    }
    if (key == "inputs" || key == "scenario_xxh3") {
      throw InputError(place + ScenarioDifference(Member(found, "inputs"), ours["inputs"]) +
                       "; choose another --out");
    }
    if (key == "commands_xxh3") {
      throw InputError(place + "holds a run with other commands; choose another --out");
    }
    std::string line = place;
    line += "holds another run: its " + NameOf(key) + " is " + Text(other);
    line += " (got " + Text(value) + "); choose another --out";
    throw InputError(line);
  }
}

}  // namespace railcast
