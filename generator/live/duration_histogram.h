#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace railcast {

/// How long something took, over any number of times, in fixed memory: quantiles are exact to
/// 1 %, the maximum to the nanosecond.
class DurationHistogram {
 public:
  DurationHistogram();

  /// What is negative counts as 0.
  void Add(std::int64_t duration_ns);

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] std::int64_t max_ns() const { return max_ns_; }
  /// The smallest duration that at least this fraction of all does not exceed; 0 if there is none.
  [[nodiscard]] std::int64_t QuantileNs(double fraction) const;

 private:
  std::vector<std::uint64_t> bins_;
  std::uint64_t count_ = 0;
  std::int64_t max_ns_ = 0;
};

}  // namespace railcast
