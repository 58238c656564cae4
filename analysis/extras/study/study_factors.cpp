#include "analysis/extras/study/study_factors.h"

#include <nlohmann/json.hpp>

#include <Eigen/Core>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <functional>
#include <iomanip>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "analysis/detectability/detection_probability.h"
#include "analysis/estimate/logistic_model.h"
#include "core/base/text.h"

namespace railcast {
namespace {

constexpr std::size_t kMostLevels = 12;

/// A factor's values by observation; nothing where it is not drawn.
using Values = std::vector<std::optional<Json>>;

std::string DrawnValueText(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::map<std::string, Values> DrawnValues(const std::vector<Observation>& observations) {
  std::map<std::string, Values> values;
  const auto put = [&](const std::string& name, std::size_t i, const Json& value) {
    if (name.ends_with("seed")) return;
    Values& of_name = values[name];
    of_name.resize(observations.size());
    of_name[i] = value;
  };
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const Observation& each = observations[i];
    put(kTarget, i, each.object->Target());
    put("base", i, each.approach->base);
    for (const auto& [name, value] : each.approach->drawn) put(name, i, value);
    for (const auto& [name, value] : each.object->drawn) put("object " + name, i, value);
  }
  return values;
}

bool AreNumbers(const Values& values) {
  return std::ranges::all_of(
      values, [](const std::optional<Json>& value) { return !value || value->is_number(); });
}

std::size_t NumDistinct(const Values& values) {
  std::set<std::string> texts;
  for (const auto& value : values)
    texts.insert(value ? DrawnValueText(*value) : std::string(kNotDrawn));
  return texts.size();
}

void UseLevels(const std::vector<std::string>& texts, Factor& factor) {
  std::set<std::string> distinct(texts.begin(), texts.end());
  factor.levels.assign(distinct.begin(), distinct.end());
  for (const std::string& text : texts) {
    factor.level_of.push_back(static_cast<std::size_t>(
        std::ranges::lower_bound(factor.levels, text) - factor.levels.begin()));
  }
}

// To three digits.
std::string RoundedNumber(double value) {
  std::ostringstream text;
  text << std::setprecision(3) << value;
  return NumberText(std::stod(text.str()));
}

// Thirds of the numbers, and what is not drawn.
void UseThirds(const Values& values, Factor& factor) {
  std::vector<double> sorted;
  for (const auto& value : values) {
    if (value) sorted.push_back(value->get<double>());
  }
  std::ranges::sort(sorted);
  const double first = sorted[sorted.size() / 3];
  const double second = sorted[2 * sorted.size() / 3];
  factor.levels = {RoundedNumber(sorted.front()) + " to " + RoundedNumber(first),
                   RoundedNumber(first) + " to " + RoundedNumber(second),
                   RoundedNumber(second) + " to " + RoundedNumber(sorted.back())};
  bool are_all_drawn = true;
  for (const auto& value : values) {
    if (!value) {
      are_all_drawn = false;
      factor.level_of.push_back(factor.levels.size());
      continue;
    }
    const double number = value->get<double>();
    factor.level_of.push_back(number < first ? 0U : number < second ? 1U : 2U);
    factor.numbers.push_back(number);
  }
  if (are_all_drawn) return;
  factor.levels.emplace_back(kNotDrawn);
  factor.numbers.clear();
}

std::optional<Factor> FactorOf(const std::string& name, const Values& values) {
  Factor factor{.name = name, .levels = {}, .level_of = {}, .numbers = {}};
  const std::size_t num_distinct = NumDistinct(values);
  if (num_distinct < 2) return std::nullopt;
  if (AreNumbers(values) && num_distinct > kMostLevels) {
    UseThirds(values, factor);
    return factor;
  }
  if (num_distinct > kMostLevels) return std::nullopt;
  std::vector<std::string> texts;
  for (const auto& value : values)
    texts.push_back(value ? DrawnValueText(*value) : std::string(kNotDrawn));
  UseLevels(texts, factor);
  return factor;
}

/// The columns of a regression, and whose they are.
struct Design {
  std::vector<Eigen::VectorXd> columns;
  std::vector<std::size_t> owners;  ///< 0 = the intercept, 1 = the distance, then the factors.

