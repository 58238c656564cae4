#include "analysis/estimate/moments.h"

#include <cmath>
#include <limits>

#include "analysis/estimate/estimate.h"

namespace railcast {
void Moments::Add(double sample) {
  if (std::isnan(sample)) return;
  ++num_;
  const double distance = sample - mean_;
  mean_ += distance / static_cast<double>(num_);
  squares_ += distance * (sample - mean_);
}

void Moments::Add(const Moments& other) {
  if (other.num_ == 0) return;
  const auto ours = static_cast<double>(num_);
  const auto theirs = static_cast<double>(other.num_);
  const double distance = other.mean_ - mean_;
  num_ += other.num_;
  mean_ += distance * theirs / (ours + theirs);
  squares_ += other.squares_ + distance * distance * ours * theirs / (ours + theirs);
}

double Moments::PlainMean() const {
  return num_ == 0 ? std::numeric_limits<double>::quiet_NaN() : mean_;
}

Estimate Moments::Mean() const {
  if (num_ < kMinSamples) return NotEnough(num_);
  const auto n = static_cast<double>(num_);
  const double half = StudentQuantile(n - 1.0) * std::sqrt(squares_ / (n - 1.0) / n);
  return {mean_, mean_ - half, mean_ + half, num_};
}

Estimate Moments::StandardDeviation() const {
  if (num_ < kMinSamples) return NotEnough(num_);
  const double degrees = static_cast<double>(num_) - 1.0;
  return ScaleEstimate(std::sqrt(squares_ / degrees), degrees, num_);
}

}  // namespace railcast
