#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/viewer/program/drawn_points.h"
#include "tests/viewer/program/eye.h"
#include "tests/viewer/program/recorded_run.h"
#include "tests/viewer/program/view_program.h"
#include "viewer/plan/plan.h"

namespace railcast {
namespace {

class Picked : public Drawn {
 protected:
  /// Returns a line of the facts.
  static std::string Fact(std::string name, const std::string& value) {
    name.resize(17, ' ');
    return name + value + "\n";
  }
  static std::string PickOption(const SeenPoint& point) {
    return "--pick " + std::to_string(point.pixel().x) + "," + std::to_string(point.pixel().y) +
           " ";
  }
  /// Returns points of an object that no other point is near to, so that a click on them is
  /// unambiguous.
  [[nodiscard]] std::vector<SeenPoint> LoneOf(const std::string& object, const Eye& eye) const {
    return LoneOf(object, eye, run_.frame(0));
  }
  [[nodiscard]] std::vector<SeenPoint> LoneOf(const std::string& object,
                                              const Eye& eye,
                                              const ShownFrame& shown) const {
    const std::uint32_t instance = run_.ObjectOf(0, object).instance;
    const Picture blank{kWidth, kHeight, {}};
    std::vector<SeenPoint> lone = LonePoints(SeenPoints(shown, eye, blank), 12.0);
    std::erase_if(lone, [&](const SeenPoint& point) {
      return shown.frame().instance[point.slot] != instance;
    });
    return lone;
  }

