#pragma once

#include <cstdint>
#include <map>
#include <vector>

namespace railcast {

// Sensors round what they measure. Where their step is no smaller than the noise, differences of
// two readings are mostly none, one or two steps: their median says the step, whatever the noise,
// and their variance has a sixth of the squared step in it. What is found here is the standard
// deviation before rounding, by maximum likelihood.
//
// With d the difference of two normal values whose mean may lie anywhere between two steps, the
// readings differ by k steps with the probability E max(0, 1 - |d - k|), d in steps. Where the
// means differ, too (a slope that was taken out), both errors of rounding are independent, and
// their sum, which has a triangular density, is added to d. A value less its expectation, which was
// not rounded, has one such error, of uniform density; counted by whole steps it has the first law.

/// How samples by whole steps came about.
enum class RoundedValues : std::uint8_t {
  kBoth,  ///< A difference of two rounded values.
  kOne,   ///< A rounded value less one that is not.
};

/// Samples of one step.
struct RoundedSamples {
  explicit RoundedSamples(double step_of_samples) : step(step_of_samples) {}
  void Add(double sample, double weight = 1.0);
  void Add(const RoundedSamples& others, double weight = 1.0);

  double step;            ///< > 0.
  double num_on_steps{};  ///< Sum of cos(2 pi sample / step): 1 for whole multiples.
  double num{};           ///< Samples.
  std::map<std::int64_t, double> by_steps;  ///< Number by steps, rounded.
};

/// A standard deviation and its 95 % interval.
struct RoundedScale {
  double value{};
  double low{};
  double high{};
};

/// The standard deviation before rounding (of the difference for kBoth) that samples have in common
/// about their means; those beyond three of it do not count. The interval is that of the
/// likelihood. Where the noise is below 0.55 steps, its upper end is that of means in the middle
/// between two steps, which hide most of it.
/// @pre There is a sample.
[[nodiscard]] RoundedScale FindRoundedScale(const std::vector<RoundedSamples>& samples,
                                            RoundedValues rounded);

/// The step of which at least a quarter of the samples in excess of chance are whole multiples: a
/// peak of their characteristic function beyond its first minimum. 0 if there is none. Looks at
/// 1,000 samples at most.
/// @param samples Differences of neighbouring readings, best small ones.
[[nodiscard]] double FindStep(const std::vector<double>& samples);

}  // namespace railcast
