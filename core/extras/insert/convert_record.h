#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "core/io/run/frame_record.h"
#include "core/scenario/value_type.h"

namespace railcast {

// The files that say what a recording was converted from, and what got lost (docs/convert.md).

/// The ledger of a conversion: a line for each frame, which makes it count as done.
inline constexpr std::string_view kConvertFile = "convert.jsonl";

/// What a format has no place for: "values of ring", and how many there were.
using Losses = std::map<std::string, std::uint64_t>;

/// The content of run.json of a conversion.
struct ConvertRunRecord {
  std::string version;
  std::string recording;  ///< Its path.
  std::string recording_hash;
  std::string kind;  ///< RecordingInfo::kind.
  std::string format;
  std::string fields;
  std::uint32_t first_frame{};
  std::uint32_t num_frames{};
};
void Describe(Archive& a, ConvertRunRecord& s);

/// The content of manifest.json of a conversion.
struct ConvertManifestRecord {
  ConvertRunRecord run{};
  Losses lost{};
  NamedValues<std::string> files{};  ///< The hashes of all files but those of frames.
};
void Describe(Archive& a, ConvertManifestRecord& s);

/// A line of convert.jsonl, which states that a frame is complete.
struct ConvertRecord {
  /// Its number, stamp, files and number of points, and the hash of its other lines.
  FrameRecord frame{};
  Losses lost{};
};
void Describe(Archive& a, ConvertRecord& s);

/// @throws InputError "place: rule" if it is not a line of convert.jsonl. Its hash is not checked.
[[nodiscard]] ConvertRecord ReadConvertLine(std::string_view line, const std::string& place);

/// The frame of a line of convert.jsonl or, by the name of the file, of insert.jsonl.
/// @throws InputError as above.
[[nodiscard]] FrameRecord ReadLedgerLine(std::string_view ledger,
                                         std::string_view line,
                                         const std::string& place);

}  // namespace railcast
