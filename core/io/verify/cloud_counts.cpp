#include "core/io/verify/cloud_counts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/base/text.h"
#include "railcast/frame.h"

namespace railcast {
namespace {

// Both are numbers, or objects of numbers.
void AddToTotals(StrictJson& sum, const StrictJson& value) {
  if (!value.is_object()) {
    sum = sum.get<std::uint64_t>() + value.get<std::uint64_t>();
    return;
  }
  for (const auto& [key, one] : value.items()) AddToTotals(sum.emplace(key, 0U).first.value(), one);
}

const StrictJson* FindCount(const StrictJson& object, const std::string& key) {
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

std::string TotalText(const StrictJson* value) {
  if (value == nullptr) return "nothing";
  return value->is_number() ? value->dump() : value->type_name();
}

// The parsed value may be nested too deep to be copied, compared or written, so only members that
// must be numbers are examined.
void CompareTo(const StrictJson& sum,
               const StrictJson* got,
               const std::string& pointer,
               const CountsPlace& place,
               ErrorList& faults) {
  if (sum.is_object() && got != nullptr && got->is_object()) {
    for (const auto& [key, one] : sum.items()) {
      CompareTo(one, FindCount(*got, key), pointer + "/" + ShownText(key), place, faults);
    }
    for (const auto& [key, one] : got->items()) {
      if (sum.contains(key)) continue;
      faults.Add({place.place + ": " + pointer + "/" + ShownText(key), place.is_absent, ""});
    }
    return;
  }
  if (sum.is_number() && got != nullptr && got->is_number() && sum == *got) return;
  const std::string expected = sum.is_number() ? sum.dump() : sum.type_name();
  faults.Add({place.place + ": " + pointer, "must be " + expected + ", " + place.compared,
              TotalText(got)});
}

// Which of the stored slots have a point; nothing if the cloud does not say.
std::optional<std::vector<bool>> StoredPoints(const PointTable& cloud, const FrameFormat& format) {
  std::vector<bool> has_point(cloud.num_points(), !format.has_all_slots);
  if (!format.has_all_slots) return has_point;
  const PointColumn* const x = cloud.Find("x");
  if (x == nullptr) return std::nullopt;
  VisitColumn(cloud, *x, [&](std::size_t i, auto value) {
    has_point[i] = std::isfinite(static_cast<double>(value));
  });
  return has_point;
}

// The columns of a data set's layout have ids of that data set.
StrictJson PointsPerLabel(const PointTable& cloud,
                          const PointColumn& column,
                          const std::vector<bool>& has_point,
                          const LabelTable& labels) {
  std::map<std::uint32_t, std::uint64_t> num_by_id;
  VisitColumn(cloud, column, [&](std::size_t i, auto value) {
    if (has_point[i]) ++num_by_id[static_cast<std::uint32_t>(value)];
  });
  StrictJson json = StrictJson::object();
  for (const auto& [id, num] : num_by_id) {
    const Label* const label = labels.Find(id);
    json[label == nullptr ? "label " + NumberText(id) : label->name] = num;
  }
  return json;
}

// A firing's outcome is that of its first slot.
std::optional<StrictJson> FiringsPerOutcome(const PointTable& cloud,
                                            const PointColumn& column,
                                            std::uint64_t num_firings) {
  if (num_firings == 0 || cloud.num_points() % num_firings != 0) return std::nullopt;
  const std::size_t returns = cloud.num_points() / num_firings;
  StrictJson json = StrictJson::object();
  for (const std::string_view name : kOutcomeNames) json[std::string(name)] = 0U;
  bool is_known = true;
  VisitColumn(cloud, column, [&](std::size_t i, auto value) {
    if (i % returns != 0) return;
    const auto outcome = static_cast<std::size_t>(value);
    is_known = is_known && outcome < kOutcomeNames.size();
    if (!is_known) return;
    StrictJson& num = json[std::string(kOutcomeNames[outcome])];
    num = num.template get<std::uint64_t>() + 1;
  });
  if (!is_known) return std::nullopt;
  return json;
}

std::uint64_t NumFirings(const StrictJson& line) {
  std::uint64_t num = 0;
  for (const auto& [name, count] : line.at("outcomes").items()) num += count.get<std::uint64_t>();
  return num;
}

}  // namespace

void CompareCounts(const StrictJson& counted,
                   const StrictJson& object,
                   const std::string& key,
                   const CountsPlace& place,
                   ErrorList& faults) {
  CompareTo(counted, FindCount(object, key), "/" + key, place, faults);
}

void CountTotals::Add(const StrictJson& line) {
  for (const auto& [key, sum] : sums_.items()) AddToTotals(sum, line.at(key));
}

void CountTotals::Compare(const StrictJson& manifest,
                          const std::string& place,
                          ErrorList& faults) const {
  for (const auto& [key, sum] : sums_.items()) {
    CompareCounts(sum, manifest, key, {place, "the sum over frames.jsonl", "is in no frame"},
                  faults);
  }
}

void CompareWithCloud(const CountedCloud& counted,
                      const StrictJson& line,
                      const std::string& place,
                      ErrorList& faults) {
  const auto& [cloud, format, labels, file] = counted;
  const auto has_point = StoredPoints(cloud, format);
  if (!has_point) return;
  const CountsPlace compared = {place, "as counted in " + ShownPath(file),
                                "is not in " + ShownPath(file)};
  const auto compare = [&](const std::string& key, const StrictJson& expected) {
    CompareCounts(expected, line, key, compared, faults);
  };
  compare("points", static_cast<std::uint64_t>(std::ranges::count(*has_point, true)));
  const PointColumn* const label = cloud.Find("label");
  if (label != nullptr && !format.dataset) {
    compare("points_per_label", PointsPerLabel(cloud, *label, *has_point, labels));
  }
  const PointColumn* const outcome = cloud.Find("outcome");
  if (outcome == nullptr || !format.has_all_slots) return;
  const auto outcomes = FiringsPerOutcome(cloud, *outcome, NumFirings(line));
  if (outcomes) return compare("outcomes", *outcomes);
  faults.Add({place + ": /outcomes", "must be those of the firings in " + ShownPath(file), ""});
}

}  // namespace railcast
