#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <string>

#include "generator/replay/replay_feed.h"
#include "generator/replay/replay_times.h"
#include "railcast/io/recording.h"

namespace railcast {

/// How the frames of a recording are replayed.
struct FrameReplaySpec {
  double pace = 1.0;  ///< How many times faster than recorded.
  /// Frames a second, instead of the recording's stamps; absent = as the stamps say.
  std::optional<double> rate_hz;
  ReplayedFrames frames;
};

/// The frames of a recording with the times at which they are replayed.
class FrameSource {
 public:
  /// @throws InputError if there is no such frame.
  FrameSource(std::unique_ptr<Recording> recording, const FrameReplaySpec& spec);

  [[nodiscard]] const RecordingInfo& info() const { return recording_->info(); }
  /// Of the sensor, or "lidar" if it is not known.
  [[nodiscard]] std::string name() const;

  /// The first frame, before Load().
  [[nodiscard]] const RecordedFrame& first() const { return *next_; }
  /// Reads the next frame. Returns false if there is none.
  /// @throws InputError if it cannot be read, or if it has the stamp of the frame before it.
  [[nodiscard]] bool Load();

  // Of the loaded frame:
  /// With its stamp as it is to be stated.
  [[nodiscard]] const RecordedFrame& StampedFrame();
  [[nodiscard]] std::int64_t begin_ns() const { return begin_ns_; }
  /// Until the next frame begins, but at most a tenth of a second; that, too, where there is none.
  [[nodiscard]] std::int64_t span_ns() const { return span_ns_; }
  /// When something of the frame is to be sent that was recorded so long after its stamp.
  [[nodiscard]] std::int64_t DueNs(std::int64_t since_stamp_ns) const {
    return begin_ns_ + times_.Lasting(since_stamp_ns);
  }

  /// Lets stamps be the times of day at which frames begin.
  /// @param begin_ns When the first one begins, since 1970-01-01 00:00:00 UTC.
  void SetClock(std::int64_t begin_ns) { utc_begin_ns_ = begin_ns; }

 private:
  [[nodiscard]] std::optional<RecordedFrame> Read();

  std::unique_ptr<Recording> recording_;
  FrameReplaySpec spec_;
  ReplayTimes times_;
  std::uint64_t num_read_{};
  std::optional<RecordedFrame> frame_;
  std::optional<RecordedFrame> next_;
  std::int64_t begin_ns_{};
  std::int64_t span_ns_{};
  std::optional<std::int64_t> utc_begin_ns_;
  std::exception_ptr fault_;  ///< Why there is no next frame.
};

}  // namespace railcast
