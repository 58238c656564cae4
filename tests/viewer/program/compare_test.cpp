#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/viewer/program/drawn_points.h"
#include "tests/viewer/program/recorded_run.h"
#include "tests/viewer/program/view_program.h"
#include "viewer/color/palette.h"
#include "viewer/composition/composer.h"

namespace railcast {
namespace {

// Points are squares of 2 px, up to 1 px off their place.
constexpr double kApart_px = 4.0;

class Compared : public Drawn {
 protected:
  static const RecordedRun& Fog() {
    static const RecordedRun run(YardScenario(R"({"visibility_m": 60})"), 2);
    return run;
  }
  const std::string clear_ = RecordedRun::Yard().path().string();
};

TEST_F(Compared, BesideEachOtherAreWhatTheyAreAlone) {
  const std::string fog = Fog().path().string();
  for (const std::string options :
       {"--frame 1", "--camera driver --color-by range --color-range 0,90",
        "--eye 30,12,6 --target 58,1,-1 --select wagon"}) {
    const Picture both = Draw(options + " " + clear_ + " --compare " + fog);
    const Picture left = Draw("--size 320x480 " + options + " " + clear_);
    const Picture right = Draw("--size 320x480 " + options + " " + fog);
    // Without the status in the lower left corner, whose long paths are cut off at different edges.
    EXPECT_TRUE(both.Part({0, 0}, 320, 440) == left.Part({0, 0}, 320, 440)) << options;
    EXPECT_TRUE(both.Part({320, 0}, 320, 440) == right.Part({0, 0}, 320, 440)) << options;
    EXPECT_GT(Differences(left, right).size(), 1000U);
  }
}

TEST_F(Compared, WithItselfHasOneColour) {
  const Picture picture = Draw("--layout distance " + clear_ + " --compare " + clear_);
  std::set<Rgb> colors;
  // Two sources have two statuses at the bottom; the title of the scale is above the points.
  for (int y = kHeight / 5; y < 0.85 * kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (IsClearOfWords({x, y}, picture)) colors.insert(picture.At(x, y));
    }
  }
  EXPECT_EQ(colors.size(), 2U);  // One colour of points, and the background's.
}

TEST_F(Compared, WithFogHasTheColoursOfWhatIsMissing) {
  const Picture picture = Draw("--camera driver --layout distance --color-range 0,1 " + clear_ +
                               " --compare " + Fog().path().string());
  // Points that the fog swallowed are far from all that are left; nearby points are in both clouds.
  EXPECT_GT(PointsOf(MapColor(ColorMap::kViridis, 1.0), picture).size(), 2000U);
  std::size_t num_near = 0;
  for (int step = 0; step <= 102; ++step) {
    num_near += PointsOf(MapColor(ColorMap::kViridis, step / 1023.0), picture).size();
  }
  EXPECT_GT(num_near, 2000U);
}

/// A VLP-16 on a straight line, before a wagon 40 m ahead.
std::string VelodyneScenario() {
  std::string scenario = YardScenario();
  const std::string raster = "vir2rail.json";
  return scenario.replace(scenario.find(raster), raster.size(), "vlp16.json");
}

class Insertion : public Compared {
 protected:
  /// Puts a box and a person who lies on the track before the wagon into a recording.
  void Insert(const std::string& recording) {
    const std::string scenarios = std::string(RAILCAST_SOURCE_DIR) + "/scenarios/";
    Write("plan.json", R"({
      "version": 1,
      "fidelity": "footprint",
      "lidar": {"file": ")" +
                           scenarios + sensor_ + R"(", "mount": {"position_m": [2.2, 0, 2.5]}},
      "world": {
        "recording": {"poses": ")" +
                           poses_ + R"("},
        "objects": [
          {"name": "box", "type": "box", "size_m": [1, 1.5, 1.5], "frame": 0, "s_m": 20, "d_m": 1},
          {"name": "lying", "type": "person", "person": {"posture": "lying"}, "frame": 0, "s_m": 12}
        ]
      },
      "materials": ")" + scenarios +
                           R"(materials/railway.json",
      "labels": ")" + scenarios +
                           R"(labels.json"
    })");
    const Ended ended = Generate("insert " + recording + " " + PathOf("plan.json") + " --out " +
                                 PathOf("inserted"));
    ASSERT_EQ(ended.status, 0) << ended.said;
  }

