#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/number_type.h"
#include "core/io/cloud/cloud.h"

namespace railcast {

/// One entry of a PCD file's FIELDS, SIZE, TYPE and COUNT lines.
struct PcdField {
  std::string name;
  std::uint64_t size{};   ///< Size of one element in bytes: 1, 2, 4 or 8.
  char type{};            ///< 'I', 'U' or 'F'.
  std::uint64_t count{};  ///< Number of elements.

  [[nodiscard]] NumberType number_type() const;
};

/// The header of a PCD v0.7 (or 0.6 with the same keys) file.
struct PcdHeader {
  std::vector<PcdField> fields;
  std::uint64_t width{};
  std::uint64_t height{};
  std::uint64_t points{};
  std::string data;          ///< "ascii", "binary" or "binary_compressed".
  std::size_t data_begin{};  ///< Offset in the file at which the points begin.

  /// Returns the size of one point in bytes.
  [[nodiscard]] std::uint64_t PointStep() const;
};

/// Reads the header of a PCD file held in `bytes` and checks it against the length of the points: a
/// damaged file gives an error here.
/// @param file Named in errors.
/// @param plain Receives the points of a compressed file: each field for all points, one field
///   after another.
/// @throws InputError with one line: "file: key: rule (got value)".
[[nodiscard]] PcdHeader CheckPcd(const std::string& file,
                                 std::string_view bytes,
                                 std::string* plain = nullptr);

/// Packs the numbers of an ASCII file as in a binary one: point after point, fields in order.
/// @pre CheckPcd() has accepted the text.
[[nodiscard]] std::string PackAscii(std::string_view text, const PcdHeader& header);

/// Reads a PCD file, as ReadPcd() (railcast/io/cloud_files.h) does.
[[nodiscard]] Cloud ReadPcdCloud(const std::filesystem::path& file);

}  // namespace railcast
