#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/extras/insert/insert_record.h"
#include "generator/extras/insert/run/insert_run.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/made_sequence.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/insert/plan/plan_project.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;

/// A point of a cloud, and the ring that it came from.
struct CloudPoint {
  Eigen::Vector3f point_m;
  float intensity{};
  std::uint32_t ring{};
};

/// A frame as a driver gives it.
struct GivenFrame {
  std::vector<CloudPoint> points;
  Transform world_from_sensor;
  std::int64_t stamp_ns{};
};

/// Frames of a VLP-16 in a curve at 20 m/s.
const std::vector<GivenFrame>& SoundFrames() {
  static const std::vector<GivenFrame> frames = [] {
    const TemporaryDirectory folder;
    const MadeSequence made =
        MakeSequence(folder.path() / "run", {.sensor = "vlp16", .num_frames = 8});
    std::vector<GivenFrame> given;
    for (const Frame& frame : made.frames) {
      GivenFrame& next = given.emplace_back();
      next.world_from_sensor = frame.world_from_sensor;
      next.stamp_ns = frame.stamp_ns;
      for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
        if (!HasPoint(frame.outcome[slot])) continue;
        next.points.push_back({{frame.x[slot], frame.y[slot], frame.z[slot]},
                               frame.intensity[slot],
                               static_cast<std::uint32_t>(slot / frame.returns / frame.columns)});
      }
    }
    return given;
  }();
  return frames;
}

void WriteFrames(const fs::path& folder, const std::vector<GivenFrame>& frames) {
  fs::create_directories(folder);
  std::ostringstream lines;
  lines.precision(17);
  lines << "file,run,frame,stamp_ns,x,y,z,qx,qy,qz,qw,points,lost\n";
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::string name = std::to_string(i) + ".pcd";
    const std::string num = std::to_string(frames[i].points.size());
    std::ostringstream cloud;
    cloud.precision(9);
    cloud << "VERSION .7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n"
          << "WIDTH " << num << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << num
          << "\nDATA ascii\n";
    for (const CloudPoint& point : frames[i].points) {
      cloud << point.point_m.transpose() << ' ' << point.intensity << '\n';
    }
    WriteFileWhole(folder / name, cloud.str());
    const Vector3 place_m = frames[i].world_from_sensor.translation();
    const Eigen::Quaterniond turn(frames[i].world_from_sensor.linear());
    lines << name << ",1," << i << ',' << frames[i].stamp_ns << ',' << place_m.x() << ','
          << place_m.y() << ',' << place_m.z() << ',' << turn.x() << ',' << turn.y() << ','
          << turn.z() << ',' << turn.w() << ',' << num << ",0\n";
  }
  WriteFileWhole(folder / "frames.csv", lines.str());
}

