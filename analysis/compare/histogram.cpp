#include "analysis/compare/histogram.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace railcast {
namespace {

constexpr double kBinsAnOctave = 8.0;
constexpr double kLeastIntensity = 0.001;

std::int64_t BinOfIntensity(double intensity) {
  return static_cast<std::int64_t>(
      std::floor(kBinsAnOctave * std::log2(std::max(intensity, kLeastIntensity))));
}

// One term of an entropy in bits: -p log2 p.
double Bits(double share) {
  return share > 0.0 ? -share * std::log2(share) : 0.0;
}

// Visits the bins of both histograms in ascending order: visit(bin, count of a, count of b).
template <typename Visitor>
void ForEachBin(const Histogram& a, const Histogram& b, Visitor&& visit) {
  auto at_a = a.counts().begin();
  auto at_b = b.counts().begin();
  while (at_a != a.counts().end() || at_b != b.counts().end()) {
    const bool is_a =
        at_b == b.counts().end() || (at_a != a.counts().end() && at_a->first <= at_b->first);
    const bool is_b =
        at_a == a.counts().end() || (at_b != b.counts().end() && at_b->first <= at_a->first);
    visit(is_a ? at_a->first : at_b->first, is_a ? at_a->second : 0, is_b ? at_b->second : 0);
    if (is_a) ++at_a;
    if (is_b) ++at_b;
  }
}

}  // namespace

Histogram::Histogram(std::vector<std::int64_t> bins) : num_(bins.size()) {
  std::sort(bins.begin(), bins.end());
  for (const std::int64_t bin : bins) {
    if (counts_.empty() || counts_.back().first != bin) counts_.emplace_back(bin, 0);
    ++counts_.back().second;
  }
}

void Histogram::Add(const Histogram& other) {
  std::vector<std::pair<std::int64_t, std::uint64_t>> sums;
  sums.reserve(std::max(counts_.size(), other.counts_.size()));
  ForEachBin(*this, other, [&](std::int64_t bin, std::uint64_t ours, std::uint64_t theirs) {
    sums.emplace_back(bin, ours + theirs);
  });
  counts_ = std::move(sums);
  num_ += other.num_;
}

double JensenShannonDivergence(const Histogram& a, const Histogram& b) {
  if (a.num() == 0 || b.num() == 0) return std::numeric_limits<double>::quiet_NaN();
  const auto num_a = static_cast<double>(a.num());
  const auto num_b = static_cast<double>(b.num());
  double divergence = 0.0;
  ForEachBin(a, b, [&](std::int64_t, std::uint64_t count_a, std::uint64_t count_b) {
    const double p = static_cast<double>(count_a) / num_a;
    const double q = static_cast<double>(count_b) / num_b;
    divergence += Bits(0.5 * (p + q)) - 0.5 * (Bits(p) + Bits(q));
  });
  return std::clamp(divergence, 0.0, 1.0);
}

void CloudHistograms::Add(const CloudHistograms& other) {
  range.Add(other.range);
  intensity.Add(other.intensity);
  ring.Add(other.ring);
  occupancy.Add(other.occupancy);
}

namespace {

// Points beyond this, as a faulty foreign file may hold, share the last bin.
constexpr float kFarthest_m = 1e6F;

std::int64_t CellOf(float at_m) {
  return static_cast<std::int64_t>(std::floor(std::clamp(at_m, -kFarthest_m, kFarthest_m)));
}

}  // namespace

CloudHistograms HistogramsOf(const ComparedCloud& cloud) {
  std::vector<std::int64_t> ranges, intensities, cells;
  for (const float range_m : cloud.range_m) {
    ranges.push_back(static_cast<std::int64_t>(std::min(range_m, kFarthest_m)));
  }
  for (const float intensity : cloud.intensity) {
    if (std::isfinite(intensity))
      intensities.push_back(BinOfIntensity(static_cast<double>(intensity)));
  }
  for (const pcl::PointXYZ& point : *cloud.points) {
    constexpr std::int64_t kCellsARow = 10'000'000;
    cells.push_back(CellOf(point.y) * kCellsARow + CellOf(point.x));
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return {Histogram(std::move(ranges)), Histogram(std::move(intensities)),
          Histogram(std::vector<std::int64_t>(cloud.rings.begin(), cloud.rings.end())),
          Histogram(std::move(cells))};
}

double IntensityOfBin(std::int64_t bin) {
  return std::exp2((static_cast<double>(bin) + 0.5) / kBinsAnOctave);
}

}  // namespace railcast
