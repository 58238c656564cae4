#include "core/io/stream/stream_clouds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/units.h"
#include "core/io/field_layout.h"

namespace railcast {
namespace {

/// Returns one field of all points that arrived, or nothing if it was not sent with that type.
template <typename T>
std::optional<std::vector<T>> ReadField(const ReceivedFrame& received, std::string_view name) {
  const StreamField* const field = received.header.Find(name);
  if (field == nullptr || field->type != kStreamTypeOf<T>) return std::nullopt;
  std::vector<T> values(received.num_points());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = received.At<T>(*field, i);
  return values;
}

bool HasOnlyFinitePlaces(const ReceivedFrame& received) {
  for (const std::string_view axis : {"x", "y", "z"}) {
    const StreamField* const field = received.header.Find(axis);
    if (field == nullptr || field->type != StreamType::kF32) continue;
    for (std::size_t i = 0; i < received.num_points(); ++i) {
      if (!std::isfinite(received.At<float>(*field, i))) return false;
    }
  }
  return true;
}

/// Returns the slot of each point, or nothing unless the points fill all slots, each once.
std::optional<std::vector<std::size_t>> SlotsOf(const ReceivedFrame& received, const Frame& frame) {
  const auto ring = ReadField<std::uint16_t>(received, "ring");
  const auto column = ReadField<std::uint32_t>(received, "column");
  auto echo = ReadField<std::uint8_t>(received, "return_index");
  if (!echo && frame.returns == 1) echo.emplace(received.num_points());
  if (!ring || !column || !echo) return std::nullopt;
  std::vector<std::size_t> slots(received.num_points());
  std::vector<bool> is_taken(slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if ((*ring)[i] >= frame.rows || (*column)[i] >= frame.columns || (*echo)[i] >= frame.returns) {
      return std::nullopt;
    }
    slots[i] =
        (std::size_t{(*ring)[i]} * frame.columns + (*column)[i]) * frame.returns + (*echo)[i];
    if (is_taken[slots[i]]) return std::nullopt;
    is_taken[slots[i]] = true;
  }
  return slots;
}

bool HasOutcomes(const ReceivedFrame& received) {
  const auto outcomes = ReadField<std::uint8_t>(received, "outcome");
  return outcomes && std::ranges::all_of(*outcomes, [](std::uint8_t outcome) {
           return outcome < kOutcomeNames.size();
         });
}

}  // namespace

Cloud MakeCloud(const ReceivedFrame& received) {
  Cloud cloud;
  for (const StreamField& field : received.header.fields) {
    cloud.fields.push_back({field.name, field.offset, static_cast<NumberType>(field.type)});
  }
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(received.num_points());
  cloud.point_step = received.header.point_size;
  cloud.is_dense = HasOnlyFinitePlaces(received);
  cloud.data.assign(received.points.begin(), received.points.end());
  return cloud;
}

std::optional<Frame> MakeFrame(const ReceivedFrame& received) {
  const StreamHeader& header = received.header;
  if (!header.has_all_slots || !received.is_complete() || !HasOutcomes(received)) {
    return std::nullopt;
  }
  Frame frame;
  frame.index = header.frame;
  frame.stamp_ns = header.stamp_ns;
  frame.world_from_sensor = header.world_from_sensor;
  frame.world_from_sensor_end = header.world_from_sensor_end;
  frame.duration_ns = header.duration_ns;
  // Every slot arrived, so this takes no more memory than the datagrams did.
  frame.has_velocity = header.Find("radial_velocity_mps") != nullptr ||
                       header.Find("true_radial_velocity_mps") != nullptr;
  frame.Resize(header.rows, header.columns, header.returns);
  const auto slots = SlotsOf(received, frame);
  if (!slots) return std::nullopt;
  ForEachField(frame, [&](std::string_view name, std::string_view, auto& values) {
    using Element = ElementOf<decltype(values)>;
    using Stored = typename StoredType<Element>::Type;
    const auto sent = ReadField<Stored>(received, name);
    if (sent) {
      for (std::size_t i = 0; i < slots->size(); ++i) {
        values[(*slots)[i]] = static_cast<Element>((*sent)[i]);
      }
    } else if constexpr (std::is_same_v<Element, float>) {
      values.assign(values.size(), std::numeric_limits<float>::quiet_NaN());
    }
  });
  return frame;
}

}  // namespace railcast
