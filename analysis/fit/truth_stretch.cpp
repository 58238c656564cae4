#include "analysis/fit/truth_stretch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/detect/beam_optics.h"

namespace railcast {
namespace {

constexpr double kMaxDoubt = 0.02;
constexpr double kMaxDisagreement = 0.2;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool AreSame(const Frame& frame, std::size_t a, std::size_t b) {
  return frame.material[a] == frame.material[b] && frame.label[a] == frame.label[b] &&
         frame.instance[a] == frame.instance[b] && frame.outcome[b] != Outcome::kClutter &&
         !std::isnan(frame.true_range_m[b]);
}

/// d(1 / R) / d(angle), to the left and up, 1 / (m rad); NaN where no neighbour is on the surface.
struct Slopes {
  double across{};
  double up{};
};

/// Differences of 1 / R over the angle to the next firings, their mean.
class Difference {
 public:
  Difference(const Frame& frame, std::size_t slot) : frame_(frame), slot_(slot) {}

  /// @param angle_rad From the firing to the other; NaN or 0 = it is no neighbour.
  void Add(std::size_t other, double angle_rad) {
    if (std::isnan(angle_rad) || angle_rad == 0.0 || !AreSame(frame_, slot_, other)) return;
    sum_ += (InverseRange(other) - InverseRange(slot_)) / angle_rad;
    ++num_;
  }
  [[nodiscard]] double mean() const { return num_ == 0 ? kNaN : sum_ / num_; }

 private:
  [[nodiscard]] double InverseRange(std::size_t slot) const {
    return 1.0 / static_cast<double>(frame_.true_range_m[slot]);
  }

  const Frame& frame_;
  std::size_t slot_;
  double sum_{};
  int num_{};
};

Slopes SlopesAt(const Frame& frame, std::size_t slot, const ScanTable& scan) {
  const std::size_t row = slot / frame.width();
  const std::size_t column = slot % frame.width() / frame.returns;
  const auto beside_rad = [&](std::size_t other) {
    return (scan.column_azimuth_rad[other] - scan.column_azimuth_rad[column]) *
           std::cos(scan.elevation_rad[row]);
  };
  const auto above_rad = [&](std::size_t other) {
    const double angle_rad = scan.elevation_rad[other] - scan.elevation_rad[row];
    // A row that looks elsewhere sideways is no neighbour.
    const double aside_rad = scan.row_azimuth_rad[other] - scan.row_azimuth_rad[row];
    return std::abs(aside_rad) < 0.1 * std::abs(angle_rad) ? angle_rad : kNaN;
  };
  Difference across(frame, slot);
  if (column > 0) across.Add(slot - frame.returns, beside_rad(column - 1));
  if (column + 1 < frame.columns) across.Add(slot + frame.returns, beside_rad(column + 1));
  Difference up(frame, slot);
  if (row > 0) up.Add(slot - frame.width(), above_rad(row - 1));
  if (row + 1 < frame.rows) up.Add(slot + frame.width(), above_rad(row + 1));
  return {across.mean(), up.mean()};
}

}  // namespace

TruthStretch::TruthStretch(const BeamSpec& beam, const ScanTable* scan)
    : sigma_h_rad_(HorizontalSigma_rad(beam)),
      sigma_v_rad_(VerticalSigma_rad(beam)),
      pulse_sigma_m_(PulseSigma_m(beam)),
      scan_(scan) {}

double TruthStretch::At(const Frame& frame, std::size_t slot) const {
  const auto range_m = static_cast<double>(frame.true_range_m[slot]);
  const double slant_m = range_m * std::tan(static_cast<double>(frame.incidence_rad[slot]));
  const auto left = [&](double sigma_rad) {
    return pulse_sigma_m_ / std::hypot(pulse_sigma_m_, slant_m * sigma_rad);
  };
  const double low = left(std::max(sigma_h_rad_, sigma_v_rad_));
  const double high = left(std::min(sigma_h_rad_, sigma_v_rad_));
  const double fallback = high - low <= kMaxDoubt * high ? 0.5 * (low + high) : kNaN;
  if (scan_ == nullptr || scan_->rows != frame.rows || scan_->columns != frame.columns) {
    return fallback;
  }
  const Slopes slopes = SlopesAt(frame, slot, *scan_);
  const double all = std::hypot(slopes.across, slopes.up);
  // Not on one plane, or not known: NaN is near nothing.
  if (!(std::abs(range_m * range_m * all - slant_m) < kMaxDisagreement * slant_m)) return fallback;
  return left(std::hypot(sigma_h_rad_ * slopes.across, sigma_v_rad_ * slopes.up) / all);
}

}  // namespace railcast
