#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace railcast {

/// A histogram of any number of durations in fixed memory: quantiles are exact to 1 %, the maximum
/// to the nanosecond.
class DurationHistogram {
 public:
  DurationHistogram();

  /// Adds a duration; a negative one counts as 0.
  void Add(std::int64_t duration_ns);

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] std::int64_t max_ns() const { return max_ns_; }
  [[nodiscard]] std::int64_t total_ns() const { return total_ns_; }
  /// Returns the smallest duration that at least this fraction of all does not exceed; 0 if the
  /// histogram is empty.
  [[nodiscard]] std::int64_t QuantileNs(double fraction) const;

 private:
  std::vector<std::uint64_t> bins_;
  std::uint64_t count_ = 0;
  std::int64_t max_ns_ = 0;
  std::int64_t total_ns_ = 0;
};

}  // namespace railcast
