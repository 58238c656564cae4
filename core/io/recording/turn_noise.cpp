#include "core/io/recording/turn_noise.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/base/median.h"
#include "core/base/rounded_scale.h"
#include "core/io/recording/column_finder.h"
#include "core/io/recording/plausibility.h"
#include "core/io/recording/range_step.h"
#include "core/io/recording/sensor_axes.h"
#include "core/io/recording/surface_point.h"

namespace railcast {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

using BySector = std::array<std::vector<double>, kNumSectors>;

/// Squares of samples, sorted, with the sector of each.
struct SortedSquares {
  explicit SortedSquares(const BySector& samples) {
    for (std::size_t sector = 0; sector < samples.size(); ++sector) {
      for (const double sample : samples.at(sector)) {
        squares.emplace_back(sample * sample, sector);
      }
      sizes.push_back(samples.at(sector).size());
    }
    std::ranges::sort(squares);
  }

  /// The mean of a share of the squares, the smaller ones, without those of a sector.
  [[nodiscard]] double MeanWithout(std::size_t left_out, double share) const {
    const std::size_t num_left = squares.size() - (left_out < sizes.size() ? sizes[left_out] : 0);
    const auto num = static_cast<std::size_t>(share * static_cast<double>(num_left));
    double sum = 0.0;
    std::size_t num_summed = 0;
    for (const auto& [square, sector] : squares) {
      if (num_summed == num) break;
      if (sector == left_out) continue;
      sum += square;
      ++num_summed;
    }
    return num == 0 ? 0.0 : sum / static_cast<double>(num);
  }

