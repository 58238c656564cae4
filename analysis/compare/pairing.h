#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "railcast/io/recording.h"

namespace railcast {

/// How frames are paired.
enum class Pairing {
  kIndex,  ///< By position in their recordings.
  kStamp,  ///< By stamp: the nearest, at most half of A's frame spacing apart.
};

struct FramePair {
  RecordedFrame a, b;
};

/// Pairs the frames of two recordings in order of time, each in at most one pair; frames without a
/// partner are counted.
class FramePairs {
 public:
  /// @param pairing By default: by stamp if the stamps of both recordings rise, else by index.
  FramePairs(Recording& a, Recording& b, std::optional<Pairing> pairing);

  /// Returns nothing at the end of both recordings.
  /// @throws InputError as the recordings do.
  [[nodiscard]] std::optional<FramePair> Next();

  [[nodiscard]] Pairing pairing() const { return pairing_; }
  /// Number of frames of A without a partner; complete once Next() has returned nothing.
  [[nodiscard]] std::uint64_t num_alone_a() const { return a_.num_dropped; }
  [[nodiscard]] std::uint64_t num_alone_b() const { return b_.num_dropped; }

 private:
  // One recording with up to two frames read ahead.
  struct Side {
    Recording& recording;
    std::deque<RecordedFrame> frames;
    std::uint64_t num_dropped = 0;

    void Fill();
    RecordedFrame Take();
    void Drop();
    void DropRest();
    [[nodiscard]] std::optional<std::int64_t> Spacing_ns() const;
  };

  [[nodiscard]] std::optional<FramePair> NextByIndex();
  [[nodiscard]] std::optional<FramePair> NextByStamp();

  Side a_, b_;
  Pairing pairing_{};
  std::int64_t tolerance_ns_{};
};

/// "index" or "stamp".
[[nodiscard]] std::string PairingName(Pairing pairing);

}  // namespace railcast
