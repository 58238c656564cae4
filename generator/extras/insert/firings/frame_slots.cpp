#include "generator/extras/insert/firings/frame_slots.h"

#include <limits>
#include <type_traits>

#include "core/io/recording/cloud_fields.h"

namespace railcast {
namespace {

template <typename Value>
Value AbsentValue() {
  if constexpr (std::is_same_v<Value, float>) return std::numeric_limits<float>::quiet_NaN();
  return Value{};
}

template <typename Value>
std::vector<Value> Moved(const std::vector<Value>& values, const NewSlots& to) {
  std::vector<Value> moved(to.num_cells() * to.returns, AbsentValue<Value>());
  for (std::size_t slot = 0; slot < values.size(); ++slot) {
    if (to.of_slot[slot] != kNoSlot) moved[to.of_slot[slot]] = values[slot];
  }
  return moved;
}

}  // namespace

void MoveSlots(const NewSlots& to, RecordedFrame& recorded) {
  Frame& frame = recorded.frame;
  ForEachField(frame, [&](auto, auto, auto& values) { values = Moved(values, to); });
  frame.rows = to.rows;
  frame.columns = to.columns;
  frame.returns = to.returns;
  FillGridIndices(frame);
  recorded.fields.insert({"ring", "column", "return_index", "return_count"});
  recorded.is_grid = true;
  recorded.why_no_grid.clear();
  for (ForeignField& field : recorded.foreign) field.values = Moved(field.values, to);
  for (std::uint32_t& slot : recorded.slot_of_entry) {
    if (slot != kNoSlot) slot = to.of_slot[slot];
  }
}

std::vector<std::uint32_t> EntriesOfSlots(const RecordedFrame& recorded) {
  if (recorded.slot_of_entry.empty()) return {};
  std::vector<std::uint32_t> entries(recorded.frame.num_slots(), kNoSlot);
  for (std::size_t entry = 0; entry < recorded.slot_of_entry.size(); ++entry) {
    const std::uint32_t slot = recorded.slot_of_entry[entry];
    if (slot != kNoSlot) entries[slot] = static_cast<std::uint32_t>(entry);
  }
  return entries;
}

}  // namespace railcast
