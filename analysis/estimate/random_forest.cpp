#include "analysis/estimate/two_sample.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/base/random.h"

namespace railcast {
namespace {

// More trees only bring the scores nearer to their limit (Breiman 2001, theorem 1.2).
constexpr std::uint32_t kNumTrees = 100;
constexpr std::size_t kNumForestBins = 64;
constexpr std::size_t kLeastInLeaf = 5;

// The samples with each feature replaced by the bin between two of its quantiles.
struct BinnedSamples {
  std::vector<std::vector<double>> edges;       // For each feature, rising.
  std::vector<std::vector<std::uint8_t>> bins;  // By feature, then sample.
  const std::vector<bool>& is_second;
};

// Values up to and including edges[i] are in bin i or below; NaN is in bin 0.
std::uint8_t BinOfValue(const std::vector<double>& edges, double value) {
  if (std::isnan(value)) return 0;
  return static_cast<std::uint8_t>(std::ranges::lower_bound(edges, value) - edges.begin());
}

std::vector<double> QuantileEdges(const Eigen::MatrixXd& x, Eigen::Index feature) {
  std::vector<double> values;
  for (Eigen::Index row = 0; row < x.rows(); ++row) {
    if (!std::isnan(x(row, feature))) values.push_back(x(row, feature));
  }
  std::ranges::sort(values);
  std::vector<double> edges;
  // The first edge is below all numbers and parts them from what is missing.
  if (values.size() < static_cast<std::size_t>(x.rows())) {
    edges.push_back(std::numeric_limits<double>::lowest());
  }
  const std::size_t num_quantiles = kNumForestBins - 1 - edges.size();
  for (std::size_t i = 1; i <= num_quantiles && !values.empty(); ++i) {
    const double value = values[i * (values.size() - 1) / (num_quantiles + 1)];
    if (edges.empty() || value > edges.back()) edges.push_back(value);
  }
  return edges;
}

BinnedSamples BinAll(const Eigen::MatrixXd& x, const std::vector<bool>& is_second) {
  BinnedSamples samples{{}, {}, is_second};
  for (Eigen::Index feature = 0; feature < x.cols(); ++feature) {
    samples.edges.push_back(QuantileEdges(x, feature));
    std::vector<std::uint8_t> bins;
    bins.reserve(static_cast<std::size_t>(x.rows()));
    for (Eigen::Index row = 0; row < x.rows(); ++row) {
      bins.push_back(BinOfValue(samples.edges.back(), x(row, feature)));
    }
    samples.bins.push_back(std::move(bins));
  }
  return samples;
}

// Whole numbers from 0 to below a limit, by key.
class Draws {
 public:
  Draws(std::uint64_t seed, std::uint32_t tree) : seed_(seed), tree_(tree) {}

  std::size_t Below(std::size_t limit) {
    if (num_used_ == words_.size()) {
      words_ = RandomWords(seed_, RandomUse::kForestDraw, tree_, num_blocks_++);
      num_used_ = 0;
    }
    constexpr unsigned kWordBits = 32;
    return (std::uint64_t{words_.at(num_used_++)} * limit) >> kWordBits;
  }

 private:
  std::uint64_t seed_;
  std::uint32_t tree_;
  std::uint32_t num_blocks_ = 0;
  std::array<std::uint32_t, 4> words_{};
  std::size_t num_used_ = 4;
};

struct ClassCounts {
  double first{};
  double second{};

