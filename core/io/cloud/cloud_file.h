#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/cloud/cloud.h"

namespace railcast {

/// How a file stores points.
enum class PointStorage : std::uint8_t {
  kRows,    ///< Point after point.
  kFields,  ///< PCD: field after field, compressed.
  kText,    ///< A line for each point.
};

/// A cloud file that has been read, and what it takes to write it again with other points. Refers
/// to the file's bytes.
struct CloudFile {
  Cloud cloud;
  PointStorage storage{};
  std::string_view header;
  std::string_view points;    ///< As stored, but for KITTI; behind lines of points may be others.
  std::string_view tail;      ///< What follows them, such as the faces of a PLY file.
  std::size_t label_bytes{};  ///< KITTI: at the end of each point, from the file of the labels.
  bool is_big_endian{};       ///< PLY: the byte order of the points as stored.
  /// nuScenes: whether points as stored have x to the right and y forward. The cloud's are turned.
  bool is_turned{};
};

// Each of FrameFormat::parse (railcast/io/cloud_files.h). `file` is named in errors, which are
// InputErrors with one line: "file: place: rule (got value)".

/// Reads a PCD file held in `bytes`, of any encoding. Keys may be in any case, fields of COUNT 0
/// are none, and text has all its digits, whatever SIZE says (Cloud::WidenRounded()).
[[nodiscard]] CloudFile ParsePcdFile(const std::string& file,
                                     std::string_view bytes,
                                     const std::optional<std::string>& second = {});

/// Reads a PLY file held in `bytes`, ASCII or binary, in either byte order. Element vertex must
/// have only scalar properties, as in all known point clouds; other elements (faces, camera) are
/// passed over, but nothing may stand behind them.
[[nodiscard]] CloudFile ParsePlyFile(const std::string& file,
                                     std::string_view bytes,
                                     const std::optional<std::string>& second = {});

/// Reads KITTI's velodyne/*.bin held in `bytes`: float32 x, y, z, remission of each point. With
/// `labels`, the bytes of SemanticKITTI's .label (one uint32 per point: label in the lower half,
/// instance in the upper), label and instance become fields as well. The file does not say what its
/// numbers are: where the values are not those of four a point, the error names what fits.
[[nodiscard]] CloudFile ParseKittiFile(const std::string& file,
                                       std::string_view bytes,
                                       const std::optional<std::string>& labels);

/// Whether it is a choice of the numbers of a point in .bin files: 3 to 16 (float32 x y z intensity
/// and others), "nuscenes" (x y z intensity ring), "waymo" (x y z intensity elongation timestamp)
/// or "float64" (x y z intensity).
[[nodiscard]] bool IsKittiColumns(std::string_view choice);

/// As ParseKittiFile(), with the numbers of a point that were chosen. nuScenes' points are turned
/// into the axes x forward, y left.
/// @pre IsKittiColumns(choice).
[[nodiscard]] CloudFile ParseKittiColumns(const std::string& file,
                                          std::string_view bytes,
                                          const std::optional<std::string>& labels,
                                          std::string_view choice);

/// Turns float32 x and y, with which rows begin, from x right, y forward to x forward, y left.
void TurnLeft(const Cloud& cloud, std::vector<std::uint8_t>& rows);

/// Parses a cloud file by the ending of its name.
/// @param columns One of IsKittiColumns(); empty = none was chosen.
[[nodiscard]] CloudFile ParseCloudFile(const std::filesystem::path& file,
                                       std::string_view bytes,
                                       const std::optional<std::string>& second,
                                       const std::string& columns);

/// Returns the file of the labels of a .bin file, ../labels/NAME.label, if it is there.
[[nodiscard]] std::optional<std::filesystem::path> SecondFileOf(const std::filesystem::path& file);

/// Reads a cloud file. A .bin file takes its labels from ../labels if they are there.
/// @param columns One of IsKittiColumns() or, of text, IsTextColumns(); empty = none was chosen.
/// @throws InputError with one line if the file is not a .pcd, .ply, .bin, .las or IsTextCloud(),
///   cannot be read, is damaged, or says that its positions are not in metres.
[[nodiscard]] Cloud ReadCloud(const std::filesystem::path& file, const std::string& columns = {});

/// Throws if a comment of a header says that its unit of length is another than metres, as in
/// "# units: mm".
void CheckUnitComment(const std::string& file, std::string_view comment);

/// Points to write into a file in place of its own.
struct OtherPoints {
  std::vector<std::uint8_t> data;  ///< Rows, as the file's cloud has them.
  /// For each row the point of the file that it was, or kNoSource. Text keeps the words of numbers
  /// that are as they were.
  std::vector<std::uint32_t> sources;
};
inline constexpr std::uint32_t kNoSource = ~std::uint32_t{0};

/// Returns the bytes of the file with other points and, of KITTI's, those of the file of the
/// labels.
/// @pre There are as many points as before if the cloud is organised.
[[nodiscard]] std::vector<std::string> Rewritten(const CloudFile& file, const OtherPoints& points);

}  // namespace railcast
