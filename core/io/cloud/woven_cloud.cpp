#include "core/io/cloud/woven_cloud.h"

#include <algorithm>
#include <string_view>

#include "core/io/field_layout.h"

namespace railcast {
namespace {

// Writes values `step` bytes apart. Its arguments are values, since the compiler must assume that
// what is written through a char* changes anything that is referred to.
template <typename Stored, typename T>
void StoreColumn(const T* from, std::size_t count, std::size_t step, char* to) {
  for (std::size_t i = 0; i < count; ++i, to += step) StoreAt<Stored>(to, from[i]);
}

}  // namespace

Cloud DescribeCloud(const Frame& frame, const SelectedFields& fields) {
  Cloud cloud;
  fields.ForEach([&](std::string_view name, std::string_view, const auto& values) {
    using Stored = typename StoredType<ElementOf<decltype(values)>>::Type;
    cloud.AddField(std::string(name), NumberTypeOf<Stored>());
  });
  cloud.width = frame.width();
  cloud.height = frame.rows;
  return cloud;
}

void WeaveRows(const Frame& frame, const SelectedFields& fields, std::size_t step, char* to) {
  // The block size keeps the rows of a block in the first-level cache while the fields are written
  // into them one after another.
  constexpr std::size_t kBlock = 256;
  for (std::size_t first = 0; first < frame.num_slots(); first += kBlock) {
    const std::size_t count = std::min(kBlock, frame.num_slots() - first);
    char* place = to + first * step;
    fields.ForEach([&](std::string_view, std::string_view, const auto& values) {
      using Stored = typename StoredType<ElementOf<decltype(values)>>::Type;
      StoreColumn<Stored>(values.data() + first, count, step, place);
      place += sizeof(Stored);
    });
  }
}

}  // namespace railcast
