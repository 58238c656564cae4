#pragma once

#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <future>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "core/io/net/udp.h"
#include "core/io/write_file.h"
#include "railcast/io/cloud_files.h"
#include "railcast/io/stream.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/run_command.h"
#include "tests/support/loopback.h"

namespace railcast {

inline constexpr int kPatience_ms = 20'000;

// A coarse scan at 20 Hz of a wagon 40 m ahead of a vehicle at 10 m/s, in vehicle axes.
inline std::string CoarseScenario(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "coarse.json";
  WriteFileWhole(file, R"({
    "version": 1,
    "fidelity": "surface",
    "lidar": {"name": "coarse", "range_max_m": 100, "mount": {"position_m": [1, 0, 2.5]},
              "scan": {"rate_hz": 20, "pattern": {"type": "raster", "horizontal_fov_deg": 40,
                       "vertical_fov_deg": 20, "angular_resolution_deg": 0.5}}},
    "world": {
      "alignment": {
        "course": {"type": "elements", "elements": [{"type": "straight", "length_m": 600}]}
      },
      "catenary": {"enabled": false},
      "vegetation": {"trees_per_hectare": 0, "grass": false},
      "objects": [{"name": "wagon", "type": "open_wagon", "s_m": 250}]
    },
    "vehicle": {"start_s_m": 200, "motion": {"profile": [{"time_s": 0, "speed_mps": 10}]}},
    "output": {"frame": "vehicle"},
    "materials": ")" + kScenariosFolder +
                           R"(materials/railway.json",
    "labels": ")" + kScenariosFolder +
                           R"(labels.json"
  })");
  return file.string();
}

/// Returns a port that is free now and has just been assigned by the kernel.
inline std::string FreePort() {
  return std::to_string(UdpReceiver(kAnyLoopbackPort).at().port);
}

/// A running `railcast-generate stream`.
class Stream {
 public:
  explicit Stream(const std::string& arguments)
      : run_(std::async(std::launch::async,
                        [arguments] { return GenerateLive("stream " + arguments); })) {}

  [[nodiscard]] Ended Wait() { return run_.get(); }

 private:
  std::future<Ended> run_;
};

/// What makes the shell note a stream's process in a file, and wait for it.
inline std::string NotedIn(const std::filesystem::path& pid_file) {
  return " & echo $! > " + pid_file.string() + "; wait $!; exit $?";
}
inline void Interrupt(const std::filesystem::path& pid_file) {
  ::kill(std::stoi(ReadFileWhole(pid_file)), SIGINT);
}

/// A controller that drives a vehicle in lockstep.
class Controller {
 public:
  explicit Controller(const std::string& port) : to_(ParseEndpoint("127.0.0.1:" + port, 1)) {}

  /// Sends a command until it is answered and returns the answer; empty if there is none.
  std::string Say(const std::string& command) {
    const std::string id = R"("session":"test","id":)" + std::to_string(++id_) + ",";
    for (int attempt = 0; attempt < 200; ++attempt) {
      port_.Answer("{" + id + command.substr(1), to_);
      const auto answer = port_.Receive(100);
      if (!answer) continue;
      const std::string text(answer->bytes.begin(), answer->bytes.end());
      if (text.find(id) != std::string::npos) return text;
    }
    return "";
  }

 private:
  UdpReceiver port_{kAnyLoopbackPort};
  Endpoint to_;
  int id_ = 0;
};

/// Expects a received frame to hold exactly the returned points of a PCD frame, by x, y and z.
inline void ExpectSamePoints(const ReceivedFrame& received, const std::filesystem::path& pcd_file) {
  const pcl::PCLPointCloud2 cloud = ReadPcd(pcd_file);
  ASSERT_TRUE(received.is_complete());
  const auto value_of = [&](const std::string& name, std::size_t i) {
    for (const auto& field : cloud.fields) {
      if (field.name != name) continue;
      float value = 0;
      std::memcpy(&value, &cloud.data[i * cloud.point_step + field.offset], sizeof value);
      return value;
    }
    return std::numeric_limits<float>::quiet_NaN();
  };
  std::multiset<std::vector<float>> expected;
  for (std::size_t i = 0; i < std::size_t{cloud.width} * cloud.height; ++i) {
    if (std::isnan(value_of("x", i))) continue;
    expected.insert(
        {value_of("x", i), value_of("y", i), value_of("z", i), value_of("intensity", i)});
  }
  std::multiset<std::vector<float>> got;
  for (std::size_t i = 0; i < received.num_points(); ++i) {
    std::vector<float> point;
    for (const char* name : {"x", "y", "z", "intensity"}) {
      point.push_back(received.At<float>(*received.header.Find(name), i));
    }
    got.insert(point);
  }
  EXPECT_GT(got.size(), 100U);
  EXPECT_EQ(got, expected);
}

}  // namespace railcast