/// A box put into a recording that something was done to.
class AttackedRun {
 public:
  explicit AttackedRun(const std::function<void(std::vector<GivenFrame>&)>& attack) {
    std::vector<GivenFrame> frames = SoundFrames();
    attack(frames);
    WriteFrames(Path("received"), frames);
    const std::string sensor = R"("fidelity": "plausibility", "lidar": {"file": ")" +
                               std::string(RAILCAST_SOURCE_DIR) +
                               R"(/scenarios/sensors/vlp16.json", "mount": {"position_m": )"
                               R"([2.2, 0.1, 2.5], "pitch_deg": 3}}, )";
    const fs::path file = WritePlan(folder_.path(), "{}",
                                    R"(, "objects": [{"name": "box", "type": "box", )"
                                    R"("size_m": [2, 2, 2], "s_m": 20, "d_m": 0, "h_m": 0}])",
                                    sensor);
    message_ = MessageOf([&] {
      const InsertPlan plan = ReadInsertPlan(file, Path("received"));
      remarks_ = plan.remarks;
      InsertChoices choices;
      choices.recording = Path("received");
      choices.directory = Path("out");
      (void)RunInsert(choices, plan, {[](std::uint32_t, std::uint32_t) {}, [] { return false; }});
    });
    const std::string own = folder_.path().string() + "/";
    for (std::size_t at = 0; (at = message_.find(own)) != message_.npos;) {
      message_.erase(at, own.size());
    }
  }

  [[nodiscard]] const std::string& message() const { return message_; }
  [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }
  /// Whether there is no more than the note which run it was to be.
  [[nodiscard]] bool has_written_no_frame() const {
    return !fs::exists(Path("out/manifest.json")) && !fs::exists(Path("out/points")) &&
           !fs::exists(Path("out/recording/0.pcd"));
  }
  /// Returns of the box in each frame.
  [[nodiscard]] std::vector<int> Returns() const {
    std::vector<int> returns;
    for (const nlohmann::json& box : Boxes()) returns.push_back(box.at("returns"));
    return returns;
  }
  /// Where it is before the sensor in each frame.
  [[nodiscard]] std::vector<Vector3> Centers() const {
    std::vector<Vector3> centers_m;
    for (const nlohmann::json& box : Boxes()) {
      const auto m = box.at("center_sensor_m").get<std::array<double, 3>>();
      centers_m.emplace_back(m[0], m[1], m[2]);
    }
    return centers_m;
  }
  /// The points that were added to a frame.
  [[nodiscard]] std::vector<CloudPoint> Added(int number) const {
    const fs::path file = Path("out/added") / ("00000" + std::to_string(number) + ".pcd");
    const Frame frame = ReadAll(file).at(0).frame;
    std::vector<CloudPoint> points;
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      if (std::isnan(frame.x[slot])) continue;
      points.push_back({{frame.x[slot], frame.y[slot], frame.z[slot]}, frame.intensity[slot], 0});
    }
    return points;
  }

 private:
  /// What insert.jsonl says of the box in each frame.
  [[nodiscard]] std::vector<nlohmann::json> Boxes() const {
    std::vector<nlohmann::json> boxes;
    std::istringstream lines(ReadFileWhole(Path("out/insert.jsonl")));
    for (std::string line; std::getline(lines, line);) {
      boxes.push_back(nlohmann::json::parse(line).at("objects").at(0));
    }
    return boxes;
  }
  [[nodiscard]] fs::path Path(const std::string& name) const { return folder_.path() / name; }

  TemporaryDirectory folder_;
  std::string message_;
  std::vector<std::string> remarks_;
};

const AttackedRun& SoundRun() {
  static const AttackedRun run([](std::vector<GivenFrame>&) {});
  return run;
}

TEST(InsertAttacks, TheBoxIsSeenInASoundRecording) {
  ASSERT_EQ(SoundRun().message(), "no error");
  EXPECT_EQ(SoundRun().Returns().size(), 8U);
  EXPECT_THAT(SoundRun().Returns(), testing::Each(testing::Gt(20)));
}

// A clock that is set during a run jumps by years: what moves is not followed through them.
TEST(InsertAttacks, AClockThatJumpsByYearsCostsNoTime) {
  const AttackedRun run([](std::vector<GivenFrame>& frames) {
    for (std::size_t i = 4; i < frames.size(); ++i) {
      frames[i].stamp_ns += 1'700'000'000'000'000'000;
    }
  });
  EXPECT_EQ(run.Returns().size(), SoundRun().Returns().size());
}

TEST(InsertAttacks, AfterAHoleInTimeTheBoxIsWhereItIsWithoutOne) {
  const AttackedRun run([](auto& frames) { frames.erase(frames.begin() + 2, frames.begin() + 6); });
  ASSERT_EQ(run.message(), "no error");
  EXPECT_THAT(run.remarks(), Contains(HasSubstr("1 gap in the recording's times, the one of 0.5 s "
                                                "before ")));
  const std::vector<Vector3> sound = SoundRun().Centers();
  const std::vector<Vector3> centers = run.Centers();
  ASSERT_EQ(centers.size(), 4U);
  // The line is a spline through other places of the same way, and ends before the box.
  constexpr double kLine_m = 0.02;
  for (const auto& [frame, before] :
       {std::pair<std::size_t, std::size_t>{0, 0}, {1, 1}, {2, 6}, {3, 7}}) {
    EXPECT_LT((centers.at(frame) - sound.at(before)).norm(), kLine_m);
  }
}

