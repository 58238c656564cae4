#include "core/io/recording/sequence_summary.h"

#include <algorithm>
#include <initializer_list>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/run/motion_files.h"
#include "core/io/run/scenario_identity.h"
#include "core/io/run/sequence_files.h"
#include "core/io/run/trace_name.h"
#include "core/io/strict_json.h"
#include "railcast/io/cloud_files.h"

namespace railcast {
namespace {

// StrictOrderedJson keeps the members in the order of the file, on which the data's hash depends.

constexpr std::string_view kManifestHashBegin = "  \"manifest_xxh3\": \"";
constexpr std::string_view kManifestHashEnd = "\"\n}\n";

void RefuseUnknownKeys(const StrictOrderedJson& json,
                       std::initializer_list<std::string_view> known,
                       const std::string& place) {
  for (const auto& [key, value] : json.items()) {
    if (std::ranges::find(known, key) != known.end()) continue;
    throw InputError(place + ": is damaged: unknown key " + ShownText(key));
  }
}

// A run's bag is in the directory of its only sensor or in that around its sensors'.
void ReadBag(const StrictOrderedJson& json, const std::string& place, RunSummary& run) {
  run.bag = json.at("path");
  run.cloud_topics = json.at("topics");
  const FrameFormat* const format = FindFrameFormat(run.format);
  const std::string name(format == nullptr ? "" : format->bag);
  if (!name.empty() && (run.bag == name || run.bag == "../" + name)) return;
  throw InputError(place + ": bag: path: must be that of a bag of format " + ShownText(run.format) +
                   " (got " + ShownText(run.bag) + ")");
}

}  // namespace

RunSummary ReadRunSummary(const std::string& text, const std::string& place) {
  return ReadRecordedJson<StrictOrderedJson>(text, place, [&](const StrictOrderedJson& json) {
    RunSummary run;
    run.version = json.at("version");
    run.scenario_hash = json.at("scenario_xxh3");
    run.seed = json.at("seed");
    run.format = json.at("format");
    run.start_frame = json.at("start_frame");
    run.num_frames = json.at("num_frames");
    run.stride = json.value("stride", 1U);
    if (run.stride == 0) throw InputError(place + ": stride: must be at least 1 (got 0)");
    run.has_commands = json.contains("commands_xxh3");
    RefuseUnknownKeys(
        json,
        {"version", "embree", "isa", "seed", "inputs", "scenario_xxh3", "commands_xxh3", "format",
         "fields", "bag", "trace", "motion_sensors", "start_frame", "num_frames", "stride"},
        place);
    if (json.contains("motion_sensors")) json.at("motion_sensors").get_to(run.motion_sensors);
    for (const std::string& sensor : run.motion_sensors) {
      if (IsMotionFile(MotionFileName(sensor))) continue;
      throw InputError(place + ": motion_sensors: must be names of files (got " +
                       ShownText(sensor) + ")");
    }
    if (json.contains("fields")) json.at("fields").get_to(run.fields);
    if (json.contains("bag")) ReadBag(json.at("bag"), place, run);
    run.trace = json.value("trace", "");
    if (!run.trace.empty() && !IsTraceName(run.trace)) {
      throw InputError(place + ": trace: must be the name of an OSI trace (got " +
                       ShownText(run.trace) + ")");
    }
    if (!json.contains("isa")) return run;
    run.embree = json.at("embree");
    run.isa = json.at("isa");
    run.files.push_back({std::string(kScenarioFile), run.scenario_hash, {}});
    for (const StrictOrderedJson& input : json.at("inputs")) {
      const InputFile file{input.at("name"), input.at("xxh3"), {}, input.value("folder", "")};
      run.files.push_back({file.CopyName(), file.hash, {}});
    }
    if (run.has_commands) {
      run.files.push_back({std::string(kCommandsFile), json.at("commands_xxh3"), {}});
    }
    return run;
  });
}

Manifest ReadManifest(const std::string& text, const std::string& place) {
  return ReadRecordedJson<StrictOrderedJson>(text, place, [&](const StrictOrderedJson& json) {
    Manifest manifest;
    manifest.version = json.at("version");
    manifest.seed = json.at("seed");
    manifest.format = json.at("format");
    manifest.start_frame = json.at("start_frame");
    manifest.num_frames = json.at("num_frames");
    for (const auto& [name, hash] : json.at("files_xxh3").items()) {
      manifest.files.push_back({name, hash, {}});
    }
    manifest.data_hash = json.value("data_xxh3", "");
    if (json.contains("fidelity_choice")) {
      manifest.chosen_effects = json.at("fidelity_choice").at("effects");
    }
    RefuseUnknownKeys(
        json,
        {"version", "seed", "format", "start_frame", "num_frames", "fidelity_choice", "points",
         "outcomes", "points_per_label", "files_xxh3", "data_xxh3", "manifest_xxh3",
         // Written by older programs instead of the last two.
         "all_xxh3"},
        place);
    return manifest;
  });
}

std::string WithManifestHash(const std::string& json) {
  constexpr std::string_view kEnd = "\n}\n";
  Check(json.ends_with(kEnd), "a manifest has a line for its end");
  std::string text = json.substr(0, json.size() - kEnd.size()) + ",\n";
  const std::string hash = ContentHash(text);
  text += kManifestHashBegin;
  text += hash;
  return text += kManifestHashEnd;
}

void CheckManifestHash(const std::string& text, const std::string& place) {
  const std::size_t begin = text.rfind(kManifestHashBegin);
  if (begin == std::string::npos) {
    throw InputError(place + ": must end with manifest_xxh3, the hash of all before it");
  }
  std::string got = text.substr(begin + kManifestHashBegin.size());
  const std::string hash = ContentHash(text.substr(0, begin));
  if (got == hash + std::string(kManifestHashEnd)) return;
  if (got.ends_with(kManifestHashEnd)) got.resize(got.size() - kManifestHashEnd.size());
  throw InputError(place + ": /manifest_xxh3: must be " + hash + ", that of all before it (got " +
                   ShownText(got) + ")");
}

std::string DataHash(const std::vector<KnownFile>& files) {
  std::string hashes;
  for (const KnownFile& file : files) {
    if (file.name != kRunFile) hashes += file.hash;
  }
  return ContentHash(hashes);
}

}  // namespace railcast
