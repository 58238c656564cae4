#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "core/io/net/http_server.h"
#include "generator/live/live_clock.h"
#include "generator/live/live_run.h"

namespace railcast {

/// How a live run is doing, for those who watch over it by HTTP. The run tells it from its thread;
/// any thread may ask.
///
/// `GET /health` gives one line of JSON, with status 200 while the run goes on and 503 otherwise:
///
///     {"status":"running","frames":120,"late_frames":0,"dropped_frames":0,"behind_s":0.0}
///
/// `GET /metrics` gives counters in the text format of Prometheus (version 0.0.4).
class LiveHealth {
 public:
  /// A run that has not been heard of for so long has stalled.
  static constexpr std::int64_t kStalled_ns = 10'000'000'000;
  using Now = std::function<std::int64_t()>;

  /// @param now_ns A clock that never goes back.
  explicit LiveHealth(Now now_ns = [] { return MonotonicClock().NowNs(); });

  /// Frames are made from now on.
  void Begin();
  /// The run goes on, perhaps waiting for commands.
  void Beat();
  void Update(const RunState& state);
  void End();

  [[nodiscard]] HttpAnswer Answer(const HttpRequest& request) const;

 private:
  enum class Phase { kStarting, kRunning, kEnding };
  struct SensorCounts {
    std::string name;
    std::uint64_t frames{}, late_frames{}, dropped_frames{};
    std::int64_t compute_ns{}, max_compute_ns{};
  };

  [[nodiscard]] std::string Status() const;
  [[nodiscard]] std::string Line() const;
  [[nodiscard]] std::string Metrics() const;

  Now now_ns_;
  mutable std::mutex mutex_;
  Phase phase_ = Phase::kStarting;
  std::int64_t heard_ns_{};
  std::int64_t stamp_ns_{}, behind_ns_{};
  std::vector<SensorCounts> sensors_;
};

}  // namespace railcast
