#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/scenario/json_text.h"

namespace railcast {

/// Quantiles in [0, 1) that values have instead of drawn ones, by the names of their draws.
using GivenQuantiles = std::map<std::string, double, std::less<>>;

/// The random numbers of one scenario of a recipe. Each depends on the recipe's seed, the number of
/// the scenario and the name of what is drawn, and on nothing else: a new name moves no other draw.
class KeyedDraws {
 public:
  KeyedDraws(std::uint64_t seed, std::uint32_t scenario, GivenQuantiles given = {})
      : seed_(seed), scenario_(scenario), given_(std::move(given)) {}

  /// Uniform in [0, 1), with 53 bits, or what is given.
  /// @param turn Which of several draws of that name.
  [[nodiscard]] double Unit(std::string_view name, std::uint32_t turn = 0) const;
  /// The quantile that is given for the first draw of a name. What finds no place with it is drawn
  /// as ever on further turns.
  [[nodiscard]] std::optional<double> Given(std::string_view name, std::uint32_t turn) const;
  /// A seed for draws of another kind.
  [[nodiscard]] std::uint64_t Seed(std::string_view name) const;

 private:
  std::uint64_t seed_;
  std::uint32_t scenario_;
  GivenQuantiles given_;
};

/// Uniform in [min, max).
struct UniformDraw {
  double min{};
  double max{};
};

/// A normal distribution, cut off at `min` and `max` where they are given: draws beyond are drawn
/// again.
struct NormalDraw {
  double mean{};
  double sd{};
  std::optional<double> min;
  std::optional<double> max;
};

/// Uniform in the logarithm: as many between 1 and 10 as between 10 and 100.
struct LogUniformDraw {
  double min{};
  double max{};
};

/// Whole numbers from min to max, each as often.
struct IntegerDraw {
  double min{};
  double max{};
};

/// A list of any JSON values.
struct JsonList {
  std::vector<Json> values;
};

/// One weight for each value of a choice; empty: all are equal.
struct ChoiceWeights {
  std::vector<double> values;
};

/// One of several values, which may be objects and lists.
struct ChoiceDraw {
  JsonList values;
  ChoiceWeights weights;
};

/// What a value of a scenario is drawn from.
using Distribution = std::variant<UniformDraw, NormalDraw, LogUniformDraw, IntegerDraw, ChoiceDraw>;

/// Draws a value. Numbers have nine significant digits, so that they do not depend on the last bits
/// of the mathematics library.
/// @param name Of the draw (KeyedDraws).
/// @param turn Counts attempts: each draws anew.
[[nodiscard]] Json DrawValue(const Distribution& distribution,
                             const KeyedDraws& draws,
                             const std::string& name,
                             std::uint32_t turn = 0);

/// The values between which all others lie, or all values of a choice. A normal distribution
/// without bounds has its mean.
[[nodiscard]] std::vector<Json> ExtremesOf(const Distribution& distribution);

/// Index of one of several weights, each in proportion to its value.
/// @pre Their sum is positive.
[[nodiscard]] std::size_t IndexByWeight(const std::vector<double>& weights, double unit);

/// The weights of a choice, as many as values.
[[nodiscard]] std::vector<double> WeightsOf(const ChoiceDraw& choice);

/// Share of a normal distribution between its bounds.
[[nodiscard]] double ShareWithin(const NormalDraw& normal);

}  // namespace railcast
