#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/number_type.h"
#include "core/io/cloud/cloud.h"

namespace railcast {

/// A scalar property of a PLY element.
struct PlyProperty {
  std::string name;
  NumberType type{};
  std::size_t size{};  ///< Size in bytes.
};

/// Where the points of a PLY file are and which properties they have.
struct PlyHeader {
  bool is_ascii{};
  std::vector<PlyProperty> properties;  ///< The properties of element vertex.
  std::uint64_t num_points{};
  /// Offset in bytes at which the points begin; in an ASCII file, the first line after the header.
  std::size_t points_begin{};

  /// Returns the size of one point in a binary file in bytes, without padding.
  [[nodiscard]] std::size_t PointStep() const;
};

/// Reads the header of a PLY file held in `bytes` and checks that all its points are there.
///
/// Element vertex must come first and have only scalar properties, as in all known point clouds;
/// other elements (faces, camera) may follow and are not read.
/// @param file Named in errors.
/// @throws InputError with one line: "file: place: rule (got value)".
[[nodiscard]] PlyHeader CheckPly(const std::string& file, std::string_view bytes);

/// Reads the points of a PLY file held in `bytes`, as ReadPly() (railcast/io/cloud_files.h) does.
[[nodiscard]] Cloud ParsePlyCloud(const std::string& file, const std::string& bytes);

}  // namespace railcast
