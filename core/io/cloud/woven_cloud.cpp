#include "core/io/cloud/woven_cloud.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "core/io/field_layout.h"

namespace railcast {
namespace {

template <typename Stored>
constexpr NumberType TypeOfNumber() {
  if (std::is_same_v<Stored, float>) return NumberType::kFloat;
  constexpr std::array<NumberType, 5> kUnsignedBySize = {
      NumberType{}, NumberType::kUint8, NumberType::kUint16, NumberType{}, NumberType::kUint32};
  return kUnsignedBySize[sizeof(Stored)];
}

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
    cloud.AddField(std::string(name), TypeOfNumber<Stored>());
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

void Transpose(const std::vector<std::size_t>& field_bytes,
               std::size_t num_rows,
               std::string_view from,
               bool is_to_rows,
               std::string& to) {
  std::size_t row_bytes = 0;
  for (const std::size_t size : field_bytes) row_bytes += size;
  to.resize(num_rows * row_bytes);
  std::size_t before = 0;
  for (const std::size_t size : field_bytes) {
    for (std::size_t row = 0; row < num_rows; ++row) {
      const std::size_t in_rows = row * row_bytes + before;
      const std::size_t in_fields = num_rows * before + row * size;
      std::memcpy(&to[is_to_rows ? in_rows : in_fields], &from[is_to_rows ? in_fields : in_rows],
                  size);
    }
    before += size;
  }
}

}  // namespace railcast
