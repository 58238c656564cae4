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

/// Something in a file that a reader did not take as it stands, although it went on reading: it was
/// left out, bridged, guessed or rounded. RemarkTypes() has the names and texts of all kinds.
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
  kValuesRounded,
  kPointsWithheld,
  kByteOrderGuessed,
  kFarReturns,
  kTimesRelative,
  kPosesOverturned,
  kPosesBridged,
  kPosesJumped,
  kPosesUnknown,
  kTransformsLeftOut,
  kTransformsInvalid,
  kTransformsElsewhere,
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
  kRangesUnknown,
  kLabelsMissing,
  kClocksDiffer,
  kClocksShifted,
  kSpansOverlap,
};

/// The name and the texts of a kind of remark.
struct RemarkType {
  RemarkKind kind{};
  std::string_view name;  ///< Stable, for programs: "packets-damaged".
  /// Text after the number: "packet with a wrong checksum", "packets with a wrong checksum".
  std::string_view one;
  std::string_view several;
  bool is_loss{};  ///< Whether something recorded is missing from what was read.
};

/// The table of all kinds, in the order of RemarkKind.
[[nodiscard]] const std::vector<RemarkType>& RemarkTypes();

/// A remark of a reader.
struct Remark {
  RemarkKind kind{};
  std::string place;         ///< Where the first one is: "drive.pcap: turn 3". May be empty.
  std::uint64_t number = 1;  ///< How many packets, points, files, ...
  std::string detail{};      ///< A value of the first one, if the kind alone does not say all.

  [[nodiscard]] const RemarkType& type() const;
  /// "3 packets with a wrong checksum, the first in drive.pcap: turn 3".
  [[nodiscard]] std::string Text() const;
  bool operator==(const Remark&) const = default;
};

/// Adds the number of `remark` to the one of the same kind in `remarks`, or appends `remark`.
void AddRemark(const Remark& remark, std::vector<Remark>& remarks);

/// Collects the remarks of one source. List() has one for each kind, with the sum of the numbers
/// and the first place, in the order of RemarkKind. Thread-safe. When the log is destroyed, that
/// list goes to the receiver of remarks (SetRemarkReceiver()).
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

  /// @param order Where the place is in the source, such as a frame's number: the lowest of a kind
  ///   is its first place, whichever thread adds it first. A remark replaces an earlier one of the
  ///   same kind and order, so that a frame that is read twice counts once.
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

/// Sets the receiver of this process; there is none at first. Call it before anything is read.
void SetRemarkReceiver(RemarkReceiver receiver);
/// Hands a remark to the receiver, for readers that have no RemarkLog.
void Publish(const Remark& remark);

}  // namespace railcast