  std::vector<std::pair<double, std::size_t>> squares;
  std::vector<std::uint64_t> sizes;  ///< Sizes of the sectors.
};

/// The deviation of one of two returns by their differences, less that of others.
TurnNoise::Deviations DeviationOf(const BySector& differences, const BySector& less = {}) {
  constexpr double kShare = 0.9;
  constexpr double kOfNormal = 0.7893;  // Root mean square of the smaller 90 % of normal samples.
  const SortedSquares all(differences);
  const SortedSquares noise(less);
  const auto estimate = [&](double share, double of_normal) {
    const auto without = [&](std::size_t left_out) {
      const double rest = all.MeanWithout(left_out, share) - noise.MeanWithout(left_out, share);
      return std::sqrt(0.5 * std::max(0.0, rest)) / of_normal;
    };
    return Jackknife(without, all.sizes);
  };
  return {estimate(kShare, kOfNormal), estimate(1.0, 1.0)};
}

/// The deviation of one of two returns where readings come in steps that are no smaller than it.
/// @param steps By sector and sample.
JackknifedFigure RoundedDeviationOf(const BySector& differences, const BySector& steps) {
  constexpr double kWidth = 0.1;  // In the logarithm of steps that are taken together.
  using Groups = std::map<std::int64_t, RoundedSamples>;
  std::array<Groups, kNumSectors> sectors;
  Groups all;
  std::map<std::int64_t, double> sum_of_steps;
  std::vector<std::uint64_t> sizes;
  const auto in = [&](Groups& groups, std::int64_t group) -> RoundedSamples& {
    const double step = std::exp(kWidth * static_cast<double>(group));
    return groups.try_emplace(group, step).first->second;
  };
  for (std::size_t sector = 0; sector < kNumSectors; ++sector) {
    for (std::size_t i = 0; i < differences.at(sector).size(); ++i) {
      const double step = steps.at(sector)[i];
      const std::int64_t group = std::llround(std::log(step) / kWidth);
      sum_of_steps[group] += step;
      RoundedSamples& of = in(sectors.at(sector), group);
      of.Add(differences.at(sector)[i] / step * of.step);
    }
    for (const auto& [group, samples] : sectors.at(sector)) in(all, group).Add(samples);
    sizes.push_back(differences.at(sector).size());
  }
  // Samples are counted by steps of their own, which are those of their group on average.
  for (auto& [group, samples] : all) samples.step = sum_of_steps[group] / samples.num;
  const auto scale_without = [&](std::size_t left_out) {
    std::vector<RoundedSamples> rest;
    for (const auto& [group, samples] : all) {
      rest.push_back(samples);
      if (left_out >= kNumSectors) continue;
      const auto found = sectors.at(left_out).find(group);
      if (found != sectors.at(left_out).end()) rest.back().Add(found->second, -1.0);
    }
    return FindRoundedScale(rest, RoundedValues::kBoth);
  };
  JackknifedFigure figure = Jackknife(
      [&](std::size_t left_out) { return scale_without(left_out).value / std::numbers::sqrt2; },
      sizes);
  if (std::isnan(figure.value)) return figure;
  // What the steps hide may be more than what differs from sector to sector.
  constexpr double kErrors = 1.96 * std::numbers::sqrt2;  // In half a 95 % interval.
  const RoundedScale scale = scale_without(kNumSectors);
  const double half = std::max(scale.high - scale.value, scale.value - scale.low);
  figure.error = std::max(figure.error, half / kErrors);
  return figure;
}

/// Takes the deviation before rounding for the robust one, where steps are so coarse that they
/// change it by 0.4 % or more, and all turns have them.
void SeeThroughSteps(const BySector& differences,
                     const BySector& steps,
                     TurnNoise::Deviations& deviations) {
  std::vector<double> all;
  for (std::size_t sector = 0; sector < kNumSectors; ++sector) {
    if (steps.at(sector).size() != differences.at(sector).size()) return;
    all.insert(all.end(), steps.at(sector).begin(), steps.at(sector).end());
  }
  constexpr double kFine = 0.3;  // As a share of the deviation.
  if (!(MedianOf(all) >= kFine * deviations.robust.value)) return;
  deviations.robust = RoundedDeviationOf(differences, steps);
}

SmoothTurn SmoothTurnOf(const RecordedFrame& recorded, const ScanTable& scan) {
  constexpr double kSpread_m = 0.03;
  constexpr double kLeastIntensity = 0.05;
  const Frame& frame = recorded.frame;
  SmoothTurn turn{scan};
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
  /// What one step of the readings is in these differences; empty if they have none.
  BySector in_band_step, range_step_m;

  void Add(const SmoothTurn& earlier, const SmoothTurn& later) {
    constexpr double kSame_m = 0.1;
    const ScanTable& scan = later.scan;
    const ColumnFinder finder(earlier.scan);
    const double step_m = StepOfValues(later.range_m, kSame_m);
    const double step = IntensityStep(later);
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
        const bool is_in_band = mean >= 0.12 && mean <= 0.25;
        if (is_in_band) in_band.at(sector).push_back(times * (after - before));
        intensity.at(sector).push_back(times * (after - before));
        range_m.at(sector).push_back(times * apart_m);
        if (is_in_band && step > 0.0) in_band_step.at(sector).push_back(times * step / mean);
        if (step_m > 0.0) range_step_m.at(sector).push_back(times * step_m);
      }
    }
  }
  static double IntensityStep(const SmoothTurn& turn) {
    constexpr double kSame = 0.1;
    std::vector<double> intensities;
    for (const double of : turn.log_intensity) intensities.push_back(std::exp(of));
    return StepOfValues(intensities, kSame);
  }

  /// Whether whole sectors came nearer or went away: by more than 5 mm, root mean square.
  [[nodiscard]] bool HasMoved() const {
    constexpr double kMost_m = 0.005;
    double squares_m2 = 0.0;
    double num = 0.0;
    for (const auto& samples : range_m) {
      if (samples.size() < JackknifedFigure::kLeastParts) continue;
      squares_m2 += std::pow(
          std::reduce(samples.begin(), samples.end()) / static_cast<double>(samples.size()), 2);
      num += 1.0;
    }
    return squares_m2 > kMost_m * kMost_m * num;
  }
};

/// Differences of two firings of a ring on one smooth surface, of each one for each lag.
struct TextureDifferences {
  std::array<BySector, kTextureLags_m.size()> differences;
  std::array<double, kTextureLags_m.size()> sum_range_m{};

