#include "core/extras/packets/spinning/turn_edit.h"

#include "core/base/text.h"
#include "core/extras/packets/spinning/coded_return.h"

namespace railcast {
namespace {

CodedReturn CodedAt(const char* place) {
  return {LoadAt<std::uint16_t>(place), LoadAt<std::uint8_t>(place + sizeof(std::uint16_t))};
}

CodedReturn CodeOf(const EditedReturn& edited,
                   const FiringPlace& place,
                   const ReturnCode& code,
                   const char* packet) {
  CodedReturn coded{CodedDistance(edited.range_m, code.unit_m), 0};
  if (edited.from) coded = CodedAt(packet + (*edited.from == 0 ? place.first : place.second));
  if (edited.intensity) coded.reflectivity = *edited.intensity;
  return coded;
}

/// Repeats a lone return.
CodedPair InTheirOrder(const CodedReturn& first, const CodedReturn& second, std::uint16_t least) {
  if (first.distance < least) return {second, second};
  return {first, second.distance < least ? first : second};
}

}  // namespace

std::string RefuseRange(double range_m, double least_m, double most_m) {
  return "range must be " + NumberText(least_m) + " to " + NumberText(most_m) + " m in packets" +
         Got(range_m);
}

std::optional<std::string> StoreReturns(const EditedReturns& returns,
                                        const FiringPlace& place,
                                        const ReturnCode& code,
                                        std::span<char> packet) {
  std::array<CodedReturn, 2> coded = {{{code.none, 0}, {code.none, 0}}};
  for (std::size_t i = 0; i < returns.size(); ++i) {
    if (!returns[i]) continue;
    coded[i] = CodeOf(*returns[i], place, code, packet.data());
    if (coded[i].distance >= code.least) continue;
    return RefuseRange(static_cast<double>(returns[i]->range_m), code.least * code.unit_m,
                       65535 * code.unit_m);
  }
  if (place.second == 0) {
    if (returns[0] && returns[1]) return "must be one return in packets of single ones (got 2)";
    StoreCoded(coded[returns[1] ? 1 : 0], packet.data() + place.first);
    return std::nullopt;
  }
  const CodedPair pair = code.has_last ? LastAndOther(coded[0], coded[1], code.least)
                                       : InTheirOrder(coded[0], coded[1], code.least);
  StoreCoded(pair.last, packet.data() + place.first);
  StoreCoded(pair.other, packet.data() + place.second);
  return std::nullopt;
}

}  // namespace railcast
