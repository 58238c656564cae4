#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace railcast {

/// The type in which a number is stored. The first eight have the numbers of pcl::PCLPointField and
/// of StreamType.
enum class NumberType : std::uint8_t {
  kInt8 = 1,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kFloat,
  kDouble,
  kInt64,
  kUint64
};

/// Calls `visit` with a zero of the type and returns what it returns.
template <typename Visitor>
auto VisitNumberType(NumberType type, Visitor&& visit) {
  switch (type) {
    case NumberType::kInt8:
      return visit(std::int8_t{});
    case NumberType::kUint8:
      return visit(std::uint8_t{});
    case NumberType::kInt16:
      return visit(std::int16_t{});
    case NumberType::kUint16:
      return visit(std::uint16_t{});
    case NumberType::kInt32:
      return visit(std::int32_t{});
    case NumberType::kUint32:
      return visit(std::uint32_t{});
    case NumberType::kInt64:
      return visit(std::int64_t{});
    case NumberType::kUint64:
      return visit(std::uint64_t{});
    case NumberType::kFloat:
      return visit(float{});
    case NumberType::kDouble:
      break;
  }
  return visit(double{});
}

/// The size of a number, bytes.
[[nodiscard]] inline std::uint32_t SizeOf(NumberType type) {
  return VisitNumberType(type, [](auto zero) { return std::uint32_t{sizeof zero}; });
}

/// The two names of each of the first eight types in PLY files, of which the first are written.
inline constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kPlyTypeNames = {
    {{"char", "int8"},
     {"uchar", "uint8"},
     {"short", "int16"},
     {"ushort", "uint16"},
     {"int", "int32"},
     {"uint", "uint32"},
     {"float", "float32"},
     {"double", "float64"}}};

[[nodiscard]] constexpr std::string_view PlyTypeName(NumberType type) {
  return kPlyTypeNames.at(static_cast<std::size_t>(type) - 1).first;
}

/// The type that PLY files call by either of its names.
[[nodiscard]] inline std::optional<NumberType> PlyTypeNamed(std::string_view name) {
  for (std::size_t i = 0; i < kPlyTypeNames.size(); ++i) {
    const auto& [written, other] = kPlyTypeNames[i];
    if (name == written || name == other) return NumberType(i + 1);
  }
  return std::nullopt;
}

}  // namespace railcast
