#include "analysis/verify/count_totals.h"

#include <cstdint>

#include "core/base/number_text.h"
#include "core/base/shown_text.h"

namespace railcast {
namespace {

using Json = StrictJson;

// Numbers, or objects of them.
void AddTo(Json& sum, const Json& value) {
  if (!value.is_object()) {
    sum = sum.get<std::uint64_t>() + value.get<std::uint64_t>();
    return;
  }
  for (const auto& [key, one] : value.items()) AddTo(sum.emplace(key, 0U).first.value(), one);
}

const Json* Find(const Json& object, const std::string& key) {
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

std::string TextOf(const Json* value) {
  if (value == nullptr) return "nothing";
  return value->is_number() ? value->dump() : value->type_name();
}

// What was read may be nested too deep to be copied, compared or written: only what must be a
// number is looked into.
void CompareTo(const Json& sum, const Json* got, const std::string& place, ErrorList& faults) {
  if (sum.is_object() && got != nullptr && got->is_object()) {
    for (const auto& [key, one] : sum.items()) {
      CompareTo(one, Find(*got, key), place + "/" + ShownText(key), faults);
    }
    for (const auto& [key, one] : got->items()) {
      if (!sum.contains(key)) faults.Add(place + "/" + ShownText(key) + ": is in no frame");
    }
    return;
  }
  if (sum.is_number() && got != nullptr && got->is_number() && sum == *got) return;
  const std::string expected = sum.is_number() ? sum.dump() : sum.type_name();
  faults.Add(place + ": must be " + expected + ", the sum over frames.jsonl (got " + TextOf(got) +
             ")");
}

}  // namespace

void CountTotals::Add(const Json& line) {
  for (const auto& [key, sum] : sums_.items()) AddTo(sum, line.at(key));
}

void CountTotals::Compare(const Json& manifest, const std::string& place, ErrorList& faults) const {
  for (const auto& [key, sum] : sums_.items()) {
    CompareTo(sum, Find(manifest, key), place + ": /" + key, faults);
  }
}

}  // namespace railcast