  void Add(const SmoothTurn& turn) {
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
          sum_range_m.at(lag) += turn.range_m[at];
          differences.at(lag++).at(SectorOf(scan, row, column)).push_back(difference);
        }
      }
    }
  }
};

}  // namespace

std::vector<RecordedFrame> WholeTurns(Recording& recording, std::size_t most_frames) {
  constexpr double kWhole = 0.9;
  std::vector<RecordedFrame> turns;
  std::uint32_t most = 0;
  while (turns.size() < most_frames) {
    const auto read = recording.Next();
    if (!read) break;
    turns.push_back((*read)());
    NeedRanges(turns.back());
    TurnToSpinAxes(turns.back().frame);
    most = std::max(most, turns.back().frame.columns);
  }
  std::erase_if(turns, [&](const RecordedFrame& turn) {
    return !turn.is_grid || turn.frame.columns < kWhole * most;
  });
  return turns;
}

std::size_t SectorOf(const ScanTable& scan, std::size_t row, std::size_t column) {
  const double azimuth_rad = scan.column_azimuth_rad[column] + scan.row_azimuth_rad[row];
  if (std::isnan(azimuth_rad)) return 0;
  const double share = WrappedAngle_rad(azimuth_rad) / (2.0 * std::numbers::pi) + 0.5;
  return std::min(kNumSectors - 1,
                  static_cast<std::size_t>(share * static_cast<double>(kNumSectors)));
}

JackknifedFigure Jackknife(const std::function<double(std::size_t)>& without,
                           const std::vector<std::uint64_t>& sizes) {
  JackknifedFigure figure;
  double mean = 0.0;
  double squares = 0.0;
  for (std::size_t part = 0; part < sizes.size(); ++part) {
    figure.num += sizes[part];
    const double value = sizes[part] == 0 ? kNone : without(part);
    if (std::isnan(value)) continue;
    const double distance = value - mean;
    mean += distance / static_cast<double>(++figure.num_parts);
    squares += distance * (value - mean);
  }
  if (figure.num_parts < JackknifedFigure::kLeastParts) return figure;
  const auto parts = static_cast<double>(figure.num_parts);
  figure.error = std::sqrt(squares / (parts - 1.0)) * (parts - 1.0) / std::sqrt(parts);
  figure.value = without(sizes.size());
  return figure;
}

GridTurns GridsOf(const std::vector<RecordedFrame>& turns) {
  GridTurns grids;
  for (const RecordedFrame& turn : turns) {
    const auto scan = MakeScanTable(turn.frame);
    if (!scan || (!grids.scans.empty() && scan->rows != grids.scans.front().rows)) continue;
    grids.frames.push_back(&turn);
    grids.scans.push_back(*scan);
  }
  return grids;
}

std::vector<SmoothTurn> SmoothTurnsOf(const GridTurns& turns) {
  std::vector<SmoothTurn> smooth;
  for (std::size_t i = 0; i < turns.scans.size(); ++i) {
    smooth.push_back(SmoothTurnOf(*turns.frames[i], turns.scans[i]));
  }
  return smooth;
}

TurnNoise FindTurnNoise(const std::vector<SmoothTurn>& turns) {
  TurnDifferences differences;
  TextureDifferences texture;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    texture.Add(turns[i]);
    if (i > 0) differences.Add(turns[i - 1], turns[i]);
  }
  TurnNoise noise;
  noise.has_moved = differences.HasMoved();
  if (noise.has_moved) differences = {};
  noise.intensity = DeviationOf(differences.in_band);
  SeeThroughSteps(differences.in_band, differences.in_band_step, noise.intensity);
  noise.range_m = DeviationOf(differences.range_m);
  SeeThroughSteps(differences.range_m, differences.range_step_m, noise.range_m);
  for (std::size_t lag = 0; lag < noise.texture.size(); ++lag) {
    noise.texture.at(lag) = DeviationOf(texture.differences.at(lag), differences.intensity);
    noise.texture_range_m.at(lag) =
        texture.sum_range_m.at(lag) / static_cast<double>(noise.texture.at(lag).rms.num);
  }
  return noise;
}

}  // namespace railcast
