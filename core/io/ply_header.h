#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace railcast {

/// A scalar property of a PLY element.
struct PlyProperty {
  std::string name;
  std::uint8_t pcl_type{};  ///< pcl::PCLPointField's code.
  std::size_t size{};       ///< Bytes.
};

/// Where the points of a PLY file are and what they carry.
struct PlyHeader {
  bool is_ascii{};
  std::vector<PlyProperty> properties;  ///< Of element vertex.
  std::uint64_t num_points{};
  /// Binary: the byte where the points begin. ASCII: the line after the header, in bytes too.
  std::size_t points_begin{};

  /// Bytes of one point in a binary file, unpadded.
  [[nodiscard]] std::size_t PointStep() const;
};

/// Reads the header of a PLY file held in `bytes` and checks that all its points are there.
///
/// Element vertex must have scalar properties and come first, as in every cloud we know of; other
/// elements (faces, camera) may follow and are not read.
/// @param file Named in errors.
/// @throws InputError with one line: "file: place: rule (got value)".
[[nodiscard]] PlyHeader CheckPly(const std::string& file, std::string_view bytes);

}  // namespace railcast