TEST(InsertAttacks, PosesAndTimesThatJumpAreNamed) {
  const AttackedRun jump(
      [](auto& frames) { frames[3].world_from_sensor.translation().y() += 80.0; });
  EXPECT_THAT(
      jump.message(),
      HasSubstr("3.pcd: pose: must not jump: at most 150 m/s from the one before it (got "));
  EXPECT_TRUE(jump.has_written_no_frame());
  const AttackedRun back([](auto& frames) { frames[3].stamp_ns -= 250'000'000; });
  EXPECT_EQ(
      back.message(),
      "received/3.pcd: stamp: must be after that of the frame before it (got -0.15 s after it)");
  EXPECT_TRUE(back.has_written_no_frame());
}

TEST(InsertAttacks, PosesInTheAxesOfACameraAreNamed) {
  const AttackedRun run([](auto& frames) {
    Eigen::Matrix3d vehicle_from_camera;
    vehicle_from_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    for (GivenFrame& frame : frames) frame.world_from_sensor.linear() *= vehicle_from_camera;
  });
  EXPECT_THAT(run.message(), HasSubstr("0.pcd: pose: the vehicle's z axis must point up (got "));
  EXPECT_TRUE(run.has_written_no_frame());
}

TEST(InsertAttacks, PointsInOtherAxesAreNoFirings) {
  const AttackedRun run([](auto& frames) {
    for (GivenFrame& frame : frames) {
      for (CloudPoint& point : frame.points) std::swap(point.point_m.x(), point.point_m.z());
    }
  });
  EXPECT_THAT(run.message(), HasSubstr("0.pcd: its firings cannot be found: "));
  EXPECT_TRUE(run.has_written_no_frame());
}

TEST(InsertAttacks, PointsOfTwoSensorsAreNoFirings) {
  const AttackedRun run([](auto& frames) {
    for (GivenFrame& frame : frames) {
      const std::vector<CloudPoint> own = frame.points;
      for (CloudPoint other : own) {
        const Eigen::AngleAxisf turn(0.64F, Eigen::Vector3f::UnitZ());
        other.point_m = turn * other.point_m + Eigen::Vector3f(0.0F, 1.0F, 0.0F);
        frame.points.push_back(other);
      }
    }
  });
  EXPECT_THAT(run.message(), HasSubstr("0.pcd: its firings cannot be found: "));
  EXPECT_TRUE(run.has_written_no_frame());
}

TEST(InsertAttacks, RingsThatAreMissingReturnTheBoxAllTheSame) {
  const AttackedRun run([](auto& frames) {
    for (GivenFrame& frame : frames) {
      std::erase_if(frame.points, [](const CloudPoint& point) { return point.ring % 3 == 0; });
    }
  });
  ASSERT_EQ(run.message(), "no error");
  const std::vector<int> sound = SoundRun().Returns();
  const std::vector<int> returns = run.Returns();
  ASSERT_EQ(returns.size(), sound.size());
  // Whether the azimuths at the box's edges are on it is uncertain without the rings beside them.
  for (std::size_t i = 0; i < sound.size(); ++i) EXPECT_NEAR(returns[i], sound[i], 0.04 * sound[i]);
}

TEST(InsertAttacks, IntensitiesOfBytesStayBytes) {
  const AttackedRun run([](auto& frames) {
    for (GivenFrame& frame : frames) {
      for (CloudPoint& point : frame.points) point.intensity *= 255.0F;
    }
  });
  ASSERT_EQ(run.message(), "no error");
  EXPECT_THAT(run.remarks(), Contains(HasSubstr("255")));
  EXPECT_EQ(run.Returns(), SoundRun().Returns());
  const std::vector<CloudPoint> bytes = run.Added(0);
  const std::vector<CloudPoint> shares = SoundRun().Added(0);
  ASSERT_EQ(bytes.size(), shares.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    EXPECT_NEAR(bytes[i].intensity, 255.0F * shares[i].intensity, 0.5F);
  }
}

TEST(InsertAttacks, AFrameOfHardlyAPointIsNamed) {
  const AttackedRun run([](auto& frames) { frames[4].points.resize(1); });
  EXPECT_EQ(run.message(),
            "received/4.pcd: its firings cannot be found: it has no field ring, and its elevations "
            "do not form rings");
}

}  // namespace
}  // namespace railcast
