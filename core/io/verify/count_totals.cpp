#include "core/io/verify/count_totals.h"

#include <cstdint>

#include "core/base/text.h"

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

}  // namespace railcast
