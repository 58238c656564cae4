#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/cloud/point_table.h"

namespace railcast {

/// The points of a cloud as rows, one for each point, of which some can be changed, left out and
/// added while all others stay as they are, byte for byte.
struct CloudRows {
  /// Where a row has the number of a column.
  struct Cell {
    NumberType type{};
    std::size_t place{};  ///< Of its first byte, or in text of its word.
  };

  PointTable table;                      ///< The same points as numbers.
  std::vector<Cell> cells;               ///< One for each column of the table.
  std::string bytes;                     ///< The rows, one after another.
  std::size_t row_bytes{};               ///< Length of a row; 0 in text.
  std::size_t num_words{};               ///< Of a row of text.
  std::vector<std::size_t> line_begins;  ///< Text only: of each row, and the end of the last.

  [[nodiscard]] bool is_text() const { return row_bytes == 0; }
  /// A row; in text with the end of its line, if it has one.
  [[nodiscard]] std::string_view Row(std::size_t i) const {
    const std::string_view all = bytes;
    if (!is_text()) return all.substr(i * row_bytes, row_bytes);
    return all.substr(line_begins[i], line_begins[i + 1] - line_begins[i]);
  }
};

/// A cloud file taken apart.
struct CloudParts {
  CloudRows rows;
  std::string header;
  std::string tail;            ///< What follows the points, such as the faces of a PLY file.
  std::string_view extension;  ///< ".pcd", ".ply" or ".bin".
  bool is_compressed{};        ///< PCD: the rows are compressed, field by field.
  std::vector<std::size_t> field_bytes;  ///< PCD: of each field in a row.
  bool has_labels{};  ///< KITTI: the last four bytes of each row are its entry in the .label file.
};

/// Takes a .pcd, .ply or .bin file apart.
/// @param file Named in errors; says by its extension what it is.
/// @param labels KITTI: the bytes of the .label file beside it.
/// @throws InputError with one line if the file is damaged.
[[nodiscard]] CloudParts TakeCloudApart(const std::string& file,
                                        std::string bytes,
                                        const std::optional<std::string>& labels);

/// Puts a file together again, and the .label file if there is one, with other rows.
/// @param rows Of the form that parts.rows has; lines of text end with a line end.
/// @param num_rows How many there are. It must be as many as before if the cloud is organised.
[[nodiscard]] std::vector<std::string> PutCloudTogether(const CloudParts& parts,
                                                        const std::string& rows,
                                                        std::size_t num_rows);

}  // namespace railcast
