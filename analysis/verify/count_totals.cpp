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

void CompareTo(const Json& sum, const Json& got, const std::string& place, ErrorList& faults) {
  if (sum == got) return;
  if (sum.is_object() && got.is_object()) {
    for (const auto& [key, one] : sum.items()) {
      CompareTo(one, got.value(key, Json()), place + "/" + key, faults);
    }
    for (const auto& [key, one] : got.items()) {
      if (!sum.contains(key)) faults.Add(place + "/" + ShownText(key) + ": is in no frame");
    }
    return;
  }
  // Anything but a number may be nested too deep to be written.
  const std::string got_text = got.is_number() ? got.dump() : got.type_name();
  faults.Add(place + ": must be " + sum.dump() + ", the sum over frames.jsonl (got " + got_text +
             ")");
}

}  // namespace

void CountTotals::Add(const Json& line) {
  for (const auto& [key, sum] : sums_.items()) AddTo(sum, line.at(key));
}

void CountTotals::Compare(const Json& manifest, const std::string& place, ErrorList& faults) const {
  for (const auto& [key, sum] : sums_.items()) {
    CompareTo(sum, manifest.value(key, Json()), place + ": /" + key, faults);
  }
}

}  // namespace railcast
