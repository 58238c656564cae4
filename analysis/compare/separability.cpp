#include "analysis/compare/separability.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/estimate/two_sample.h"

namespace railcast {
namespace {

using PairOfPatches = PatchPairs::Pair;
using PatchList = std::vector<Patch> PairOfPatches::*;

// Forests of so many patches grow within seconds; more would hardly narrow the intervals.
constexpr std::size_t kMostPatchesKept = 24'000;

std::uint64_t CountPatches(const std::vector<PairOfPatches>& pairs, PatchList list) {
  std::uint64_t num = 0;
  for (const PairOfPatches& pair : pairs) num += (pair.*list).size();
  return num;
}

// Values of one feature, without those that are missing.
std::vector<double> ValuesOfFeature(const PatchPairs& patches,
                                    PatchList list,
                                    std::size_t feature) {
  std::vector<double> values;
  for (const PairOfPatches& pair : patches.pairs()) {
    for (const Patch& patch : pair.*list) {
      if (std::isfinite(patch.features.at(feature))) {
        values.push_back(static_cast<double>(patch.features.at(feature)));
      }
    }
  }
  return values;
}

TwoSamples SamplesOf(const PatchPairs& patches, const std::vector<std::size_t>& features) {
  TwoSamples samples;
  samples.features.resize(static_cast<Eigen::Index>(patches.num_a() + patches.num_b()),
                          static_cast<Eigen::Index>(features.size()));
  Eigen::Index row = 0;
  for (std::uint32_t group = 0; group < patches.pairs().size(); ++group) {
    for (const PatchList list : {&PairOfPatches::a, &PairOfPatches::b}) {
      for (const Patch& patch : patches.pairs()[group].*list) {
        for (std::size_t i = 0; i < features.size(); ++i) {
          samples.features(row, static_cast<Eigen::Index>(i)) =
              static_cast<double>(patch.features.at(features[i]));
        }
        ++row;
        samples.is_second.push_back(list == &PairOfPatches::b);
        samples.group.push_back(group);
      }
    }
  }
  return samples;
}

// In the order of SamplesOf().
std::vector<std::size_t> RangeBinsOf(const PatchPairs& patches) {
  std::vector<std::size_t> bins;
  for (const PairOfPatches& pair : patches.pairs()) {
    for (const PatchList list : {&PairOfPatches::a, &PairOfPatches::b}) {
      for (const Patch& patch : pair.*list) {
        bins.push_back(BinOf(kBinDistances_m, static_cast<double>(patch.range_m)));
      }
    }
  }
  return bins;
}

std::vector<std::size_t> FeaturesOfBoth(const PatchPairs& patches) {
  std::vector<std::size_t> features;
  for (std::size_t i = 0; i < kNumPatchFeatures; ++i) {
    if (ValuesOfFeature(patches, &PairOfPatches::a, i).empty()) continue;
    if (ValuesOfFeature(patches, &PairOfPatches::b, i).empty()) continue;
    features.push_back(i);
  }
  return features;
}

Separability::Feature DescribedFeature(const PatchPairs& patches,
                                       std::size_t index,
                                       const Estimate& lost) {
  std::vector<double> a = ValuesOfFeature(patches, &PairOfPatches::a, index);
  std::vector<double> b = ValuesOfFeature(patches, &PairOfPatches::b, index);
  return {index, lost, AreaUnderCurve(a, b), Median(a), Median(b)};
}

}  // namespace

void PatchPairs::Add(Pair pair) {
  if (num_seen_++ % stride_ != 0) return;
  pairs_.push_back(std::move(pair));
  if (num_a() + num_b() <= kMostPatchesKept) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs_.size(); i += 2) std::swap(pairs_[kept++], pairs_[i]);
  pairs_.resize(kept);
  stride_ *= 2;
}

std::uint64_t PatchPairs::num_a() const {
  return CountPatches(pairs_, &Pair::a);
}

std::uint64_t PatchPairs::num_b() const {
  return CountPatches(pairs_, &Pair::b);
}

Separability SeparabilityOf(const PatchPairs& patches) {
  Separability told;
  if (std::min(patches.num_a(), patches.num_b()) < Separability::kMinPatches) return told;
  const std::vector<std::size_t> features = FeaturesOfBoth(patches);
  const TwoSamples samples = SamplesOf(patches, features);
  const TwoSampleTest test(samples);
  told.area = test.Area();
  told.balanced_accuracy = test.BalancedAccuracy();
  const std::vector<std::size_t> bins = RangeBinsOf(patches);
  for (std::size_t bin = 0; bin < kNumDistanceBins; ++bin) {
    told.area_by_range.at(bin) = test.Area([&](std::size_t i) { return bins[i] == bin; });
  }
  for (std::size_t i = 0; i < features.size(); ++i) {
    told.features.push_back(DescribedFeature(patches, features[i], test.importances()[i]));
  }
  std::ranges::stable_sort(told.features, std::greater(), [](const Separability::Feature& feature) {
    return feature.lost_area.value;
  });
  std::vector<std::size_t> shape;
  std::ranges::copy_if(features, std::back_inserter(shape),
                       [](std::size_t feature) { return !IsOfIntensity(feature); });
  if (shape.size() < features.size()) {
    const TwoSamples without = SamplesOf(patches, shape);
    told.shape_area = TwoSampleTest(without).Area();
  }
  return told;
}

}  // namespace railcast
