#include "core/io/cloud/cloud.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/base/text_number.h"

namespace railcast {
namespace {

/// Where values lie that are a step apart.
template <typename Byte>
struct Places {
  Byte* next{};
  std::size_t step{};
};

/// Copies values of some rows.
/// @tparam kSize Of a value in bytes, as the compiler needs it for a fast copy; 0 = `size` says it.
template <std::size_t kSize>
void CopyValues(std::size_t size, std::size_t num, Places<const char> from, Places<char> to) {
  for (std::size_t i = 0; i < num; ++i, from.next += from.step, to.next += to.step) {
    std::memcpy(to.next, from.next, kSize == 0 ? size : kSize);
  }
}

/// Makes a field padding that has a word which is no value of its type.
/// @throws InputError "place: name: no value of its type (got 256)" if it is one of a position.
void LeaveOutField(const std::string& place,
                   std::string_view word,
                   CloudField& field,
                   std::vector<Remark>& remarks) {
  const std::string fault =
      ShownText(field.name) + ": no value of its type (got " + ShownText(word) + ")";
  const std::string name = LowerCase(field.plain_name());
  if (name == "x" || name == "y" || name == "z") throw InputError(place + ": " + fault);
  AddRemark({.kind = RemarkKind::kFieldsLeftOut, .place = place, .detail = fault}, remarks);
  field.name = kPaddingField;
}

}  // namespace

std::string_view CloudField::plain_name() const {
  constexpr std::string_view kCloudComparePrefix = "scalar_";
  std::string_view plain = name;
  if (plain.starts_with(kCloudComparePrefix)) plain.remove_prefix(kCloudComparePrefix.size());
  return plain;
}

const CloudField* Cloud::Find(std::string_view name) const {
  const auto found = std::ranges::find(fields, name, &CloudField::plain_name);
  return found == fields.end() ? nullptr : &*found;
}

void Cloud::AddField(std::string name, NumberType type, std::uint32_t count) {
  fields.push_back({.name = std::move(name), .offset = point_step, .type = type, .count = count});
  point_step += static_cast<std::uint32_t>(fields.back().num_bytes());
}

bool Cloud::AppendWords(const std::string& place, const std::vector<std::string_view>& words) {
  auto word = words.begin();
  for (CloudField& field : fields) {
    for (std::uint32_t i = 0; i < field.count; ++i, ++word) {
      if (word == words.end()) return false;
      VisitNumberType(field.type, [&](auto zero) {
        using Value = decltype(zero);
        // A number beyond float becomes infinite, as for C's own functions.
        using Parsed = std::conditional_t<std::is_floating_point_v<Value>, double, Value>;
        const auto parsed = ParseTextNumber<Parsed>(*word);
        if (!parsed && field.name != kPaddingField) LeaveOutField(place, *word, field, remarks);
        const auto value = static_cast<Value>(parsed.value_or(Parsed{0}));
        if constexpr (std::is_same_v<Value, float>) {
          const bool is_far = parsed && std::abs(*parsed) > kFarPosition_m;
          field.is_rounded = field.is_rounded || (is_far && double{value} != *parsed);
        }
        const auto* const bytes = reinterpret_cast<const std::uint8_t*>(&value);
        data.insert(data.end(), bytes, bytes + sizeof value);
      });
    }
  }
  return true;
}

bool Cloud::WidenRounded() {
  if (std::ranges::none_of(fields, &CloudField::is_rounded)) return false;
  point_step = 0;
  for (const CloudField& field : std::exchange(fields, {})) {
    AddField(field.name, field.is_rounded ? NumberType::kDouble : field.type, field.count);
  }
  data.clear();
  return true;
}

void SwapBytes(const Cloud& cloud, std::vector<std::uint8_t>& rows) {
  for (auto row = rows.begin(); row != rows.end(); row += cloud.point_step) {
    for (const CloudField& field : cloud.fields) {
      auto number = row + field.offset;
      for (std::uint32_t i = 0; i < field.count; ++i, number += SizeOf(field.type)) {
        std::reverse(number, number + SizeOf(field.type));
      }
    }
  }
}

std::vector<std::size_t> FieldSizes(const Cloud& cloud) {
  std::vector<std::size_t> sizes;
  for (const CloudField& field : cloud.fields) sizes.push_back(field.num_bytes());
  return sizes;
}

void Transpose(const std::vector<std::size_t>& part_sizes,
               std::size_t num_rows,
               const void* from,
               bool is_to_rows,
               void* to) {
  std::size_t row_size = 0;
  for (const std::size_t size : part_sizes) row_size += size;
  // The rows of a block stay in the first-level cache from one part to the next.
  constexpr std::size_t kBlock = 256;
  for (std::size_t first = 0; first < num_rows; first += kBlock) {
    const std::size_t num = std::min(kBlock, num_rows - first);
    std::size_t before = 0;
    for (const std::size_t size : part_sizes) {
      const std::size_t in_rows = first * row_size + before;
      const std::size_t in_parts = num_rows * before + first * size;
      const auto copy = size == 8   ? CopyValues<8>
                        : size == 4 ? CopyValues<4>
                        : size == 2 ? CopyValues<2>
                        : size == 1 ? CopyValues<1>
                                    : CopyValues<0>;
      copy(size, num,
           {static_cast<const char*>(from) + (is_to_rows ? in_parts : in_rows),
            is_to_rows ? size : row_size},
           {static_cast<char*>(to) + (is_to_rows ? in_rows : in_parts),
            is_to_rows ? row_size : size});
      before += size;
    }
  }
}

}  // namespace railcast
