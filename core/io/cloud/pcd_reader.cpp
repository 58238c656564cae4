#include "railcast/io/cloud_files.h"

#include <pcl/io/pcd_io.h>

#include <sstream>
#include <string>

#include "core/base/error.h"
#include "core/base/out_of_memory.h"
#include "core/base/text.h"
#include "core/io/cloud/pcd_header.h"
#include "core/io/write_file.h"

namespace railcast {

namespace {

pcl::PCLPointCloud2 ParsePcd(const std::filesystem::path& file, const std::string& bytes) {
  const PcdHeader header = CheckPcd(ShownPath(file), bytes);

  pcl::PCDReader reader;
  pcl::PCLPointCloud2 cloud;
  Eigen::Vector4f origin;
  Eigen::Quaternionf orientation;
  int version = 0;
  int data_type = 0;
  unsigned int data_begin = 0;
  std::istringstream stream(bytes);
  int status =
      reader.readHeader(stream, cloud, origin, orientation, version, data_type, data_begin);
  if (status == 0 && header.data == "ascii") {
    stream.clear();
    stream.seekg(static_cast<std::streamoff>(header.data_begin));
    status = reader.readBodyASCII(stream, cloud, version);
  } else if (status == 0) {
    status = reader.readBodyBinary(reinterpret_cast<const unsigned char*>(bytes.data()), cloud,
                                   version, header.data == "binary_compressed",
                                   static_cast<unsigned int>(header.data_begin));
  }
  if (status != 0) throw InputError(ShownPath(file) + ": PCL cannot read this PCD file");
  return cloud;
}

}  // namespace

pcl::PCLPointCloud2 ReadPcd(const std::filesystem::path& file) {
  return WithinMemory([&] { return ReadingText(file); },
                      [&] { return ParsePcd(file, ReadFileWhole(file)); });
}

}  // namespace railcast