  void Add(Eigen::VectorXd column, std::size_t owner) {
    columns.push_back(std::move(column));
    owners.push_back(owner);
  }
};

// Scales to mean 0 and variance 1, so that the information is well-conditioned.
Eigen::VectorXd Standardized(const Eigen::VectorXd& column) {
  const Eigen::VectorXd centered = column.array() - column.mean();
  const double scale = std::sqrt(centered.squaredNorm() / static_cast<double>(column.size()));
  return scale > 0.0 ? Eigen::VectorXd(centered / scale) : centered;
}

Eigen::VectorXd NumberColumn(const std::vector<double>& numbers) {
  constexpr double kDecade = 10.0;
  const auto [least, most] = std::ranges::minmax(numbers);
  Eigen::VectorXd column =
      Eigen::Map<const Eigen::VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
  if (least > 0.0 && most > kDecade * least) column = column.array().log();
  return Standardized(column);
}

Design DesignOf(const std::vector<Observation>& observations, const std::vector<Factor>& factors) {
  const auto num = static_cast<Eigen::Index>(observations.size());
  Design design;
  design.Add(Eigen::VectorXd::Ones(num), 0);
  Eigen::VectorXd distance(num);
  for (Eigen::Index i = 0; i < num; ++i) {
    distance[i] = std::log(observations[static_cast<std::size_t>(i)].inspection.range_m);
  }
  design.Add(Standardized(distance), 1);
  for (std::size_t k = 0; k < factors.size(); ++k) {
    const Factor& factor = factors[k];
    if (!factor.numbers.empty()) {
      design.Add(NumberColumn(factor.numbers), k + 2);
      continue;
    }
    for (std::size_t level = 1; level < factor.levels.size(); ++level) {
      Eigen::VectorXd column(num);
      for (Eigen::Index i = 0; i < num; ++i) {
        column[i] = factor.level_of[static_cast<std::size_t>(i)] == level ? 1.0 : 0.0;
      }
      design.Add(Standardized(column), k + 2);
    }
  }
  return design;
}

void AddKeysOf(const Json& option, std::set<std::string>& keys) {
  const Json draws = option.value("draws", Json::object());
  const Json set = option.value("set", Json::object());
  for (const auto& [pointer, value] : draws.items()) keys.insert(pointer);
  for (const auto& [pointer, value] : set.items()) {
    keys.insert(pointer);
    if (!value.is_object()) continue;
    const Json leaves = value.flatten();
    for (const auto& [below, leaf] : leaves.items()) keys.insert(pointer + below);
  }
}

}  // namespace

void ObservedGroup::Add(const Observation& each) {
  const StudiedObject& object = *each.object;
  ++num;
  num_decided += object.is_undecided() ? 0U : 1U;
  num_in_time += object.is_in_time() ? 1U : 0U;
  detected_m.push_back(object.detected_m());
  at_most_m.push_back(object.is_undecided() ? std::numeric_limits<double>::infinity()
                                            : object.detected_m());
  most_needed_m = std::fmax(most_needed_m, object.needed_m);
  inspections.push_back(each.inspection);
  if (!object.is_detected) return;
  ++num_detected;
  distance_m.Add(object.distance_m);
}

std::vector<Observation> ObservationsOf(const std::vector<ApproachRecord>& approaches) {
  std::map<std::string, std::vector<Observation>> by_target;
  for (const ApproachRecord& approach : approaches) {
    for (const StudiedObject& object : approach.objects) {
      by_target[object.Target()].push_back({&approach, &object, {}});
    }
  }
  std::vector<Observation> all;
  for (auto& [target, observations] : by_target) {
    std::vector<InspectedApproach> inspected;
    for (const Observation& each : observations) {
      const StudiedObject& object = *each.object;
      // What is detected at once might have been detected from farther away.
      const bool is_bounded = object.is_from_start && object.is_detected;
      inspected.push_back({.nearest_m = object.nearest_m,
                           .farthest_m = is_bounded ? object.distance_m : object.farthest_m,
                           .detected_m = object.distance_m});
    }
    const std::vector<Inspection> inspections = InspectEach(inspected);
    for (std::size_t i = 0; i < observations.size(); ++i) {
      observations[i].inspection = inspections[i];
      all.push_back(observations[i]);
    }
  }
  return all;
}

std::vector<Factor> FactorsOf(const std::vector<Observation>& observations) {
  std::vector<Factor> factors;
  for (const auto& [name, values] : DrawnValues(observations)) {
    if (auto factor = FactorOf(name, values)) factors.push_back(std::move(*factor));
  }
  // Options first: what is drawn for some of them only follows from them where it is not drawn.
  std::ranges::stable_partition(
      factors, [](const Factor& factor) { return factor.name.find('/') == std::string::npos; });
  return factors;
}

std::vector<FactorWeight> WeighFactors(const std::vector<Observation>& observations,
                                       const std::vector<Factor>& factors) {
  constexpr std::size_t kLeastPerCoefficient = 10;
  if (observations.empty()) return {};
  const Design design = DesignOf(observations, factors);
  Eigen::MatrixXd all(static_cast<Eigen::Index>(observations.size()),
                      static_cast<Eigen::Index>(design.columns.size()));
  for (std::size_t i = 0; i < design.columns.size(); ++i) {
    all.col(static_cast<Eigen::Index>(i)) = design.columns[i];
  }
  const std::vector<std::size_t> used = IndependentColumns(all);
  if (observations.size() < kLeastPerCoefficient * used.size()) return {};
  const Eigen::MatrixXd x = all(Eigen::all, used);
  Eigen::VectorXd y(all.rows());
  for (std::size_t i = 0; i < observations.size(); ++i) {
    y[static_cast<Eigen::Index>(i)] = static_cast<double>(observations[i].inspection.num_detected);
  }
  const double whole = FitLogistic(x, y, std::vector<bool>(used.size(), true)).log_likelihood;
  std::vector<FactorWeight> weights;
  double sum = 0.0;
  for (std::size_t owner = 1; owner < factors.size() + 2; ++owner) {
    std::vector<bool> is_free;
    for (const std::size_t column : used) is_free.push_back(design.owners[column] != owner);
    const auto degrees = static_cast<std::size_t>(std::ranges::count(is_free, false));
    if (degrees == 0) continue;
    const double ratio = std::max(0.0, 2.0 * (whole - FitLogistic(x, y, is_free).log_likelihood));
    const boost::math::chi_squared distribution(static_cast<double>(degrees));
    weights.push_back({.name = owner == 1 ? kDistance : factors[owner - 2].name,
                       .degrees = degrees,
                       .ratio = ratio,
                       .p_value = boost::math::cdf(boost::math::complement(distribution, ratio)),
                       .share = std::numeric_limits<double>::quiet_NaN()});
    if (owner != 1) sum += ratio;
  }
  for (FactorWeight& weight : weights) {
    if (weight.name != kDistance) weight.share = sum > 0.0 ? weight.ratio / sum : 0.0;
  }
  std::ranges::stable_sort(weights, std::greater<>(), &FactorWeight::ratio);
  return weights;
}

std::set<std::string> DrawnKeys(const std::string& name, const Json& recipe) {
  std::set<std::string> keys = {name};
  const Json none = Json::array();
  for (const Json& group : recipe.value("groups", none)) {
    if (group.value("name", std::string()) != name) continue;
    for (const Json& option : group.value("options", none)) AddKeysOf(option, keys);
  }
  return keys;
}

}  // namespace railcast