  const RecordedRun& run_ = RecordedRun::Yard();
  const std::string path_ = run_.path().string();
};

TEST_F(Picked, PointsAreThoseOfTheObjectThatWasClicked) {
  struct Object {
    std::string name;
    std::string label;
    Vector3 eye_m;
  };
  for (const Object& object :
       {Object{"standing", "wagon", {46, 1, 0}}, Object{"worker", "person", {31, -3, -2}},
        Object{"post", "pole", {37, -4, -1}}}) {
    const RecordedObject& box = run_.ObjectOf(0, object.name);
    const Vector3 target_m = box.sensor_from_box.translation();
    const Eye eye(object.eye_m, target_m, kWidth, kHeight);
    const auto lone = LoneOf(object.name, eye);
    ASSERT_GT(lone.size(), 3U) << object.name;
    const SeenPoint& point = lone[lone.size() / 2];
    const auto triple = [](const Vector3& place_m) {
      std::array<char, 96> text{};
      std::snprintf(text.data(), text.size(), "%.17g,%.17g,%.17g", place_m.x(), place_m.y(),
                    place_m.z());
      return std::string(text.data());
    };
    (void)Draw(PickOption(point) + "--eye " + triple(object.eye_m) + " --target " +
               triple(target_m) + " " + path_);
    const Frame& frame = run_.frame(0).frame();
    std::array<char, 32> range{};
    std::snprintf(range.data(), range.size(), "%.4f m",
                  static_cast<double>(frame.range_m[point.slot]));
    for (const std::string& fact :
         {Fact("frame", "0"), Fact("slot", std::to_string(point.slot)), Fact("range", range.data()),
          Fact("label", object.label + " (" + std::to_string(frame.label[point.slot]) + ")"),
          Fact("instance", object.name + " (" + std::to_string(box.instance) + ")"),
          Fact("outcome", "returned")}) {
      EXPECT_NE(said().find(fact), std::string::npos) << fact << "is not in\n" << said();
    }
  }
}

TEST_F(Picked, PointsHaveTheTraceThatTheGeneratorPrints) {
  const Eye eye({46, 1, 0}, {57, 0, -1}, kWidth, kHeight);
  const auto lone = LoneOf("standing", eye);
  ASSERT_GT(lone.size(), 3U);
  (void)Draw(PickOption(lone[1]) + "--trace --eye 46,1,0 --target 57,0,-1 " + path_);
  // The viewer tells the firing of a slot, the generator the slot of a firing.
  const std::string head = "frame 0 firing ";
  const std::size_t at = said().find(head);
  ASSERT_NE(at, std::string::npos) << said();
  const Ended trace = Generate("trace " + run_.scenario_file().string() + " --frame 0 --firing " +
                               std::to_string(std::stoul(said().substr(at + head.size()))));
  EXPECT_EQ(trace.status, 0);
  EXPECT_EQ(said().substr(at), trace.said);
  EXPECT_NE(trace.said.find("slot " + std::to_string(lone[1].slot) + "\n"), std::string::npos)
      << trace.said;
  EXPECT_NE(trace.said.find("hits wagon, instance 1"), std::string::npos) << trace.said;
}

TEST_F(Picked, PairsHaveADistance) {
  const Eye eye({46, 1, 0}, {57, 0, -1}, kWidth, kHeight);
  auto lone = LoneOf("standing", eye);
  // The plate with the facts covers the right half.
  std::erase_if(lone, [](const SeenPoint& point) { return point.place_px.x() > 0.5 * kWidth; });
  ASSERT_GT(lone.size(), 3U);
  const Picture one = Draw(PickOption(lone.front()) + "--eye 46,1,0 --target 57,0,-1 " + path_);
  EXPECT_EQ(said().find("from the point before"), std::string::npos);
  const Picture two = Draw(PickOption(lone.front()) + PickOption(lone.back()) +
                           "--eye 46,1,0 --target 57,0,-1 " + path_);
  const Vector3 way_m =
      PositionOf(run_.frame(0), lone.back().point) - PositionOf(run_.frame(0), lone.front().point);
  std::array<char, 128> expected{};
  std::snprintf(expected.data(), expected.size(),
                "from the point before\n%.3f m (dx %.3f, dy %.3f, dz %.3f; level %.3f m)",
                way_m.norm(), way_m.x(), way_m.y(), way_m.z(), way_m.head<2>().norm());
  EXPECT_NE(said().find(expected.data()), std::string::npos) << expected.data() << '\n' << said();
  // A white line joins them, in the colour of the crosses.
  constexpr Rgb kWhite = {255, 255, 255};
  const Vector3 from_m = PositionOf(run_.frame(0), lone.front().point);
  EXPECT_GE(ShareDrawn(two, eye, from_m, from_m + way_m, kWhite), 0.8);
  EXPECT_LE(ShareDrawn(one, eye, from_m, from_m + way_m, kWhite), 0.3);
}

TEST_F(Picked, PlacesWithoutPointsAreRefused) {
  const Ended ended =
      View("--size 640x480 --screenshot " + PathOf("out.png") + " --pick 600,20 " + path_);
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.said, "error: --pick: no point is near 600,20\n");
  EXPECT_FALSE(std::filesystem::exists(PathOf("out.png")));
}

TEST_F(Picked, PointsOfACloudWithoutAScenarioHaveNoTrace) {
  const std::string cloud = (run_.path() / "frames/000000.pcd").string();
  const Eye eye({46, 1, 0}, {57, 0, -1}, kWidth, kHeight);
  // A cloud without a pose, so the motion within the scan is not undone.
  const ShownFrame shown = MakeShownFrame((*OpenRecording(cloud)->Next())());
  const auto lone = LoneOf("standing", eye, shown);
  ASSERT_GT(lone.size(), 3U);
  (void)Draw(PickOption(lone[1]) + "--trace --eye 46,1,0 --target 57,0,-1 " + cloud);
  EXPECT_NE(said().find("has no scenario to trace points with"), std::string::npos) << said();
}

class PlanPicture : public Drawn {
 protected:
  const std::string yard_ = RAILCAST_SOURCE_DIR "/scenarios/yard.json";
};

TEST_F(PlanPicture, DrawsEachTrackInItsColour) {
  const Picture picture = Draw(yard_);
  ASSERT_EQ(picture.width, kWidth);
  ASSERT_EQ(picture.height, kHeight);
  const auto main = picture.PlacesOf(PlanTrackRgb(0));
  const auto [left, right] = std::ranges::minmax(main, {}, &Pixel::x);
  EXPECT_GT(right.x - left.x, kWidth / 2);
  // The second track is 4 m to the left; the yard lies to the right.
  const auto top = [&](std::size_t track) {
    return std::ranges::min(picture.PlacesOf(PlanTrackRgb(track)), {}, &Pixel::y).y;
  };
  EXPECT_LT(top(1), top(0));
  EXPECT_GT(top(4), top(0));
  EXPECT_GT(picture.Count(kPlanDivergingRgb), 0U);
  EXPECT_EQ(Draw(yard_), picture);
}

TEST_F(PlanPicture, ShowsAStretch) {
  const Picture picture = Draw("--stretch 0 100 " + yard_);
  EXPECT_GT(picture.Count(PlanTrackRgb(1)), 0U);
  EXPECT_EQ(picture.Count(PlanTrackRgb(2)), 0U);
  EXPECT_EQ(picture.Count(kPlanDivergingRgb), 0U);
}

TEST_F(PlanPicture, SaysWhatIsWrong) {
  const auto said = [&](const std::string& arguments) { return View(arguments).said; };
  const std::string to = "--screenshot " + PathOf("out.png") + " ";
  EXPECT_EQ(said(to + "--stretch 10 700 " + yard_),
            "error: --stretch: must be two chainages from 0 to 600, the lesser first (got 10 and "
            "700)\n");
  const std::string help = "\nRun with --help for more information.\n";
  EXPECT_EQ(said(to + "--stretch 20 10 " + yard_),
            "--stretch: must be two chainages, the lesser first (got 20 and 10)" + help);
  EXPECT_EQ(said(yard_), "--screenshot: is needed for the plan of a scenario" + help);
  EXPECT_EQ(said(to + "--frame 3 " + yard_), "--frame: is not for the plan of a scenario" + help);
  EXPECT_EQ(said(to + "--stretch 0 10 cloud.pcd"),
            "--stretch: is for the plan of a scenario" + help);
  EXPECT_EQ(said(to + PathOf("gone.json")), "error: " + PathOf("gone.json") + ": no such file\n");
  Write("labels.json", R"({"labels": []})");
  EXPECT_THAT(said(to + PathOf("labels.json")),
              testing::StartsWith("error: " + PathOf("labels.json") + ": "));
  EXPECT_FALSE(std::filesystem::exists(PathOf("out.png")));
}

}  // namespace
}  // namespace railcast
