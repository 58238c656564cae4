#include "viewer/cloud_source.h"

#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include "core/base/error.h"

namespace railcast {

pcl::PCLPointCloud2 ReadPointFile(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) {
    throw InputError(file.string() + ": no such file or directory");
  }
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // The one line below says it.
  pcl::PCLPointCloud2 points;
  int result = 0;
  if (file.extension() == ".pcd") {
    result = pcl::PCDReader().read(file.string(), points);
  } else if (file.extension() == ".ply") {
    result = pcl::PLYReader().read(file.string(), points);
  } else {
    throw InputError(file.string() + ": must be a .pcd or .ply file");
  }
  if (result < 0) throw InputError(file.string() + ": is damaged or no point cloud");
  return points;
}

}  // namespace railcast
