#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "analysis/estimate/streams.h"
#include "analysis/extras/preset/receiver_figures.h"
#include "railcast/effects.h"

namespace railcast {
namespace {

/// Variance of a gain less the mean of two others, in variances of one.
constexpr double kOfThree = 1.5;

/// By how much a firing of a channel is brighter than the mean of its neighbours' on the same
/// surface, by its logarithm.
struct Brighter {
  std::size_t sector{};
  double log_range{}, by{};
  bool is_level{};  ///< Whether each of the three is at the same range, not only in the mean.
};

std::vector<Brighter> BrighterFirings(const std::vector<SmoothTurn>& turns,
                                      std::size_t below,
                                      std::size_t row,
                                      std::size_t above) {
  constexpr double kSameRange = 0.05;
  std::vector<Brighter> found;
  for (const SmoothTurn& turn : turns) {
    for (std::size_t column = 0; column < turn.scan.columns; ++column) {
      const auto low_column = turn.scan.ColumnBeside(row, column, below);
      const auto high_column = turn.scan.ColumnBeside(row, column, above);
      if (!low_column || !high_column) continue;
      const std::size_t at = turn.At(row, column);
      const std::size_t low = turn.At(below, *low_column);
      const std::size_t high = turn.At(above, *high_column);
      const double by =
          turn.log_intensity[at] - 0.5 * (turn.log_intensity[low] + turn.log_intensity[high]);
      const double range_m = turn.range_m[at];
      const double more_m[] = {turn.range_m[low] - range_m, turn.range_m[high] - range_m};
      const double same_m = kSameRange * range_m;
      if (std::isnan(by) || std::abs(0.5 * (more_m[0] + more_m[1])) > same_m) continue;
      found.push_back({SectorOf(turn.scan, row, column), std::log(range_m), by,
                       std::max(std::abs(more_m[0]), std::abs(more_m[1])) <= same_m});
    }
  }
  return found;
}

/// The medians in even and in odd sectors of 30 deg.
std::array<double, 2> MediansOf(const std::vector<Brighter>& firings) {
  std::array<std::vector<double>, 2> by;
  for (const Brighter& firing : firings) by.at(firing.sector / 3 % 2).push_back(firing.by);
  return {Median(by[0]).value, Median(by[1]).value};
}

/// The sums of least squares of one channel.
struct Products {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  std::uint64_t num{};
};

Products ProductsOf(const std::vector<Brighter>& firings) {
  constexpr double kBin = 0.25 * kGainLogRange;  // Over which gains hardly change.
  std::map<std::pair<std::size_t, double>, std::vector<double>> cells;  // By sector and range.
  for (const Brighter& firing : firings) {
    // Gains of neighbours at other ranges are others, and the variance would not be that of three.
    if (!firing.is_level) continue;
    cells[{firing.sector, std::floor(firing.log_range / kBin)}].push_back(firing.by);
  }
  std::vector<std::pair<std::pair<std::size_t, double>, double>> medians;
  for (auto& [place, by] : cells) {
    if (const Estimate median = Median(by); median.is_enough()) {
      medians.emplace_back(place, median.value);
    }
  }
  Products products;
  for (std::size_t i = 0; i < medians.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const auto& [a, by_a] = medians[i];
      const auto& [b, by_b] = medians[k];
      const std::size_t apart = a.first - b.first;  // As the map sorts.
      if (std::min(apart, kNumSectors - apart) < 2) continue;
      const double x = (a.second - b.second) * kBin / kGainLogRange;
      const Eigen::Vector2d row(1.0, std::exp(-0.5 * x * x));
      products.normal += row * row.transpose();
      products.right += row * (by_a * by_b / kOfThree);
      ++products.num;
    }
  }
  return products;
}

/// One of both parts, with the jackknife over channels.
Estimate PartOf(const std::vector<Products>& channels, Eigen::Index part) {
  std::vector<std::uint64_t> sizes;
  Products all;
  for (const Products& channel : channels) {
    sizes.push_back(channel.num);
    all.normal += channel.normal;
    all.right += channel.right;
  }
  const auto without = [&](std::size_t left_out) {
    Products others = all;
    if (left_out < channels.size()) {
      others.normal -= channels[left_out].normal;
      others.right -= channels[left_out].right;
    }
    const Eigen::Matrix2d& n = others.normal;
    const double determinant = n(0, 0) * n(1, 1) - n(0, 1) * n(0, 1);
    // Pairs that are all equally far apart in range do not tell the parts from each other.
    if (!(determinant > 1e-6 * n(0, 0) * n(0, 0))) return std::numeric_limits<double>::quiet_NaN();
    return (n(1 - part, 1 - part) * others.right[part] - n(0, 1) * others.right[1 - part]) /
           determinant;
  };
  // This estimates the variance, which is as often below 0 as above where there is none.
  Estimate found = EstimateOf(Jackknife(without, sizes));
  for (double* const end : {&found.value, &found.low, &found.high}) {
    *end = std::copysign(std::sqrt(std::abs(*end)), *end);
  }
  return found;
}

/// From the medians in even and in odd sectors, by channel.
Estimate GainOf(const std::vector<std::array<double, 2>>& channels) {
  const auto deviation = [&](std::size_t left_out) {
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
  return EstimateOf(Jackknife(deviation, std::vector<std::uint64_t>(channels.size(), 1)));
}

}  // namespace

void FindChannelGains(const std::vector<SmoothTurn>& turns, ReceiverFigures& figures) {
  const std::vector<double>& elevation_rad = turns.front().scan.elevation_rad;
  std::vector<std::size_t> order;
  for (std::size_t row = 0; row < elevation_rad.size(); ++row) {
    if (!std::isnan(elevation_rad[row])) order.push_back(row);
  }
  std::ranges::sort(order, {}, [&](std::size_t row) { return elevation_rad[row]; });
  std::vector<std::array<double, 2>> medians;
  std::vector<Products> products;
  for (std::size_t i = 1; i + 1 < order.size(); ++i) {
    const auto firings = BrighterFirings(turns, order[i - 1], order[i], order[i + 1]);
    const auto of_halves = MediansOf(firings);
    if (std::isfinite(of_halves[0] + of_halves[1])) medians.push_back(of_halves);
    products.push_back(ProductsOf(firings));
  }
  figures.channel_gain = GainOf(medians);
  figures.gain_at_all_ranges = PartOf(products, 0);
  figures.gain_by_range = PartOf(products, 1);
}

}  // namespace railcast
