#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace railcast {

/// What a reader of other people's files did not take as it stands, although it went on: left out,
/// bridged, guessed or rounded. RemarkTypes() has their names and texts.
enum class RemarkKind : std::uint8_t {
  // Captures and packets.
  kPacketsLost,
  kPacketsDoubled,
  kPacketsLate,
  kPacketsReordered,
  kPacketsDamaged,
  kPacketsRefused,
  kBlocksEmpty,
  kFragmentsMissing,
  kFramesUnknown,
  kOtherSenders,
  kDatagramsUnknown,
  kRecordingCut,
  // Clouds.
  kPointsBeyondData,
  kSurplusBytes,
  kViewpointUnused,
  kPositionsRounded,
  kPointsWithheld,
  kByteOrderGuessed,
  kFarReturns,
  kTimesRelative,
  kPosesOverturned,
  kUnitsAssumed,
  kFieldsLeftOut,
  kFilesLeftOut,
  // Meshes.
  kMaterialFileMissing,
  kExtensionUnread,
  kAxesMirrored,
  // Maps and heights.
  kNodesMissing,
  kDeletedLeftOut,
  kOutlinesLeftOut,
  kLinesLeftOut,
  kTagsUnread,
  kSpeedsUnread,
  kSpeedsChosen,
  kPlacesJoined,
  kFixesThinned,
  kHeightsUnused,
  kHeightsMissing,
  kHeightsVoid,
  kHeightsFar,
  kPlacesFar,
  // Recordings as a whole.
  kRangesDiffer,
  kLabelsMissing,
  kClocksDiffer,
};

/// What is said of a kind of remark.
struct RemarkType {
  RemarkKind kind{};
  std::string_view name;  ///< Stable, for programs: "packets-damaged".
  /// Follows the number: "packet with a wrong checksum", "packets with a wrong checksum".
  std::string_view one;
  std::string_view several;
  bool is_loss{};  ///< Whether something recorded is missing from what was read.
};

/// The table of all kinds, in the order of RemarkKind.
[[nodiscard]] const std::vector<RemarkType>& RemarkTypes();

/// A remark of a reader.
struct Remark {
  RemarkKind kind{};
  std::string place;         ///< Of the first: "drive.pcap: turn 3". May be empty.
  std::uint64_t number = 1;  ///< How many packets, points, files, ...
  std::string detail{};      ///< Of the first, where the kind alone does not say all: a value.

  [[nodiscard]] const RemarkType& type() const;
  /// "3 packets with a wrong checksum, the first in drive.pcap: turn 3".
  [[nodiscard]] std::string Text() const;
  bool operator==(const Remark&) const = default;
};

/// Appends a remark, or adds its number to the one of its kind that is there.
void AddRemark(const Remark& remark, std::vector<Remark>& remarks);

/// Collects the remarks of one source: one for each kind, with the sum of the numbers and the first
/// place, in the order of RemarkKind. Any thread may add to it. What it holds goes to the receiver
/// of remarks (below) when it is destroyed.
///
///     RemarkLog log;
///     log.Add({.kind = RemarkKind::kPacketsDamaged, .place = "drive.pcap: turn 3"});
///     for (const Remark& remark : log.List()) std::cerr << remark.Text() << "\n";
class RemarkLog {
 public:
  RemarkLog() = default;
  RemarkLog(const RemarkLog&) = delete;
  RemarkLog& operator=(const RemarkLog&) = delete;
  ~RemarkLog();

  /// @param order Of the place: the least of a kind is its first, whichever thread comes first.
  ///   What is added again for the same order replaces what was there, as when a frame is read
  ///   twice.
  void Add(const Remark& remark, std::uint64_t order = 0);
  /// Adds what another log of the same source holds.
  void AddAll(const RemarkLog& other);
  [[nodiscard]] std::vector<Remark> List() const;

 private:
  mutable std::mutex mutex_;
  std::map<std::pair<RemarkKind, std::uint64_t>, Remark> remarks_;
};

/// Receives the remarks of every RemarkLog that is destroyed, and those of Publish().
using RemarkReceiver = std::function<void(const Remark&)>;

/// Sets the receiver of this process; there is none at first. To be called before others read.
void SetRemarkReceiver(RemarkReceiver receiver);
/// Hands a remark to the receiver, for readers that have no RemarkLog.
void Publish(const Remark& remark);

}  // namespace railcast
