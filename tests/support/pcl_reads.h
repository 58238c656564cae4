#pragma once

#include <gtest/gtest.h>
#include <pcl/PCLPointCloud2.h>
#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <filesystem>
#include <type_traits>

namespace railcast {

/// What PCL reads of a PCD or PLY file: all fields, or the points of that type.
template <typename PclCloud = pcl::PCLPointCloud2>
[[nodiscard]] PclCloud PclReads(const std::filesystem::path& file) {
  pcl::PCLPointCloud2 fields;
  EXPECT_EQ(file.extension() == ".ply" ? pcl::io::loadPLYFile(file.string(), fields)
                                       : pcl::io::loadPCDFile(file.string(), fields),
            0)
      << file;
  if constexpr (std::is_same_v<PclCloud, pcl::PCLPointCloud2>) {
    return fields;
  } else {
    PclCloud points;
    pcl::fromPCLPointCloud2(fields, points);
    return points;
  }
}

}  // namespace railcast
