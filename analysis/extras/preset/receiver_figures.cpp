#include "analysis/extras/preset/receiver_figures.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "analysis/estimate/streams.h"
#include "analysis/stats/column_finder.h"
#include "analysis/stats/holes.h"
#include "analysis/stats/plane_patches.h"

namespace railcast {
namespace {

using BySector = std::array<std::vector<double>, kNumSectors>;

/// The root mean square of a share of the magnitudes, the smaller ones, without those of a sector.
double RmsWithout(const BySector& samples, std::size_t left_out, double share) {
  std::vector<double> squares;
  for (std::size_t sector = 0; sector < samples.size(); ++sector) {
    if (sector == left_out) continue;
    for (const double sample : samples.at(sector)) squares.push_back(sample * sample);
  }
  const auto num = static_cast<std::size_t>(share * static_cast<double>(squares.size()));
  const auto end = squares.begin() + static_cast<std::ptrdiff_t>(num);
  std::nth_element(squares.begin(), end, squares.end());
  double sum = 0.0;
  std::for_each(squares.begin(), end, [&](double square) { sum += square; });
  return num == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(num));
}

/// The deviation of one of two returns by their differences, less that of others.
TwoDeviations DeviationOf(const BySector& differences, const BySector& less = {}) {
  constexpr double kShare = 0.9;
  constexpr double kOfNormal = 0.7893;  // Root mean square of the smaller 90 % of normal samples.
  std::vector<std::uint64_t> sizes;
  for (const auto& samples : differences) sizes.push_back(samples.size());
  const auto estimate = [&](double share, double of_normal) {
    const auto without = [&](std::size_t left_out) {
      const double all = RmsWithout(differences, left_out, share);
      const double noise = RmsWithout(less, left_out, share);
      return std::sqrt(0.5 * std::max(0.0, all * all - noise * noise)) / of_normal;
    };
    return Jackknife(without, sizes);
  };
  return {estimate(kShare, kOfNormal), estimate(1.0, 1.0)};
}

/// The first returns of a turn, by row x columns + column; NaN where there is none on a surface.
struct Turn {
  const ScanTable& scan;
  std::vector<Vector3> position_m{};
  std::vector<double> range_m{};
  std::vector<double> log_intensity{};  ///< NaN also where the surface is not smooth.

  [[nodiscard]] std::size_t At(std::size_t row, std::size_t column) const {
    return row * scan.columns + column;
  }
};

Turn TurnOf(const RecordedFrame& recorded, const ScanTable& scan) {
  constexpr double kSpread_m = 0.03;
  constexpr double kLeastIntensity = 0.05;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const Frame& frame = recorded.frame;
  Turn turn{scan};
  for (std::size_t slot = 0; slot < frame.num_slots(); slot += frame.returns) {
    turn.position_m.emplace_back(
        Eigen::Vector3f(frame.x[slot], frame.y[slot], frame.z[slot]).cast<double>());
    const bool is_there = HasSurfacePoint(recorded, slot);
    turn.range_m.push_back(is_there ? static_cast<double>(frame.range_m[slot]) : kNone);
    const auto intensity = static_cast<double>(frame.intensity[slot]);
    const bool counts = intensity >= kLeastIntensity && intensity <= 1.0;
    turn.log_intensity.push_back(counts ? std::log(intensity) : kNone);
  }
  for (std::size_t cell = 0; cell < turn.range_m.size(); ++cell) {
    const std::size_t column = cell % scan.columns;
    double rest_m2 = kNone;
    if (column >= 4 && column + 4 < scan.columns) {
      const Eigen::Map<const Eigen::Array<double, 9, 1>> range_m(&turn.range_m[cell - 4]);
      const double slope = (range_m * Eigen::Array<double, 9, 1>::LinSpaced(-4.0, 4.0)).sum();
      rest_m2 = (range_m - range_m.mean()).square().sum() - slope * slope / 60.0;
    }
    // Negated so that NaN fails, too.
    if (!(rest_m2 <= 7.0 * kSpread_m * kSpread_m)) turn.log_intensity[cell] = kNone;
  }
  return turn;
}

/// Differences of paired firings of two turns.
struct TurnDifferences {
  BySector in_band, intensity, range_m;

