#include "core/motion/sample_times.h"

#include <cmath>

#include "core/base/units.h"

namespace railcast {
namespace {

std::uint64_t FirstSampleFrom(std::int64_t time_ns, double rate_hz) {
  const double about = static_cast<double>(time_ns) / static_cast<double>(kNsPerS) * rate_hz;
  auto sample = static_cast<std::uint64_t>(about);
  // The quotient is rounded.
  while (sample > 0 && SampleTimeNs(sample - 1, rate_hz) >= time_ns) --sample;
  while (SampleTimeNs(sample, rate_hz) < time_ns) ++sample;
  return sample;
}

}  // namespace

std::int64_t SampleTimeNs(std::uint64_t sample, double rate_hz) {
  return std::llround(static_cast<double>(sample) * static_cast<double>(kNsPerS) / rate_hz);
}

SampleRange SamplesBetween(std::int64_t begin_ns, std::int64_t end_ns, double rate_hz) {
  return {FirstSampleFrom(begin_ns, rate_hz), FirstSampleFrom(end_ns, rate_hz)};
}

}  // namespace railcast
