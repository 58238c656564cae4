#include "core/fidelity/scene_parts.h"

#include <algorithm>
#include <cmath>

#include "core/base/text.h"

namespace railcast {
namespace {

constexpr double kNormal95 = 1.959964;

}  // namespace

double LeastShare(std::uint64_t num_found, std::uint64_t num) {
  if (num_found == 0) return 0.0;
  constexpr double kZ2 = kNormal95 * kNormal95;
  const auto n = static_cast<double>(num);
  const double p = static_cast<double>(num_found) / n;
  const double root = std::sqrt(kZ2 - 2.0 - 1.0 / n + 4.0 * p * (n * (1.0 - p) + 1.0));
  return std::max((2.0 * n * p + kZ2 - 1.0 - kNormal95 * root) / (2.0 * (n + kZ2)), 0.0);
}

std::vector<ScenePart> MakeSceneParts(double range_max_m,
                                      const LabelTable& labels,
                                      const std::vector<std::uint32_t>& other_labels,
                                      const std::vector<SceneObject>& objects) {
  std::vector<ScenePart> parts;
  const auto num_bins = static_cast<std::uint32_t>(std::ceil(range_max_m / kRangeBin_m));
  for (std::uint32_t bin = 0; bin < num_bins; ++bin) {
    const double from_m = kRangeBin_m * bin;
    parts.push_back({ScenePart::Kind::kRangeBin, bin,
                     NumberText(from_m) + " to " + NumberText(from_m + kRangeBin_m) + " m"});
  }
  for (const Label& label : labels.labels()) {
    if (std::ranges::find(other_labels, label.id) != other_labels.end()) continue;
    parts.push_back({ScenePart::Kind::kClass, label.id, label.name});
  }
  for (const SceneObject& object : objects) {
    if (object.is_ego) continue;
    parts.push_back({ScenePart::Kind::kObject, object.instance, object.name});
  }
  return parts;
}

MedianError MedianOf(std::vector<float> errors) {
  if (errors.empty()) return {};
  std::ranges::sort(errors);
  const auto num = static_cast<double>(errors.size());
  const auto at_rank = [&](double rank) {
    return static_cast<double>(errors[static_cast<std::size_t>(rank) - 1]);
  };
  // The number of errors below the true median has a binomial distribution.
  const double least_rank = std::floor(0.5 * (num - kNormal95 * std::sqrt(num)));
  return {at_rank(std::ceil(0.5 * num)), least_rank < 1.0 ? 0.0 : at_rank(least_rank)};
}

PartsComparison::PartsComparison(const std::vector<ScenePart>& parts)
    : range_errors_m_(parts.size()), intensity_errors_(parts.size()) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    differences_.push_back({parts[i], {}, {}, {}, {}});
    if (parts[i].kind == ScenePart::Kind::kRangeBin) ++num_bins_;
    if (parts[i].kind == ScenePart::Kind::kClass) part_of_label_[parts[i].id] = i;
    if (parts[i].kind == ScenePart::Kind::kObject) part_of_instance_[parts[i].id] = i;
  }
}

template <typename Visit>
void PartsComparison::VisitPartsOf(const EchoPlace& echo, const Visit& visit) {
  if (num_bins_ > 0) {
    const auto bin = static_cast<std::size_t>(static_cast<double>(echo.range_m) / kRangeBin_m);
    visit(std::min(bin, num_bins_ - 1));
  }
  if (const auto part = part_of_label_.find(echo.label); part != part_of_label_.end()) {
    visit(part->second);
  }
  if (const auto part = part_of_instance_.find(echo.instance); part != part_of_instance_.end()) {
    visit(part->second);
  }
}

void PartsComparison::CountReference(const EchoPlace& echo, bool is_matched) {
  VisitPartsOf(echo,
               [&](std::size_t part) { differences_[part].reference_echoes.Count(is_matched); });
}

void PartsComparison::CountOther(const EchoPlace& echo, bool is_matched) {
  VisitPartsOf(echo, [&](std::size_t part) { differences_[part].echoes.Count(is_matched); });
}

void PartsComparison::AddErrors(const EchoPlace& reference,
                                float range_error_m,
                                float intensity_error) {
  VisitPartsOf(reference, [&](std::size_t part) {
    range_errors_m_[part].push_back(range_error_m);
    if (!std::isnan(intensity_error)) intensity_errors_[part].push_back(intensity_error);
  });
}

std::vector<PartDifference> PartsComparison::Result() const {
  std::vector<PartDifference> result = differences_;
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i].range_m = MedianOf(range_errors_m_[i]);
    result[i].intensity = MedianOf(intensity_errors_[i]);
  }
  return result;
}

}  // namespace railcast