  void Add(const Turn& earlier, const Turn& later) {
    constexpr double kSame_m = 0.1;
    const ScanTable& scan = later.scan;
    const ColumnFinder finder(earlier.scan);
    for (std::size_t column = 0; column < scan.columns; ++column) {
      const double azimuth_rad = scan.column_azimuth_rad[column];
      if (std::isnan(azimuth_rad)) continue;
      const auto found = finder.Nearest(azimuth_rad);
      if (!found || std::abs(found->offset_rad) > 0.5 * scan.column_step_rad) continue;
      const std::vector<double>& azimuths_rad = earlier.scan.column_azimuth_rad;
      if (found->column == 0 || found->column + 1 >= azimuths_rad.size()) continue;
      const double ahead_rad =
          WrappedAngle_rad(azimuths_rad[found->column + 1] - azimuths_rad[found->column]);
      const bool is_ahead = found->offset_rad * ahead_rad > 0.0;
      const std::size_t beside = is_ahead ? found->column + 1 : found->column - 1;
      const double share = std::abs(found->offset_rad / ahead_rad);
      const auto between = [&](double here, double there) {
        return (1.0 - share) * here + share * there;
      };
      // The noise of what is between two returns is less than that of one.
      const double times = std::sqrt(2.0 / (1.0 + share * share + (1.0 - share) * (1.0 - share)));
      for (std::size_t row = 0; row < scan.rows; ++row) {
        const std::size_t at = earlier.At(row, found->column);
        const std::size_t next = earlier.At(row, beside);
        const std::size_t now = later.At(row, column);
        const double before = between(earlier.log_intensity[at], earlier.log_intensity[next]);
        const double after = later.log_intensity[now];
        const double apart_m =
            later.range_m[now] - between(earlier.range_m[at], earlier.range_m[next]);
        if (std::isnan(before + after) || std::abs(apart_m) > kSame_m) continue;
        const std::size_t sector = SectorOf(scan, row, column);
        const double mean = 0.5 * (std::exp(before) + std::exp(after));
        if (mean >= 0.12 && mean <= 0.25) in_band.at(sector).push_back(times * (after - before));
        intensity.at(sector).push_back(times * (after - before));
        range_m.at(sector).push_back(times * apart_m);
      }
    }
  }
  /// Whether whole sectors came nearer or went away: by more than 5 mm, root mean square.
  [[nodiscard]] bool HasMoved() const {
    constexpr double kMost_m = 0.005;
    double squares_m2 = 0.0;
    double num = 0.0;
    for (const auto& samples : range_m) {
      if (samples.size() < kMinSamples) continue;
      squares_m2 += std::pow(
          std::reduce(samples.begin(), samples.end()) / static_cast<double>(samples.size()), 2);
      num += 1.0;
    }
    return squares_m2 > kMost_m * kMost_m * num;
  }
};

/// Adds differences of two firings of a ring on one smooth surface, of each one for each lag.
void AddTexture(const Turn& turn, std::array<BySector, kTextureLags_m.size()>& differences) {
  constexpr double kTolerance = 1.2;
  const ScanTable& scan = turn.scan;
  for (std::size_t row = 0; row < scan.rows; ++row) {
    for (std::size_t column = 0; column < scan.columns; ++column) {
      const std::size_t at = turn.At(row, column);
      std::size_t lag = 0;
      for (std::size_t other = at + 1; other < turn.At(row + 1, 0); ++other) {
        const double difference = turn.log_intensity[other] - turn.log_intensity[at];
        if (std::isnan(difference)) break;
        const double apart_m = (turn.position_m[other] - turn.position_m[at]).norm();
        while (lag < differences.size() && apart_m > kTextureLags_m.at(lag) * kTolerance) ++lag;
        if (lag == differences.size()) break;
        if (apart_m < kTextureLags_m.at(lag) / kTolerance) continue;
        differences.at(lag++).at(SectorOf(scan, row, column)).push_back(difference);
      }
    }
  }
}

/// By how much a channel is brighter than the mean of its neighbours, the median in even and in odd
/// sectors of 30 deg.
std::array<double, 2> BrighterBy(const std::vector<Turn>& turns,
                                 std::size_t below,
                                 std::size_t row,
                                 std::size_t above) {
  constexpr double kSameRange = 0.05;
  std::array<std::vector<double>, 2> differences;
  for (const Turn& turn : turns) {
    for (std::size_t column = 0; column < turn.scan.columns; ++column) {
      const auto low_column = turn.scan.ColumnBeside(row, column, below);
      const auto high_column = turn.scan.ColumnBeside(row, column, above);
      if (!low_column || !high_column) continue;
      const std::size_t at = turn.At(row, column);
      const std::size_t low = turn.At(below, *low_column);
      const std::size_t high = turn.At(above, *high_column);
      const double difference =
          turn.log_intensity[at] - 0.5 * (turn.log_intensity[low] + turn.log_intensity[high]);
      const double apart_m = turn.range_m[at] - 0.5 * (turn.range_m[low] + turn.range_m[high]);
      if (std::isnan(difference) || std::abs(apart_m) > kSameRange * turn.range_m[at]) continue;
      differences.at(SectorOf(turn.scan, row, column) / 3 % 2).push_back(difference);
    }
  }
  return {Median(differences[0]).value, Median(differences[1]).value};
}

Estimate ChannelGain(const std::vector<Turn>& turns) {
  const std::vector<double>& elevation_rad = turns.front().scan.elevation_rad;
  std::vector<std::size_t> order;
  for (std::size_t row = 0; row < elevation_rad.size(); ++row) {
    if (!std::isnan(elevation_rad[row])) order.push_back(row);
  }
  std::ranges::sort(order, {}, [&](std::size_t row) { return elevation_rad[row]; });
  std::vector<std::array<double, 2>> channels;
  for (std::size_t i = 1; i + 1 < order.size(); ++i) {
    const auto medians = BrighterBy(turns, order[i - 1], order[i], order[i + 1]);
    if (std::isfinite(medians[0] + medians[1])) channels.push_back(medians);
  }
  const auto deviation = [&](std::size_t left_out) {
    constexpr double kOfThree = 1.5;  // Variance of a gain less the mean of two others.
    Moments even, odd, sum;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      if (i == left_out) continue;
      even.Add(channels[i][0]);
      odd.Add(channels[i][1]);
      sum.Add(channels[i][0] + channels[i][1]);
    }
    const auto variance = [](const Moments& of) {
      return std::pow(of.StandardDeviation().value, 2);
    };
    const double covariance = 0.5 * (variance(sum) - variance(even) - variance(odd));
    return std::sqrt(std::max(0.0, covariance) / kOfThree);
  };
  return Jackknife(deviation, std::vector<std::uint64_t>(channels.size(), 1));
}

}  // namespace

