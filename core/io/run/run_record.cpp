#include "core/io/run/run_record.h"

#include <algorithm>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/record/read_record.h"
#include "core/io/run/motion_files.h"
#include "core/io/run/scenario_identity.h"
#include "core/io/run/sequence_files.h"
#include "core/io/run/trace_name.h"
#include "core/io/write_file.h"
#include "core/scenario/archive.h"
#include "railcast/io/cloud_files.h"

namespace railcast {
namespace {

constexpr std::string_view kManifestHashBegin = "  \"manifest_xxh3\": \"";
constexpr std::string_view kManifestHashEnd = "\"\n}\n";

/// Where the line with a file's own hash begins; npos if it has none. Those of others are farther
/// to the right.
std::size_t FindManifestHash(const std::string& text) {
  const std::size_t line_end = text.rfind('\n' + std::string(kManifestHashBegin));
  return line_end == std::string::npos ? line_end : line_end + 1;
}

bool IsBagOf(const std::string& path, const std::string& format) {
  const FrameFormat* const known = FindFrameFormat(format);
  const std::string name(known == nullptr ? "" : known->bag);
  // It is in the directory of its only sensor or in that around its sensors'.
  return !name.empty() && (path == name || path == "../" + name);
}

}  // namespace

void Describe(Archive& a, InputRecord& s) {
  a.Required("name", s.name, "Name of the file.", NonEmptyString());
  a.Required("xxh3", s.hash, "Hash of its bytes.");
  a.Optional("folder", s.folder, "Folder of its copy; left out where the hash is its name.");
}

void Describe(Archive& a, BagRecord& s) {
  a.Required("path", s.path, "Path of the bag, relative to the directory.");
  a.Required("topics", s.topics, "Topics of the clouds.", NonEmptyList());
  a.Optional("lines", s.lines, "The file with the bag's hashes.");
}

void Describe(Archive& a, RunRecord& s) {
  a.Required("version", s.version, "Version of railcast.");
  a.Required("embree", s.embree, "Version of Embree.");
  a.Required("isa", s.isa, "Instruction set of the tracing.");
  a.Required("seed", s.seed, "Seed of the scenario.");
  a.Required("inputs", s.inputs, "The files that the scenario names.");
  a.Required("scenario_xxh3", s.scenario_hash, "Hash of scenario.resolved.json.");
  a.Optional("commands_xxh3", s.commands_hash, "Hash of commands.jsonl.");
  a.Required("format", s.format, "Format of the clouds, as `--format` names it.");
  a.Optional("fields", s.fields, "Fields of the points, as `--fields` names them.");
  a.Optional("bag", s.bag, "The bag that holds the clouds.");
  a.Ensure({"bag"}, !s.bag || IsBagOf(s.bag->path, s.format),
           "must be that of a bag of format " + ShownText(s.format));
  a.Optional("trace", s.trace, "Name of the OSI trace.");
  a.Ensure({"trace"}, s.trace.empty() || IsTraceName(s.trace), "must be the name of an OSI trace");
  a.Optional("motion_sensors", s.motion_sensors,
             "Names of the motion sensors; each has a file in motion/.");
  a.Ensure({"motion_sensors"},
           std::ranges::all_of(
               s.motion_sensors,
               [](const std::string& name) { return IsMotionFile(MotionFileName(name)); }),
           "must be names of files");
  a.Required("start_frame", s.start_frame, "Number of the first frame.");
  a.Required("num_frames", s.num_frames, "Number of frames in the whole run.");
  a.Optional("stride", s.stride_if_not_1,
             "Step from one frame's number to the next; left out where 1.", Limits{.at_least = 1});
  a.Optional("certify", s.certify, "Share of the time that certificates may take.");
}

std::vector<KnownFile> RunRecord::Files() const {
  std::vector<KnownFile> files = {{std::string(kScenarioFile), scenario_hash, {}}};
  for (const InputRecord& input : inputs) {
    const InputFile file{input.name, input.hash, nullptr, {}, input.folder};
    files.push_back({file.CopyName(), file.hash, {}});
  }
  if (!commands_hash.empty()) files.push_back({std::string(kCommandsFile), commands_hash, {}});
  return files;
}

RunRecord ReadRun(const std::string& text, const std::string& place) {
  return ReadRecord<RunRecord>(text, place);
}

void Describe(Archive& a, ManifestRecord& s) {
  a.Required("version", s.version, "Version of railcast, as in run.json.");
  a.Required("seed", s.seed, "Seed of the scenario.");
  a.Required("format", s.format, "Format of the clouds, as `--format` names it.");
  a.Required("start_frame", s.start_frame, "Number of the first frame.");
  a.Required("num_frames", s.num_frames, "Number of frames in the whole run.");
  a.Optional("fidelity_choice", s.fidelity_choice, "What fidelity `auto` chose.");
  Describe(a, s.counts);
  a.Optional("certificate", s.certificate, "The run's numerical error.");
  a.Required("files_xxh3", s.files, "Hashes of all files but those that frames.jsonl names.");
  a.Required("data_xxh3", s.data_hash, "Hash of these hashes without that of run.json.");
}

std::vector<KnownFile> ManifestRecord::Files() const {
  std::vector<KnownFile> known;
  for (const auto& [name, hash] : files) known.push_back({name, hash, {}});
  return known;
}

std::vector<std::string> ManifestRecord::ChosenEffects() const {
  return fidelity_choice.is_object() ? fidelity_choice.value("effects", std::vector<std::string>())
                                     : std::vector<std::string>();
}

ManifestRecord ReadManifest(const std::string& text, const std::string& place) {
  return ReadRecord<ManifestRecord>(WithoutManifestHash(text), place);
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

std::string WithoutManifestHash(const std::string& text) {
  const std::size_t begin = FindManifestHash(text);
  if (begin == std::string::npos) return text;
  return text.substr(0, text.rfind(',', begin)) + "\n}\n";
}

void CheckManifestHash(const std::string& text, const std::string& place) {
  const std::size_t begin = FindManifestHash(text);
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

std::string ReadManifestText(const std::filesystem::path& file) {
  const std::string text = ReadFileWhole(file);
  CheckManifestHash(text, ShownPath(file));
  return WithoutManifestHash(text);
}

const std::string& HashOf(std::string_view name,
                          const NamedValues<std::string>& files,
                          const std::filesystem::path& manifest) {
  for (const auto& [known, hash] : files) {
    if (known == name) return hash;
  }
  throw InputError(ShownPath(manifest) + ": /files_xxh3: must name " + ShownText(name));
}

std::string DataHash(const NamedValues<std::string>& files) {
  std::string hashes;
  for (const auto& [name, hash] : files) {
    if (name != kRunFile) hashes += hash;
  }
  return ContentHash(hashes);
}

}  // namespace railcast
