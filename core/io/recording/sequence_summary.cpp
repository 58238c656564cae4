#include "core/io/recording/sequence_summary.h"

#include "core/base/error.h"
#include "core/io/content_hash.h"
#include "core/io/scenario_identity.h"
#include "core/io/sequence_files.h"
#include "core/io/strict_json.h"

namespace railcast {
namespace {

// In the order of the file: the data's hash depends on it.
using Json = StrictOrderedJson;

template <typename Read>
auto ReadJson(const std::string& text, const std::string& place, const Read& read)
    -> decltype(read(Json{})) {
  try {
    return read(Json::parse(text));
  } catch (const Json::exception& error) {
    throw InputError(place + ": is damaged: " + error.what());
  }
}

}  // namespace

RunSummary ReadRunSummary(const std::string& text, const std::string& place) {
  return ReadJson(text, place, [](const Json& json) {
    RunSummary run;
    run.version = json.at("version");
    run.scenario_hash = json.at("scenario_xxh3");
    run.format = json.at("format");
    run.start_frame = json.at("start_frame");
    run.num_frames = json.at("num_frames");
    run.has_commands = json.contains("commands_xxh3");
    if (!json.contains("isa")) return run;
    run.embree = json.at("embree");
    run.isa = json.at("isa");
    run.files.push_back({std::string(kScenarioFile), run.scenario_hash, {}});
    for (const Json& input : json.at("inputs")) {
      const InputFile file{input.at("name"), input.at("xxh3"), {}};
      run.files.push_back({file.CopyName(), file.hash, {}});
    }
    if (run.has_commands) {
      run.files.push_back({std::string(kCommandsFile), json.at("commands_xxh3"), {}});
    }
    return run;
  });
}

Manifest ReadManifest(const std::string& text, const std::string& place) {
  return ReadJson(text, place, [](const Json& json) {
    Manifest manifest;
    manifest.version = json.at("version");
    manifest.format = json.at("format");
    manifest.start_frame = json.at("start_frame");
    manifest.num_frames = json.at("num_frames");
    for (const auto& [name, hash] : json.at("files_xxh3").items()) {
      manifest.files.push_back({name, hash, {}});
    }
    manifest.data_hash = json.value("data_xxh3", "");
    return manifest;
  });
}

std::string DataHash(const std::vector<KnownFile>& files) {
  std::string hashes;
  for (const KnownFile& file : files) {
    if (file.name != kRunFile) hashes += file.hash;
  }
  return ContentHash(hashes);
}

}  // namespace railcast
