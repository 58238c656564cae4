#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/datagrams.h"
#include "core/io/net/udp.h"

namespace railcast {

/// When what was recorded is to be sent: as long after the beginning as in the recording, or in a
/// share of that.
///
/// Where recorded times go back by up to a second, as network cards that have several queues note
/// them, what is late is sent at once. Where they go back further, a clock was set or recordings
/// were put together: what follows is sent at once, and the times count on from there. Pauses are
/// kept.
class ReplayTimes {
 public:
  static constexpr std::int64_t kOvertaken_ns = 1'000'000'000;

  /// @param pace How many times faster than recorded; above 0.
  explicit ReplayTimes(double pace) : pace_(pace) {}

  /// Returns when what was recorded at a time is to be sent: 0 for the first, and never less than
  /// before.
  [[nodiscard]] std::int64_t Of(std::int64_t recorded_ns);
  /// Returns how long a duration in the recording takes.
  [[nodiscard]] std::int64_t Lasting(std::int64_t duration_ns) const;

 private:
  double pace_;
  std::optional<std::int64_t> latest_ns_;  ///< The latest recorded time.
  double since_ns_{};                      ///< When that is sent.
};

/// Which frames of a recording are replayed.
struct ReplayedFrames {
  std::uint64_t start{};               ///< Frames that are left out before the first.
  std::optional<std::uint64_t> count;  ///< Absent = to the end.
};

/// The error where a recording ends before the first frame that is wanted.
/// @param source The recording, as messages name it.
[[nodiscard]] inline InputError NoSuchFrame(const std::string& source, std::uint64_t start) {
  if (start == 0) return InputError(source + ": must hold a frame (got none)");
  return InputError("--start-frame: must be the number of a frame of " + source + Got(start));
}

/// What a replay sends, frame by frame, and where it goes. Times are in ns since the replay began.
class ReplayFeed {
 public:
  virtual ~ReplayFeed() = default;

  [[nodiscard]] virtual std::string name() const = 0;
  /// What is sent where, for the user: "VLP-16: packets to 127.0.0.1:2368".
  [[nodiscard]] virtual std::string Description() const = 0;
  /// What it sends, as the summary calls it.
  [[nodiscard]] virtual std::string_view sends() const { return "datagrams"; }

  /// Lets what is sent state the time of day, if it is not sent as recorded.
  /// @param begin_ns When the first frame begins, since 1970-01-01 00:00:00 UTC.
  /// @pre No frame was taken.
  virtual void SetClock(std::int64_t begin_ns) { static_cast<void>(begin_ns); }

  /// Reads the next frame. Returns false if there is none.
  /// @throws InputError with one line if it cannot be read.
  [[nodiscard]] virtual bool Load() = 0;
  /// When the loaded frame begins.
  [[nodiscard]] virtual std::int64_t begin_ns() const = 0;
  /// Moves the loaded frame's datagrams to `datagrams`, which is empty.
  virtual void Take(Datagrams& datagrams) = 0;

  /// May be called from another thread than the functions above.
  virtual void Send(const Datagrams& datagrams, std::span<const Datagrams::Item> items) = 0;
  /// Waits for what was sent to arrive, where that can be known.
  virtual void Finish() {}
  /// @pre Nothing is being sent.
  [[nodiscard]] virtual UdpSender::Counts delivered() const = 0;
  /// What of the recording was not sent, in one line; empty if there is nothing.
  [[nodiscard]] virtual std::string LeftOut() const { return ""; }
};

}  // namespace railcast
