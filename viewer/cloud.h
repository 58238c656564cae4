#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

// Its header does not go with X11's.
namespace pcl {
struct PCLPointCloud2;
}

namespace railcast {

/// The points of one file. Slots without a position (NaN) are left out.
struct Cloud {
  std::vector<float> positions_m;  ///< x, y, z of each point in turn.
  /// Of each point, those that the file has: label, outcome, intensity, range_m.
  std::map<std::string, std::vector<double>> fields;

  [[nodiscard]] std::size_t size() const { return positions_m.size() / 3; }
};

/// @param place Where the points are from, for faults.
/// @throws InputError with one line if there is no x, y, z.
[[nodiscard]] Cloud MakeCloud(const pcl::PCLPointCloud2& points, const std::string& place);

/// @param file .pcd or .ply, ours or another's; scalar_label counts as label, as CloudCompare has
/// it.
/// @throws InputError with one line if the file cannot be read or has no x, y, z.
[[nodiscard]] Cloud ReadCloud(const std::filesystem::path& file);

/// The file to show: `source` itself, or frame `frame` of the sequence directory `source` (the
/// first frame if not given).
/// @throws InputError if there is none.
[[nodiscard]] std::filesystem::path FindCloudFile(const std::filesystem::path& source,
                                                  std::optional<std::uint32_t> frame);

}  // namespace railcast
