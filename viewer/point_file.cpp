#include "viewer/point_file.h"

#include "core/base/error.h"
#include "core/io/pcd_reader.h"
#include "core/io/ply_reader.h"

namespace railcast {

pcl::PCLPointCloud2 ReadPointFile(const std::filesystem::path& file) {
  if (file.extension() == ".pcd") return ReadPcd(file);
  if (file.extension() == ".ply") return ReadPly(file);
  throw InputError(file.string() + ": must be a .pcd or .ply file");
}

}  // namespace railcast
