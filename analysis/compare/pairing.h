#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "core/io/recording/recording.h"

namespace railcast {

/// What makes two frames a pair.
enum class Pairing {
  kIndex,  ///< Their places in their recordings.
  kStamp,  ///< Their stamps: the nearest, no farther apart than half the time between A's frames.
};

struct FramePair {
  RecordedFrame a, b;
};

/// The frames of two recordings two by two, in order of time, each in one pair at most; those
/// without a partner are counted.
class FramePairs {
 public:
  /// @param pairing If not given: by stamp if both recordings' stamps rise, else by index.
  FramePairs(Recording& a, Recording& b, std::optional<Pairing> pairing);

  /// Nothing at the end of both.
  /// @throws InputError as the recordings do.
  [[nodiscard]] std::optional<FramePair> Next();

  [[nodiscard]] Pairing pairing() const { return pairing_; }
  /// Without a partner. Complete when Next() has given nothing.
  [[nodiscard]] std::uint64_t num_alone_a() const { return a_.num_dropped; }
  [[nodiscard]] std::uint64_t num_alone_b() const { return b_.num_dropped; }

 private:
  // The frames at hand of one recording: the next two, if there are so many.
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
