#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/certify/certified_figures.h"
#include "core/io/run/frame_record.h"
#include "core/io/run/sequence_files.h"
#include "core/scenario/json_text.h"
#include "core/scenario/value_type.h"

namespace railcast {

// The files with which a sequence directory describes itself as a whole (docs/files.md).

/// A file that the scenario names.
struct InputRecord {
  std::string name;
  std::string hash;
  /// Name of its copy's folder; empty where that is the file's own hash.
  std::string folder{};

  bool operator==(const InputRecord&) const = default;
};
void Describe(Archive& a, InputRecord& s);

/// The bag that holds a run's clouds.
struct BagRecord {
  std::string path;                 ///< Relative to the directory.
  std::vector<std::string> topics;  ///< Topics of the clouds.
  std::string lines{};              ///< Name of the file with its hashes; empty before 1.0.

  bool operator==(const BagRecord&) const = default;
};
void Describe(Archive& a, BagRecord& s);

/// The content of run.json, which identifies the run. Differences between two runs are looked for
/// in the order of its members, since another seed or another content of a file also changes the
/// scenario's hash.
struct RunRecord {
  std::string version;
  std::string embree;
  std::string isa;
  std::uint64_t seed{};
  std::vector<InputRecord> inputs{};
  std::string scenario_hash{};
  std::string commands_hash{};  ///< Empty if the run replays none.
  std::string format{};
  std::string
      fields{};  ///< Its points' fields, as `--fields` says them; empty if the format has others.
  std::optional<BagRecord> bag{};
  std::string trace{};  ///< The OSI trace that has a message for each frame; empty = none.
  std::vector<std::string> motion_sensors{};  ///< Each has a file of samples (MotionFileName()).
  std::uint32_t start_frame{};
  std::uint32_t num_frames{};
  std::optional<std::uint32_t> stride_if_not_1{};
  std::optional<double> certify{};  ///< Share of the time that certificates may take.

  /// From one frame's number to the next.
  [[nodiscard]] std::uint32_t stride() const { return stride_if_not_1.value_or(1); }
  /// The scenario, its inputs and the commands.
  [[nodiscard]] std::vector<KnownFile> Files() const;
};
void Describe(Archive& a, RunRecord& s);

/// @throws InputError "place: rule" if the text is not a run.json.
[[nodiscard]] RunRecord ReadRun(const std::string& text, const std::string& place);

/// The content of manifest.json, which states that the run is complete and lists its files.
struct ManifestRecord {
  std::string version;
  std::uint64_t seed{};
  std::string format{};
  std::uint32_t start_frame{};
  std::uint32_t num_frames{};
  Json fidelity_choice{};  ///< What fidelity `auto` chose; null at another fidelity.
  FrameCounts counts{};
  std::optional<RunCertificate> certificate{};  ///< If the run is certified.
  /// The hashes of all files except those of the frames, which frames.jsonl names.
  NamedValues<std::string> files{};
  std::string data_hash{};

  [[nodiscard]] std::vector<KnownFile> Files() const;
  /// Names of the effects that fidelity `auto` chose; empty at another fidelity.
  [[nodiscard]] std::vector<std::string> ChosenEffects() const;
};
void Describe(Archive& a, ManifestRecord& s);

/// Reads a manifest.json of a run; its own hash is not checked.
/// @throws InputError "place: rule" if the text is none.
[[nodiscard]] ManifestRecord ReadManifest(const std::string& text, const std::string& place);

/// Returns the text of manifest.json with its last member added: manifest_xxh3, the hash of the
/// text before it. It is needed because some of a manifest's content is recorded nowhere else.
/// @param json The other members, each on lines of its own.
[[nodiscard]] std::string WithManifestHash(const std::string& json);

/// The text as it was before WithManifestHash(), if it has a hash.
[[nodiscard]] std::string WithoutManifestHash(const std::string& text);

/// @throws InputError "place: rule" if a manifest differs in any byte from what WithManifestHash()
///   returned.
void CheckManifestHash(const std::string& text, const std::string& place);

/// The text of a manifest of any kind of folder as it was before WithManifestHash().
/// @throws InputError if it cannot be read, or is not as it was written.
[[nodiscard]] std::string ReadManifestText(const std::filesystem::path& file);

/// The hash that a manifest states of a file.
/// @param manifest Names the manifest in errors.
/// @throws InputError if it does not name the file.
[[nodiscard]] const std::string& HashOf(std::string_view name,
                                        const NamedValues<std::string>& files,
                                        const std::filesystem::path& manifest);

/// Returns the data_hash of files: the hash of their hashes, leaving out run.json, which names the
/// program that made them.
[[nodiscard]] std::string DataHash(const NamedValues<std::string>& files);

}  // namespace railcast
