#pragma once

#include <cstdint>

namespace railcast {

/// When a sensor samples: sample 0 at time 0, and then 1 / rate_hz apart.
[[nodiscard]] std::int64_t SampleTimeNs(std::uint64_t sample, double rate_hz);

/// The samples of a span of time.
struct SampleRange {
  std::uint64_t begin{};
  std::uint64_t end{};  ///< The first one after it.
};

/// The samples from `begin_ns` on and before `end_ns`.
/// @pre 0 <= begin_ns <= end_ns
[[nodiscard]] SampleRange SamplesBetween(std::int64_t begin_ns,
                                         std::int64_t end_ns,
                                         double rate_hz);

}  // namespace railcast
