#include "analysis/receive/received_files.h"

#include <pcl/io/pcd_io.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <limits>
#include <string>
#include <system_error>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/stream/stream_clouds.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

constexpr char kIndexName[] = "frames.csv";

std::string PcdBytes(const ReceivedFrame& frame) {
  const pcl::PCLPointCloud2 cloud = MakePclCloud(frame);
  std::string bytes = pcl::PCDWriter().generateHeaderBinary(cloud, Eigen::Vector4f::Zero(),
                                                            Eigen::Quaternionf::Identity());
  bytes += "DATA binary\n";
  bytes.append(cloud.data.begin(), cloud.data.end());
  return bytes;
}

void PutPose(const Transform& pose, std::ostream& line) {
  const Vector3 position_m = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  for (const double value :
       {position_m.x(), position_m.y(), position_m.z(), q.x(), q.y(), q.z(), q.w()}) {
    line << ',' << value;
  }
}

}  // namespace

ReceivedFiles::ReceivedFiles(const std::filesystem::path& directory) : directory_(directory) {
  std::error_code error;
  std::filesystem::create_directories(directory_ / "frames", error);
  if (error) throw FileError(directory_, error.value());
  const std::filesystem::path index = directory_ / kIndexName;
  if (std::filesystem::exists(index)) {
    throw InputError(ShownPath(index) + ": must not exist: a recording is there already");
  }
  lines_.open(index);
  lines_.precision(std::numeric_limits<double>::max_digits10);
  lines_ << "file,run,frame,stamp_ns,x,y,z,qx,qy,qz,qw,points,lost_points,"
            "end_time_ns,end_x,end_y,end_z,end_qx,end_qy,end_qz,end_qw\n"
         << std::flush;
  if (!lines_) throw FileError(index, errno);
}

void ReceivedFiles::Write(const ReceivedFrame& frame) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "frames/%06u.pcd", num_files_++);
  WriteFileWhole(directory_ / name.data(), PcdBytes(frame));
  const StreamHeader& header = frame.header;
  lines_ << name.data() << ',' << header.run << ',' << header.frame << ',' << header.stamp_ns;
  PutPose(header.world_from_sensor, lines_);
  lines_ << ',' << frame.num_points() << ',' << header.num_points - frame.num_points();
  // In other axes, points have no motion of the sensor to be undone.
  if (header.axes == StreamAxes::kSensor && !header.is_left_handed) {
    lines_ << ',' << header.duration_ns;
    PutPose(header.world_from_sensor_end, lines_);
  }
  lines_ << '\n' << std::flush;
  if (!lines_) throw FileError(directory_ / kIndexName, errno);
}

}  // namespace railcast
