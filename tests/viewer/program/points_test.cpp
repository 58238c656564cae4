#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/viewer/program/drawn_points.h"
#include "tests/viewer/program/eye.h"
#include "tests/viewer/program/recorded_run.h"
#include "tests/viewer/program/view_program.h"
#include "viewer/color/palette.h"

namespace railcast {
namespace {

// Points are squares of 2 px at this size: an edge is up to 1 px from the place, the middle of a
// pixel half a pixel farther, and this is the diagonal of both.
constexpr double kReach_px = 2.2;

class Points : public Drawn {
 protected:
  const RecordedRun& run_ = RecordedRun::Yard();
  const std::string path_ = run_.path().string();

  /// Moving objects are scanned over the duration of a frame, so their outlines are taken at
  /// several times.
  [[nodiscard]] std::vector<Corners> OutlinesDuring(std::size_t frame,
                                                    const std::string& object,
                                                    const Eye& eye) const {
    const Frame& scan = run_.frame(frame).frame();
    RecordedObject moved = run_.ObjectOf(frame, object);
    constexpr int kNumSteps = 4;
    const Vector3 step_m = scan.world_from_sensor.linear().transpose() * moved.velocity_world_mps *
                           (1e-9 * static_cast<double>(scan.duration_ns) / kNumSteps);
    std::vector<Corners> outlines;
    for (int step = 0; step <= kNumSteps; ++step) {
      outlines.push_back(OutlineOf(moved, eye));
      moved.sensor_from_box.translation() += step_m;
    }
    return outlines;
  }