std::size_t SectorOf(const ScanTable& scan, std::size_t row, std::size_t column) {
  const double azimuth_rad = scan.column_azimuth_rad[column] + scan.row_azimuth_rad[row];
  if (std::isnan(azimuth_rad)) return 0;
  const double share = WrappedAngle_rad(azimuth_rad) / (2.0 * std::numbers::pi) + 0.5;
  return std::min(kNumSectors - 1,
                  static_cast<std::size_t>(share * static_cast<double>(kNumSectors)));
}

Estimate Jackknife(const std::function<double(std::size_t)>& without,
                   const std::vector<std::uint64_t>& sizes) {
  std::uint64_t num = 0;
  Moments moments;
  for (std::size_t part = 0; part < sizes.size(); ++part) {
    num += sizes[part];
    if (sizes[part] > 0) moments.Add(without(part));
  }
  if (moments.num() < kMinSamples) return NotEnough(num);
  const auto parts = static_cast<double>(moments.num());
  const double error = moments.StandardDeviation().value * (parts - 1.0) / std::sqrt(parts);
  const double value = without(sizes.size());
  const double half = StudentQuantile(parts - 1.0) * error;
  return {value, value - half, value + half, num};
}

ReceiverFigures FindReceiverFigures(const std::vector<RecordedFrame>& turns) {
  Holes holes;
  std::vector<const RecordedFrame*> grids;
  std::vector<ScanTable> scans;
  for (const RecordedFrame& turn : turns) {
    holes.Add(turn);
    const auto scan = MakeScanTable(turn.frame);
    if (!scan || (!scans.empty() && scan->rows != scans.front().rows)) continue;
    grids.push_back(&turn);
    scans.push_back(*scan);
  }
  ReceiverFigures figures;
  figures.holes = holes.Share();
  if (grids.empty()) return figures;
  std::vector<Turn> seen;
  TurnDifferences differences;
  std::array<BySector, kTextureLags_m.size()> texture;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    seen.push_back(TurnOf(*grids[i], scans[i]));
    AddTexture(seen.back(), texture);
    if (i > 0) differences.Add(seen[i - 1], seen[i]);
  }
  figures.has_moved = differences.HasMoved();
  if (figures.has_moved) differences = {};
  figures.intensity_noise = DeviationOf(differences.in_band);
  figures.range_noise_m = DeviationOf(differences.range_m);
  for (std::size_t lag = 0; lag < texture.size(); ++lag) {
    figures.texture.at(lag) = DeviationOf(texture.at(lag), differences.intensity);
  }
  figures.channel_gain = ChannelGain(seen);
  figures.jumps = FindJumpLosses(grids, scans);
  return figures;
}

}  // namespace railcast
