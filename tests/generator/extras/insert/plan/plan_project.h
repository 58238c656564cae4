#pragma once

#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "railcast/transform.h"

namespace railcast {

/// Writes a plan that puts these things into a recording.
/// @param recording The section `world.recording`. @param rest Further keys of `world`, each behind
///   a comma. @param sensor The plan's `lidar`, with a comma behind it, or nothing.
inline std::filesystem::path WritePlan(const std::filesystem::path& folder,
                                       const std::string& recording,
                                       const std::string& rest,
                                       const std::string& sensor = "") {
  const std::string scenarios = RAILCAST_SOURCE_DIR "/scenarios/";
  const std::filesystem::path file = folder / "plan.json";
  WriteFileWhole(file, R"({"version": 1, )" + sensor + R"("world": {"recording": )" + recording +
                           rest + R"(}, "materials": ")" + scenarios +
                           R"(materials/railway.json", "labels": ")" + scenarios +
                           "labels.json\"}\n");
  return file;
}

/// The sensor of a plan, 2.5 m above the rails.
inline std::string VelodyneOfPlan() {
  return R"("lidar": ")" RAILCAST_SOURCE_DIR R"(/scenarios/sensors/vlp16.json", )";
}

/// A frame of a recording with poses.
struct PosedCloud {
  double time_s{};
  Vector3 position_m = Vector3::Zero();
  double heading_rad{};
};

/// Writes what railcast-analyze receive writes: clouds with poses, each the same few points.
/// @param points The cloud as lines of ASCII PCD.
inline std::filesystem::path WriteReceived(const std::filesystem::path& folder,
                                           const std::vector<PosedCloud>& clouds,
                                           const std::vector<std::string>& points = {"5 0 -1"}) {
  std::filesystem::create_directories(folder);
  std::string pcd = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " +
                    std::to_string(points.size()) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
                    std::to_string(points.size()) + "\nDATA ascii\n";
  for (const std::string& point : points) pcd += point + '\n';
  WriteFileWhole(folder / "cloud.pcd", pcd);
  std::string lines = "file,run,frame,stamp_ns,x,y,z,qx,qy,qz,qw,points,lost\n";
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    const PosedCloud& cloud = clouds[i];
    const Vector3& p = cloud.position_m;
    std::ostringstream line;
    line.precision(17);
    line << "cloud.pcd,1," << i << ',' << std::llround(cloud.time_s * 1e9) << ',' << p.x() << ','
         << p.y() << ',' << p.z() << ",0,0," << std::sin(0.5 * cloud.heading_rad) << ','
         << std::cos(0.5 * cloud.heading_rad) << ",1,0\n";
    lines += line.str();
  }
  WriteFileWhole(folder / "frames.csv", lines);
  return folder;
}

/// Frames 0.1 s apart of a straight run eastwards, with the sensor 2.5 m above the rails.
inline std::vector<PosedCloud> StraightRun(std::size_t num_frames, double speed_mps) {
  std::vector<PosedCloud> clouds;
  for (std::size_t i = 0; i < num_frames; ++i) {
    const double time_s = 0.1 * static_cast<double>(i);
    clouds.push_back({5.0 + time_s, {speed_mps * time_s, 0.0, 2.5}});
  }
  return clouds;
}

}  // namespace railcast
