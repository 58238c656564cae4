#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "railcast/io/recording.h"

namespace railcast {

struct BagRecord;
struct Cloud;
struct SequenceSummary;
struct Verification;

/// A kind of recordings that an extra adds.
struct RecordingKind {
  /// Returns null if `source` is none of the kind.
  /// @throws InputError as OpenRecording().
  using Open = std::unique_ptr<Recording> (*)(const std::filesystem::path& source);

  std::string (*help)();                ///< Names it in help: ".pcap capture of VLP-16 or QT64".
  std::string_view option;              ///< Picks one of what it holds: "--sensor".
  std::vector<std::string> extensions;  ///< Extensions of its files, as messages name them.
  /// Whether a source is of the kind, by its name or by what it holds.
  bool (*is_of)(const std::filesystem::path& source);
  Open open;                 ///< A file or a directory.
  Open open_more = nullptr;  ///< A file that has more behind its name; asked before all else.
  Open open_part = nullptr;  ///< A part of a file; asked if nothing has the name of `source`.
  /// Returns what stands behind the name of a copy, with its colon; null: the same as behind that
  /// of the recording.
  /// @param folder Holds the copy, and those of the files that `behind` names.
  /// @param behind What stands behind the recording's name and its colon.
  std::string (*behind_copy)(const std::filesystem::path& folder,
                             const std::string& behind) = nullptr;
};

/// A cloud in a bag, as it is stored.
struct CloudInBag {
  std::string bag;  ///< As messages name it.
  std::vector<std::byte> bytes;
  /// @throws InputError "rule (got value)" if they are no cloud.
  Cloud (*parse)(std::span<const std::byte> bytes) = nullptr;
};

/// What a line of frames.jsonl says of the clouds or the message that a bag or a trace holds of the
/// frame.
struct CloudsOfFrame {
  std::int64_t stamp_ns{};
  std::string hash;   ///< ContentHash() of its messages, one after another.
  std::string place;  ///< Place of the line: "out/frames.jsonl:3".
};

/// Returns what one line after another says; nothing at the end.
using NextClouds = std::function<std::optional<CloudsOfFrame>()>;

/// A sensor in a capture, and the numbers of its packets as PacketOrder and TurnReader count them.
struct SensorPackets {
  std::filesystem::path capture;
  std::string name;
  std::string address;
  std::string ports;  ///< The ports that they went to.
  std::uint64_t taken{}, lost{}, doubled{}, reordered{}, late{}, damaged{}, refused{};
};

/// What extras add to the kinds of recordings, and to what is known of a run's files. What this
/// build lacks is null.
struct RecordingExtras {
  std::vector<RecordingKind> kinds;

  /// Opens a directory of a recording that something was put into; null if it is none.
  /// @throws InputError as OpenRecording().
  RecordingKind::Open open_inserted = nullptr;

  /// As VerifyFolder(), by the extras whose folders these verify (kFilesOfExtras).
  std::map<std::string_view,
           Verification (*)(const std::filesystem::path& directory,
                            const std::function<void(double)>& on_progress)>
      verify;

  /// Counts the packets of each sensor in a capture; empty if `source` is none.
  /// @throws InputError if it cannot be read.
  std::vector<SensorPackets> (*count_packets)(const std::filesystem::path& source) = nullptr;

  /// Opens the clouds of a run's bag, which has one for each of the run's frames; each call of what
  /// is returned returns the next one.
  /// @throws InputError "bag: rule" if they cannot be put into the slots of the scan, or if there
  ///   is no further one.
  std::function<CloudInBag()> (*clouds_of_bag)(const SequenceSummary& summary) = nullptr;

  /// Compares a bag with its lines, if it has any, and its clouds with those of a run's frames.
  /// @param next_frame Returns what one frame after another says.
  /// @param is_finished Whether the run is: then the bag must be complete.
  /// @param faults Gets a line for all that differs.
  /// @throws InputError if the bag cannot be read.
  void (*verify_bag)(const std::filesystem::path& bag,
                     const BagRecord& record,
                     const NextClouds& next_frame,
                     bool is_finished,
                     ErrorList& faults) = nullptr;

  /// Compares the messages of an OSI trace with a run's frames.
  /// @param is_finished Whether the run is: otherwise the trace may hold a frame more, and end
  ///   within a message.
  /// @param faults Gets a line for each frame whose message is missing or another, and for what
  ///   belongs to no frame.
  /// @throws InputError if the trace cannot be opened.
  void (*verify_trace)(const std::filesystem::path& trace,
                       const NextClouds& next_frame,
                       bool is_finished,
                       ErrorList& faults) = nullptr;

  /// All that this build has.
  [[nodiscard]] static const RecordingExtras& Get();

  /// Whether a source is of the kind whose parts an option picks.
  [[nodiscard]] bool IsOf(std::string_view option, const std::filesystem::path& source) const {
    return std::ranges::any_of(kinds, [&](const RecordingKind& kind) {
      return kind.option == option && kind.is_of(source);
    });
  }
};

/// @param source As OpenRecording() takes it, which need not be there.
/// @throws InputError if it has files that an extra reads which this build lacks.
void CheckExtraIsThere(const std::filesystem::path& source);

/// Returns what an extra adds.
/// @param file What it is needed for.
/// @throws InputError if this build does not have it.
template <typename Function>
[[nodiscard]] Function* NeedExtra(Function* added,
                                  const std::filesystem::path& file,
                                  const std::string& extra) {
  if (added != nullptr) return added;
  throw LacksExtra(ShownPath(file), extra);
}

}  // namespace railcast
