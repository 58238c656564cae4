#include "core/extras/recipe/distribution.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/base/error.h"
#include "core/base/random.h"

namespace railcast {
namespace {

/// FNV-1a, 64 bits (Fowler, Noll, Vo), over the name and then the bytes of `turn`.
std::uint64_t HashOfName(std::string_view name, std::uint32_t turn) {
  constexpr std::uint64_t kOffset = 0xcbf29ce484222325U;
  constexpr std::uint64_t kPrime = 0x100000001b3U;
  std::uint64_t hash = kOffset;
  for (const char letter : name) hash = (hash ^ static_cast<unsigned char>(letter)) * kPrime;
  for (int i = 0; i < 4; ++i) hash = (hash ^ ((turn >> (8 * i)) & 0xFFU)) * kPrime;
  return hash;
}

std::uint64_t WordsOfName(std::uint64_t seed,
                          std::uint32_t scenario,
                          std::string_view name,
                          std::uint32_t turn) {
  const std::uint64_t hash = HashOfName(name, turn);
  const std::array<std::uint32_t, 4> words =
      RandomWords(seed, RandomUse::kDatasetDraw, scenario, static_cast<std::uint32_t>(hash),
                  static_cast<std::uint32_t>(hash >> 32U));
  return (std::uint64_t{words[0]} << 32U) | words[1];
}

double RoundedDraw(double value) {
  constexpr int kSignificantDigits = 9;
  std::array<char, 40> text{};
  const auto written = std::to_chars(text.data(), text.data() + text.size(), value,
                                     std::chars_format::scientific, kSignificantDigits - 1);
  double rounded = 0.0;
  std::from_chars(text.data(), written.ptr, rounded);
  return rounded;
}

// By halving: shares of a normal distribution have no closed inverse.
double NormalAt(const NormalDraw& normal, double quantile) {
  constexpr int kNumHalvings = 60;
  constexpr double kFarthest = 10.0;  // Standard deviations.
  double low = normal.min.value_or(normal.mean - kFarthest * normal.sd);
  double high = normal.max.value_or(normal.mean + kFarthest * normal.sd);
  const double share = quantile * ShareWithin(normal);
  for (int i = 0; i < kNumHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    const bool is_below = ShareWithin({normal.mean, normal.sd, normal.min, middle}) < share;
    (is_below ? low : high) = middle;
  }
  return RoundedDraw(high);
}

double DrawNormal(const NormalDraw& normal,
                  const KeyedDraws& draws,
                  const std::string& name,
                  std::uint32_t turn) {
  // The least share within the bounds is a thousandth, so that this many draws never suffice only
  // once in 1e43.
  constexpr std::uint32_t kMostTries = 100'000;
  if (const auto quantile = draws.Given(name, turn)) return NormalAt(normal, *quantile);
  const double min = normal.min.value_or(-std::numeric_limits<double>::infinity());
  const double max = normal.max.value_or(std::numeric_limits<double>::infinity());
  for (std::uint32_t i = 0; i < kMostTries; ++i) {
    // Box and Muller (1958).
    const std::string of_try = name + "\n" + std::to_string(i);
    const double radius = std::sqrt(-2.0 * std::log1p(-draws.Unit(of_try + "\nradius", turn)));
    const double angle_rad = 2.0 * std::numbers::pi * draws.Unit(of_try + "\nangle", turn);
    const double value = RoundedDraw(normal.mean + normal.sd * radius * std::cos(angle_rad));
    if (value >= min && value <= max) return value;
  }
  Check(false, "bounds leave a thousandth of a normal distribution");
  return normal.mean;
}

/// Draws from one distribution.
struct Drawing {
  const KeyedDraws& draws;
  const std::string& name;
  std::uint32_t turn;

  Json operator()(const UniformDraw& uniform) const {
    return RoundedDraw(uniform.min + (uniform.max - uniform.min) * draws.Unit(name, turn));
  }
  Json operator()(const NormalDraw& normal) const { return DrawNormal(normal, draws, name, turn); }
  Json operator()(const LogUniformDraw& log) const {
    return RoundedDraw(log.min * std::pow(log.max / log.min, draws.Unit(name, turn)));
  }
  Json operator()(const IntegerDraw& whole) const {
    const double num = whole.max - whole.min + 1.0;
    return static_cast<std::int64_t>(whole.min + std::floor(num * draws.Unit(name, turn)));
  }
  Json operator()(const ChoiceDraw& choice) const {
    return choice.values.values[IndexByWeight(WeightsOf(choice), draws.Unit(name, turn))];
  }
};

/// Lists the extremes of one distribution.
struct Extremes {
  std::vector<Json> operator()(const UniformDraw& uniform) const {
    return {RoundedDraw(uniform.min), RoundedDraw(uniform.max)};
  }
  std::vector<Json> operator()(const NormalDraw& normal) const {
    std::vector<Json> values;
    if (normal.min) values.emplace_back(*normal.min);
    if (normal.max) values.emplace_back(*normal.max);
    if (values.empty()) values.emplace_back(normal.mean);
    return values;
  }
  std::vector<Json> operator()(const LogUniformDraw& log) const {
    return {RoundedDraw(log.min), RoundedDraw(log.max)};
  }
  std::vector<Json> operator()(const IntegerDraw& whole) const {
    return {static_cast<std::int64_t>(whole.min), static_cast<std::int64_t>(whole.max)};
  }
  std::vector<Json> operator()(const ChoiceDraw& choice) const { return choice.values.values; }
};

}  // namespace

std::optional<double> KeyedDraws::Given(std::string_view name, std::uint32_t turn) const {
  const auto found = turn == 0 ? given_.find(name) : given_.end();
  return found == given_.end() ? std::nullopt : std::optional(found->second);
}

double KeyedDraws::Unit(std::string_view name, std::uint32_t turn) const {
  if (const auto given = Given(name, turn)) return *given;
  return static_cast<double>(WordsOfName(seed_, scenario_, name, turn) >> 11U) * 0x1p-53;
}

std::uint64_t KeyedDraws::Seed(std::string_view name) const {
  return WordsOfName(seed_, scenario_, name, 0);
}

Json DrawValue(const Distribution& distribution,
               const KeyedDraws& draws,
               const std::string& name,
               std::uint32_t turn) {
  return std::visit(Drawing{draws, name, turn}, distribution);
}

std::vector<Json> ExtremesOf(const Distribution& distribution) {
  return std::visit(Extremes(), distribution);
}

std::vector<double> WeightsOf(const ChoiceDraw& choice) {
  if (!choice.weights.values.empty()) return choice.weights.values;
  return std::vector<double>(choice.values.values.size(), 1.0);
}

std::size_t IndexByWeight(const std::vector<double>& weights, double unit) {
  double left = unit * std::accumulate(weights.begin(), weights.end(), 0.0);
  std::size_t last = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] <= 0.0) continue;
    last = i;
    if (left < weights[i]) return i;
    left -= weights[i];
  }
  return last;  // Reached by rounding only.
}

double ShareWithin(const NormalDraw& normal) {
  const auto below = [&](double value) {
    return 0.5 * std::erfc((normal.mean - value) / (normal.sd * std::numbers::sqrt2));
  };
  const double to = normal.max ? below(*normal.max) : 1.0;
  const double from = normal.min ? below(*normal.min) : 0.0;
  return to - from;
}

}  // namespace railcast
