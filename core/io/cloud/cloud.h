#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/base/number_type.h"

namespace pcl {
struct PCLPointCloud2;
}

namespace railcast {

struct CloudField {
  std::string name;
  std::uint32_t offset{};  ///< In a point, bytes.
  NumberType type{};
  std::uint32_t count = 1;  ///< Numbers of a point.
};

/// Points with named fields, stored point after point: of the shape of
/// pcl::PCLPointCloud2, so that only what speaks to PCL needs its headers.
struct Cloud {
  std::uint32_t height{};
  std::uint32_t width{};
  std::vector<CloudField> fields;
  std::uint32_t point_step{};      ///< Bytes of a point.
  bool is_dense{};                 ///< Whether all floating-point numbers are finite.
  std::vector<std::uint8_t> data;  ///< Rows without gaps between them.

  [[nodiscard]] std::size_t num_points() const { return std::size_t{width} * height; }
  /// Adds a field behind the others.
  void AddField(std::string name, NumberType type, std::uint32_t count = 1) {
    fields.push_back({std::move(name), point_step, type, count});
    const std::size_t size = VisitNumberType(type, [](auto zero) { return sizeof zero; });
    point_step += static_cast<std::uint32_t>(size * count);
  }
};

/// The cloud as PCL has it; the header stays empty.
[[nodiscard]] pcl::PCLPointCloud2 ToPcl(Cloud cloud);

}  // namespace railcast
