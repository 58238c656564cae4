#include "core/io/verify/findings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>

#include "core/base/text.h"
#include "core/scenario/json_text.h"

namespace railcast {
namespace {

// Which of the stored slots have a point; nothing if the cloud does not say.
std::optional<std::vector<bool>> StoredPoints(const Cloud& cloud, const FrameFormat& format) {
  std::vector<bool> has_point(cloud.num_points(), !format.has_all_slots);
  if (!format.has_all_slots) return has_point;
  const CloudField* const x = cloud.Find("x");
  if (x == nullptr) return std::nullopt;
  VisitField(cloud, *x, [&](std::size_t i, auto value) {
    has_point[i] = std::isfinite(static_cast<double>(value));
  });
  return has_point;
}

// The columns of a data set's layout have ids of that data set.
std::map<std::string, std::uint64_t> PointsPerLabel(const Cloud& cloud,
                                                    const CloudField& column,
                                                    const std::vector<bool>& has_point,
                                                    const LabelTable& labels) {
  std::map<std::uint32_t, std::uint64_t> num_by_id;
  VisitField(cloud, column, [&](std::size_t i, auto value) {
    if (has_point[i]) ++num_by_id[static_cast<std::uint32_t>(value)];
  });
  std::map<std::string, std::uint64_t> counts;
  for (const auto& [id, num] : num_by_id) {
    const Label* const label = labels.Find(id);
    counts[label == nullptr ? "label " + NumberText(id) : label->name] = num;
  }
  return counts;
}

// A firing's outcome is that of its first slot.
std::optional<OutcomeCounts> FiringsPerOutcome(const Cloud& cloud,
                                               const CloudField& column,
                                               std::uint64_t num_firings) {
  if (num_firings == 0 || cloud.num_points() % num_firings != 0) return std::nullopt;
  const std::size_t returns = cloud.num_points() / num_firings;
  OutcomeCounts counts;
  bool is_known = true;
  VisitField(cloud, column, [&](std::size_t i, auto value) {
    if (i % returns != 0) return;
    const auto outcome = static_cast<double>(value);
    is_known = is_known && outcome >= 0.0 && outcome < static_cast<double>(counts.size());
    if (is_known) ++counts[static_cast<std::size_t>(outcome)];
  });
  if (!is_known) return std::nullopt;
  return counts;
}

}  // namespace

void CompareCounts(const FrameCounts& counted,
                   const FrameCounts& got,
                   const CountsPlace& place,
                   ErrorList& faults) {
  const auto compare = [&](const std::string& pointer, std::uint64_t must_be, std::uint64_t is) {
    if (must_be == is) return;
    faults.Add({place.place + ": " + pointer,
                "must be " + NumberText(must_be) + ", " + place.compared, NumberText(is)});
  };
  compare("/points", counted.points, got.points);
  for (std::size_t i = 0; i < got.outcomes.size(); ++i) {
    compare("/outcomes/" + std::string(kOutcomeNames[i]), counted.outcomes[i], got.outcomes[i]);
  }
  const auto pointer_of = [](const std::string& label) {
    return "/points_per_label" + PointerStep(label);
  };
  for (const auto& [label, num] : counted.points_per_label) {
    const auto found = got.points_per_label.find(label);
    compare(pointer_of(label), num, found == got.points_per_label.end() ? 0 : found->second);
  }
  for (const auto& [label, num] : got.points_per_label) {
    if (counted.points_per_label.contains(label)) continue;
    faults.Add({place.place + ": " + pointer_of(label), place.is_absent, ""});
  }
}

void CompareWithCloud(const CountedCloud& counted,
                      const FrameCounts& line,
                      const std::string& place,
                      ErrorList& faults) {
  const auto& [cloud, format, labels, file] = counted;
  const auto has_point = StoredPoints(cloud, format);
  if (!has_point) return;
  FrameCounts expected = line;
  expected.points = static_cast<std::uint64_t>(std::ranges::count(*has_point, true));
  const CloudField* const label = cloud.Find("label");
  if (label != nullptr && !format.dataset) {
    expected.points_per_label = PointsPerLabel(cloud, *label, *has_point, labels);
  }
  const CloudField* const outcome = cloud.Find("outcome");
  if (outcome != nullptr && format.has_all_slots) {
    const std::uint64_t num_firings =
        std::accumulate(line.outcomes.begin(), line.outcomes.end(), std::uint64_t{0});
    const auto outcomes = FiringsPerOutcome(cloud, *outcome, num_firings);
    if (outcomes) {
      expected.outcomes = *outcomes;
    } else {
      faults.Add({place + ": /outcomes", "must be those of the firings in " + ShownPath(file), ""});
    }
  }
  CompareCounts(expected, line,
                {place, "as counted in " + ShownPath(file), "is not in " + ShownPath(file)},
                faults);
}

}  // namespace railcast