  [[nodiscard]] std::vector<SeenPoint> SeenOf(std::size_t frame,
                                              const std::string& label,
                                              const Eye& eye,
                                              const Picture& picture) const {
    const std::uint32_t id = run_.info().labels.Id(label);
    const ShownFrame& shown = run_.frame(frame);
    return SeenPoints(shown, eye, picture,
                      [&](std::uint32_t slot) { return shown.frame().label[slot] == id; });
  }
};

TEST_F(Points, OfWagonsAreInTheirBoxes) {
  const std::pair<std::string, Eye> views[] = {
      {"--camera chase", ChaseEye(kWidth, kHeight)},
      {"--camera driver", DriverEye(kWidth, kHeight)},
      {"--camera top", TopEye(kWidth, kHeight)},
      {"--eye 30,12,6 --target 58,1,-1", Eye({30, 12, 6}, {58, 1, -1}, kWidth, kHeight)}};
  for (const std::size_t frame : {0U, 5U}) {
    for (const auto& [camera, eye] : views) {
      SCOPED_TRACE(camera + " of frame " + std::to_string(frame));
      const Picture picture = Draw(camera + " --frame " + std::to_string(frame) + " " + path_);
      std::vector<Corners> outlines = OutlinesDuring(frame, "train", eye);
      outlines.push_back(OutlineOf(run_.ObjectOf(frame, "standing"), eye));
      const auto pixels = PointsOf(run_.ColorOf("wagon"), picture);
      const auto num_inside = std::ranges::count_if(pixels, [&](const Pixel& pixel) {
        return std::ranges::any_of(outlines, [&](const Corners& outline) {
          return DistanceOutside_px(MiddleOf(pixel), outline) <= kReach_px;
        });
      });
      EXPECT_GE(num_inside, 0.99 * static_cast<double>(pixels.size()));
      // Each point of the wagon is drawn, except those behind raindrops and, from above, those
      // below the contact line or below each other.
      const auto seen = SeenOf(frame, "wagon", eye, picture);
      const auto num_drawn = std::ranges::count_if(seen, [&](const SeenPoint& point) {
        return picture.At(point.pixel().x, point.pixel().y) == run_.ColorOf("wagon");
      });
      EXPECT_GT(seen.size(), 300U);
      EXPECT_GE(num_drawn, 0.8 * static_cast<double>(seen.size()));
    }
  }
}

TEST_F(Points, AreAsLargeAsAskedFor) {
  // From the driver's place beams do not overlap: 0.25 deg is 3.2 px.
  const Eye eye = DriverEye(kWidth, kHeight);
  std::size_t last = 0;
  for (const int size_px : {1, 2, 3, 6, 20}) {
    const Picture picture =
        Draw("--camera driver --point-size " + std::to_string(size_px) + " " + path_);
    const auto num_pixels = PointsOf(run_.ColorOf("wagon"), picture).size();
    const auto num_points = SeenOf(0, "wagon", eye, picture).size();
    const auto num_drawn = picture.pixels.size() - picture.Count(kDark);
    EXPECT_GT(num_drawn, last);
    last = num_drawn;
    if (size_px <= 3) {
      const double expected = static_cast<double>(num_points) * size_px * size_px;
      EXPECT_LE(static_cast<double>(num_pixels), expected);
      EXPECT_GE(static_cast<double>(num_pixels), 0.85 * expected);
    }
  }
}

TEST_F(Points, HaveTheColoursOfTheirValues) {
  const Eye eye = DriverEye(kWidth, kHeight);
  const ShownFrame& shown = run_.frame(0);
  const std::pair<std::string, ColorMap> maps[] = {{"", ColorMap::kViridis},
                                                   {"--color-map magma ", ColorMap::kMagma}};
  for (const auto& [option, map] : maps) {
    const Picture picture =
        Draw("--camera driver --color-by range --color-range 20,80 " + option + path_);
    const auto lone = LonePoints(SeenPoints(shown, eye, picture), 3.0);
    int num_right = 0;
    for (const SeenPoint& point : lone) {
      // The program rounds to one of 1024 colours.
      const double place = std::clamp(
          (static_cast<double>(shown.frame().range_m[point.slot]) - 20.0) / 60.0, 0.0, 1.0);
      const Rgb expected = MapColor(map, static_cast<double>(std::lround(1023.0 * place)) / 1023.0);
      num_right += picture.At(point.pixel().x, point.pixel().y) == expected ? 1 : 0;
    }
    EXPECT_GT(lone.size(), 1000U);
    EXPECT_EQ(num_right, static_cast<int>(lone.size()));
    // The scale extends from 12 % of the height to 82 %.
    EXPECT_EQ(picture.At(570, static_cast<int>(0.87 * kHeight)), MapColor(map, 0.0));
    EXPECT_EQ(picture.At(570, static_cast<int>(0.18 * kHeight)), MapColor(map, 1.0));
  }
}

TEST_F(Points, AreFaintWhereTheirLabelIsNotSelected) {
  const Picture all = Draw(path_);
  const Picture selected = Draw("--select wagon,person " + path_);
  for (const std::string label : {"wagon", "person"}) {
    EXPECT_EQ(PointsOf(run_.ColorOf(label), selected), PointsOf(run_.ColorOf(label), all)) << label;
  }
  for (const std::string label : {"ground", "rail", "ballast", "pole", "rain"}) {
    EXPECT_GT(PointsOf(run_.ColorOf(label), all).size(), 100U) << label;
    EXPECT_EQ(PointsOf(run_.ColorOf(label), selected).size(), 0U) << label;
  }
  // The other points are faint but still drawn.
  EXPECT_EQ(PointsOf(kDark, selected.Part({0, 0}, kWidth, 400)),
            PointsOf(kDark, all.Part({0, 0}, kWidth, 400)));
}

TEST_F(Points, AreListedInTheLegendWithTheirLabelsColours) {
  const Picture picture = Draw(path_);
  std::set<std::uint32_t> ids;
  for (const std::uint32_t slot : run_.frame(0).slots)
    ids.insert(run_.frame(0).frame().label[slot]);
  EXPECT_GE(ids.size(), 10U);
  // Lines of 3 % of the height begin 2 % below the top, by rising label; swatches begin 2 % from
  // the left.
  double middle_px = (0.02 + 0.015) * kHeight;
  for (const std::uint32_t id : ids) {
    const Label& label = *run_.info().labels.Find(id);
    EXPECT_EQ(picture.At(13, static_cast<int>(middle_px)), label.rgb) << label.name;
    middle_px += 0.03 * kHeight;
  }
}

TEST_F(Points, StandOnTheBackgroundAskedFor) {
  const std::pair<std::string, Rgb> backgrounds[] = {
      {"dark", kDark}, {"black", {0, 0, 0}}, {"white", {255, 255, 255}}};
  for (const auto& [name, rgb] : backgrounds) {
    const Picture picture = Draw("--background " + name + " " + path_);
    EXPECT_EQ(picture.At(kWidth - 1, 0), rgb);
    EXPECT_GT(picture.Count(rgb), picture.pixels.size() / 2) << name;
    EXPECT_EQ(PointsOf(run_.ColorOf("wagon"), picture),
              PointsOf(run_.ColorOf("wagon"), Draw(path_)));
  }
}

TEST_F(Points, OfSeveralFramesAreWhereTheyWereInTheWorld) {
  const Picture one = Draw("--frame 5 " + path_);
  const Picture six = Draw("--frame 5 --accumulate 6 " + path_);
  const auto drawn = [&](const Picture& picture) {
    return picture.pixels.size() - picture.Count(kDark);
  };
  EXPECT_GT(drawn(six), drawn(one) + 5000);
  // The post stands still, so its points of all frames are where it is in the last.
  const Eye eye = ChaseEye(kWidth, kHeight);
  const auto post = PointsOf(run_.ColorOf("pole"), six);
  const Corners outline = OutlineOf(run_.ObjectOf(5, "post"), eye);
  const auto num_inside = std::ranges::count_if(post, [&](const Pixel& pixel) {
    return DistanceOutside_px(MiddleOf(pixel), outline) <= kReach_px;
  });
  EXPECT_GT(post.size(), PointsOf(run_.ColorOf("pole"), one).size());
  EXPECT_GE(num_inside, 0.99 * static_cast<double>(post.size()));
  // The train moves, so its points of each frame are where it was at that time; it comes at 15 m/s.
  for (std::size_t frame = 0; frame < 6; ++frame) {
    const ShownFrame& shown = run_.frame(frame);
    const Transform last_from_this =
        run_.frame(5).frame().world_from_sensor.inverse() * shown.frame().world_from_sensor;
    const std::uint32_t train = run_.ObjectOf(frame, "train").instance;
    std::size_t num_points = 0;
    std::size_t num_drawn = 0;
    for (std::size_t i = 0; i < shown.num_points(); ++i) {
      if (shown.frame().instance[shown.slots[i]] != train) continue;
      const auto place_px = eye.See(last_from_this * PositionOf(shown, i));
      ASSERT_TRUE(place_px.has_value());
      const Pixel pixel = PixelAt(*place_px);
      ++num_points;
      num_drawn += six.At(pixel.x, pixel.y) == run_.ColorOf("wagon") ? 1 : 0;
    }
    EXPECT_GT(num_points, 100U) << frame;
    // Some points are behind masts and wires.
    EXPECT_GE(static_cast<double>(num_drawn), 0.9 * static_cast<double>(num_points)) << frame;
  }
}

}  // namespace
}  // namespace railcast
