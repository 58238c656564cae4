#include <algorithm>

#include "core/io/content_hash.h"
#include "core/io/record/record_text.h"
#include "core/io/run/folder_identity.h"
#include "core/io/run/motion_files.h"
#include "core/io/run/run_record.h"
#include "core/io/run/sequence_files.h"
#include "generator/run/run_directory.h"

namespace railcast {
namespace {

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
  if (!spec.bag.empty()) run.bag = {spec.bag, spec.cloud_topics, std::string(kBagLinesFile)};
  if (spec.trace.empty() && !spec.files.format->dataset) {
    run.fields = spec.layout.empty() ? spec.files.fields.Text() : spec.layout;
  }
  if (spec.motion_sensors) {
    for (const MotionFile& file : MotionFilesOf(*spec.motion_sensors)) {
      run.motion_sensors.push_back(file.sensor);
    }
  }
  if (spec.stride != 1) run.stride_if_not_1 = spec.stride;
  if (spec.certify) run.certify = spec.certify->cost_share;
  return run;
}

// Explains a different scenario: it names the file whose content differs where the names of all
// files are the same.
std::string ScenarioDifference(const Json& found, const Json& ours) {
  const bool has_same_names =
      found.is_array() && std::equal(found.begin(), found.end(), ours.begin(), ours.end(),
                                     [](const Json& theirs, const Json& own) {
                                       return theirs.is_object() &&
                                              MemberOf(theirs, "name") == own.at("name");
                                     });
  const auto changed = has_same_names
                           ? std::mismatch(ours.begin(), ours.end(), found.begin(),
                                           [](const Json& own, const Json& theirs) {
                                             return MemberOf(theirs, "xxh3") == own.at("xxh3");
                                           })
                                 .first
                           : ours.end();
  if (changed == ours.end()) return "holds a run of another scenario";
  return "holds a run with another content of " + changed->at("name").get<std::string>();
}

// What another value of a key of run.json means.
std::string RunDifference(const std::string& key, const Json& found, const Json& ours) {
  if (key == "commands_xxh3") {
    return std::string("holds a run with ") + (ours.contains(key) ? "other " : "") + "commands";
  }
  if (key == "scenario_xxh3" || key == "inputs") {
    return ScenarioDifference(MemberOf(found, "inputs"), MemberOf(ours, "inputs"));
  }
  return "holds another run: " + ValuesText(key, MemberOf(found, key), MemberOf(ours, key));
}

}  // namespace

std::string RunJson(const SequenceSpec& spec) {
  return RecordFile(RunRecordOf(spec));
}

void CheckIsSameRun(const SequenceSpec& spec, bool is_complete) {
  CheckIsSame({spec.directory / kRunFile, RunJson(spec), is_complete}, RunDifference);
}

}  // namespace railcast
