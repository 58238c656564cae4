#include "core/io/stream/stream_clouds.h"

#include <cmath>
#include <string_view>

namespace railcast {
namespace {

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

}  // namespace railcast