  void Add(const ClassCounts& other) {
    first += other.first;
    second += other.second;
  }
  [[nodiscard]] double num() const { return first + second; }
  // What Gini's impurity lacks to the largest possible, times the number: greater is purer.
  [[nodiscard]] double Purity() const { return (first * first + second * second) / num(); }
};

struct Split {
  int feature = -1;
  std::size_t edge{};
  double purity{};
};

// Samples of a node: indices, which may repeat.
using Drawn = std::span<std::uint32_t>;

ClassCounts CountOf(const BinnedSamples& samples, Drawn drawn) {
  ClassCounts counts;
  for (const std::uint32_t index : drawn) {
    (samples.is_second[index] ? counts.second : counts.first) += 1.0;
  }
  return counts;
}

void ImproveSplit(const BinnedSamples& samples, Drawn drawn, std::size_t feature, Split& best) {
  std::array<ClassCounts, kNumForestBins> counts{};
  const std::vector<std::uint8_t>& bins = samples.bins[feature];
  for (const std::uint32_t index : drawn) {
    ClassCounts& count = counts.at(bins[index]);
    (samples.is_second[index] ? count.second : count.first) += 1.0;
  }
  const ClassCounts all = CountOf(samples, drawn);
  ClassCounts below;
  for (std::size_t edge = 0; edge < samples.edges[feature].size(); ++edge) {
    below.Add(counts.at(edge));
    const ClassCounts above{all.first - below.first, all.second - below.second};
    constexpr auto kLeast = static_cast<double>(kLeastInLeaf);
    if (below.num() < kLeast || above.num() < kLeast) continue;
    const double purity = below.Purity() + above.Purity();
    if (purity > best.purity) best = {static_cast<int>(feature), edge, purity};
  }
}

// The best split of a few random features, or none that makes the node purer.
Split FindSplit(const BinnedSamples& samples, Drawn drawn, Draws& draws) {
  const ClassCounts counts = CountOf(samples, drawn);
  // Rounding must not pass for an improvement.
  constexpr double kLeastGain = 1e-9;
  Split best{-1, 0, counts.Purity() + kLeastGain * counts.num()};
  if (counts.first == 0.0 || counts.second == 0.0) return best;
  std::vector<std::size_t> features(samples.edges.size());
  std::iota(features.begin(), features.end(), std::size_t{0});
  const auto num_tried = static_cast<std::size_t>(std::sqrt(static_cast<double>(features.size())));
  for (std::size_t i = 0; i < num_tried; ++i) {
    std::swap(features[i], features[i + draws.Below(features.size() - i)]);
    ImproveSplit(samples, drawn, features[i], best);
  }
  return best;
}

std::vector<std::uint32_t> DrawBalanced(const std::vector<bool>& is_second, Draws& draws) {
  std::array<std::vector<std::uint32_t>, 2> members;
  for (std::size_t i = 0; i < is_second.size(); ++i) {
    members.at(is_second[i] ? 1 : 0).push_back(static_cast<std::uint32_t>(i));
  }
  const std::size_t num_each = std::min(members[0].size(), members[1].size());
  std::vector<std::uint32_t> drawn;
  for (const std::vector<std::uint32_t>& of_class : members) {
    for (std::size_t i = 0; i < num_each; ++i)
      drawn.push_back(of_class[draws.Below(of_class.size())]);
  }
  return drawn;
}

RandomForest::Tree GrowTree(const BinnedSamples& samples, Draws draws) {
  struct Unsplit {
    std::size_t node;
    Drawn drawn;
  };
  std::vector<std::uint32_t> indices = DrawBalanced(samples.is_second, draws);
  RandomForest::Tree tree(1);
  std::vector<Unsplit> open = {{0, indices}};
  while (!open.empty()) {
    const auto [node, drawn] = open.back();
    open.pop_back();
    const Split split = FindSplit(samples, drawn, draws);
    if (split.feature < 0) {
      const ClassCounts counts = CountOf(samples, drawn);
      tree[node].second_share = counts.second / counts.num();
      continue;
    }
    const auto feature = static_cast<std::size_t>(split.feature);
    const auto above = std::ranges::stable_partition(
        drawn, [&](std::uint32_t index) { return samples.bins[feature][index] <= split.edge; });
    const auto num_below = drawn.size() - above.size();
    const auto child = static_cast<std::uint32_t>(tree.size());
    tree[node] = {split.feature, samples.edges[feature][split.edge], child, 0.0};
    tree.resize(tree.size() + 2);
    open.push_back({child, drawn.first(num_below)});
    open.push_back({child + std::size_t{1}, drawn.subspan(num_below)});
  }
  return tree;
}

double ShareInLeaf(const RandomForest::Tree& tree, const Eigen::MatrixXd& x, Eigen::Index row) {
  const RandomForest::Node* node = tree.data();
  while (node->feature >= 0) {
    const bool is_above = x(row, node->feature) > node->threshold;  // NaN is not.
    node = &tree[node->child + (is_above ? 1U : 0U)];
  }
  return node->second_share;
}

}  // namespace

RandomForest::RandomForest(const Eigen::MatrixXd& x,
                           const std::vector<bool>& is_second,
                           std::uint64_t seed)
    : trees_(kNumTrees) {
  const auto num_second = std::ranges::count(is_second, true);
  Check(static_cast<std::size_t>(x.rows()) == is_second.size() && num_second > 0 &&
            num_second < x.rows(),
        "a row for each sample, and samples of both classes");
  const BinnedSamples samples = BinAll(x, is_second);
  tbb::parallel_for(std::uint32_t{0}, kNumTrees, [&](std::uint32_t tree) {
    trees_[tree] = GrowTree(samples, Draws(seed, tree));
  });
}

std::vector<double> RandomForest::Scores(const Eigen::MatrixXd& x) const {
  std::vector<double> scores(static_cast<std::size_t>(x.rows()));
  tbb::parallel_for(Eigen::Index{0}, x.rows(), [&](Eigen::Index row) {
    double sum = 0.0;
    for (const Tree& tree : trees_) sum += ShareInLeaf(tree, x, row);
    scores[static_cast<std::size_t>(row)] = sum / static_cast<double>(trees_.size());
  });
  return scores;
}

}  // namespace railcast