  /// Compares the points of both recordings with the counts that `insert` has written.
  /// @param num_too_small How many points may move too little for the format.
  /// @param num_too_faint How many intensities may change too little for it.
  void ExpectTheChangesOf(const std::string& recording,
                          const std::string& inserted,
                          int num_too_small = 0,
                          int num_too_faint = 0) {
    std::ifstream told(PathOf("inserted/insert.jsonl"));
    const auto before = OpenRecording(recording);
    const auto after = OpenRecording(inserted);
    std::size_t num_frames = 0;
    for (std::string line; std::getline(told, line); ++num_frames) {
      const auto frame = nlohmann::json::parse(line);
      const auto read_before = before->Next();
      const auto read_after = after->Next();
      ASSERT_TRUE(read_before && read_after);
      const ChangedPoints changed =
          CompareFrames(MakeShownFrame((*read_before)()), MakeShownFrame((*read_after)()));
      const auto expect = [&](const std::string& kind, std::ptrdiff_t num_found, int num_lost) {
        const std::ptrdiff_t num_told = frame[kind];
        EXPECT_LE(num_found, num_told) << kind << ' ' << line;
        EXPECT_GE(num_found, num_told - num_lost) << kind << ' ' << line;
      };
      const auto count = [&](Change change) {
        return std::ranges::count(changed.of_second, change);
      };
      EXPECT_GT(count(Change::kAdded), 30);
      expect("added", count(Change::kAdded), num_too_small);
      expect("removed", static_cast<std::ptrdiff_t>(changed.removed.size()), num_too_small);
      // All whose intensity has changed are called weaker there.
      expect("weaker", count(Change::kWeaker) + count(Change::kStronger), num_too_faint);
    }
    EXPECT_EQ(num_frames, 2U);
  }

  std::string sensor_ = "sensors/vir2rail.json";
  std::string poses_ = "recorded";
};

TEST_F(Insertion, IntoASequenceHasTheChangesThatItTells) {
  const RecordedRun run(YardScenario(), 2);
  const std::string inserted = PathOf("inserted/recording");
  Insert(run.path().string());
  ExpectTheChangesOf(run.path().string(), inserted);
  const Picture picture = Draw("--size 1280x960 --point-size 2 --camera driver --layout changes " +
                               run.path().string() + " --compare " + inserted);
  EXPECT_GT(PointsOf(kSkyBlue, picture).size(), 5U) << "what the box and the person hide";
  EXPECT_GT(PointsOf(kNoValueColor, picture).size(), 1000U) << "what stays as it was";
  const ShownFrame frame = MakeShownFrame((*OpenRecording(inserted)->Next())());
  // Points nearer than the box, such as of the ground before it, would be drawn over its own.
  const auto is_near_box = [&](std::uint32_t slot) {
    return std::abs(frame.frame().y[slot] - 1.0F) < 2.0F;
  };
  std::vector<SeenPoint> of_box =
      LonePoints(SeenPoints(frame, DriverEye(1280, 960), picture, is_near_box), kApart_px);
  std::erase_if(of_box, [&](const SeenPoint& point) {
    return frame.frame().label[point.slot] != run.info().labels.Id("object");
  });
  ASSERT_GT(of_box.size(), 10U);
  EXPECT_EQ(frame.recorded->objects.back().name, "lying") << "--show boxes draws the new ones";
  for (const SeenPoint& point : of_box) {
    // What was removed is drawn, too, and may be nearer.
    EXPECT_THAT(picture.At(point.pixel().x, point.pixel().y),
                testing::AnyOf(kVermillion, kSkyBlue));
  }
  EXPECT_GT(PointsOf(kVermillion, picture).size(), 4 * of_box.size());
}

TEST_F(Insertion, IntoACaptureHasTheChangesThatItTells) {
  Write("scenario.json", VelodyneScenario());
  const std::string capture = PathOf("drive.pcap");
  const Ended ended = Generate("stream " + PathOf("scenario.json") + " --protocol vlp16 --pcap " +
                               capture + " --duration 0.2");
  ASSERT_EQ(ended.status, 0) << ended.said;
  sensor_ = "sensors/vlp16.json";
  poses_ = "standing";
  Insert(capture);
  // Packets state whole 2 mm and intensities in whole percent: a thing that takes less of a return
  // cannot be seen.
  ExpectTheChangesOf(capture, PathOf("inserted/recording/drive.pcap"), 1, 3);
}

TEST_F(Insertion, IntoABagHasTheChangesThatItTells) {
  const RecordedRun run(VelodyneScenario(), 2, "--format mcap");
  sensor_ = "sensors/vlp16.json";
  const std::string bag = (run.path() / "frames.mcap").string();
  Insert(bag);
  ExpectTheChangesOf(bag, PathOf("inserted/recording/frames.mcap"));
}

TEST_F(Compared, EndsWithTheShorterOne) {
  EXPECT_EQ(View("--screenshot " + PathOf("out.png") + " --frame 5 " + clear_ + " --compare " +
                 Fog().path().string())
                .status,
            1);
  const Ended video = View("--size 320x240 --video " + PathOf("video") + " " + clear_ +
                           " --compare " + Fog().path().string());
  EXPECT_EQ(video.status, 0) << video.said;
  EXPECT_TRUE(std::filesystem::exists(PathOf("video/000001.png")));
  EXPECT_FALSE(std::filesystem::exists(PathOf("video/000002.png")));
}

}  // namespace
}  // namespace railcast
