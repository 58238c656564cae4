#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
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

// The sensor is 2.5 m above top of rail and 2.2 m ahead of the vehicle's origin, which is at
// chainage 400 m.
constexpr double kRailTop_m = -2.5;
constexpr double kSensorChainage_m = 402.2;

/// All points but the person's are faint, so that every bright colour is that of a line.
class Overlays : public Drawn {
 protected:
  [[nodiscard]] Picture Show(const std::string& what, const std::string& camera) {
    return Draw("--select person --show " + what + " " + camera + " " + path_);
  }
  /// Expects a line, parts of which may be hidden by points.
  static void ExpectLine(const Picture& picture,
                         const Eye& eye,
                         const Vector3& from_m,
                         const Vector3& to_m,
                         const Rgb& rgb) {
    EXPECT_GE(ShareDrawn(picture, eye, from_m, to_m, rgb), 0.9)
        << from_m.transpose() << " to " << to_m.transpose();
  }

  const RecordedRun& run_ = RecordedRun::Yard();
  const std::string path_ = run_.path().string();
  // A view from above, to the left of the track.
  const std::string beside_ = "--eye 10,14,8 --target 50,0,-1";
  const Eye beside_eye_{{10, 14, 8}, {50, 0, -1}, kWidth, kHeight};
};

TEST_F(Overlays, HaveBoxesOnTheObjectsEdges) {
  for (const std::size_t frame : {0U, 5U}) {
    const Picture picture = Show("boxes --frame " + std::to_string(frame), beside_);
    std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> edges;
    std::vector<Eigen::Vector2d> names;
    std::vector<double> shares;  // Parts of some edges are behind points and masts.
    for (const std::string name : {"standing", "train"}) {
      const RecordedObject& object = run_.ObjectOf(frame, name);
      const auto corners = BoxCorners_m(object);
      for (unsigned corner = 0; corner < 8; ++corner) {
        for (const unsigned axis : {1U, 2U, 4U}) {
          if ((corner & axis) != 0) continue;
          const double share = ShareDrawn(picture, beside_eye_, corners[corner],
                                          corners[corner | axis], run_.ColorOf("wagon"));
          if (!std::isnan(share)) shares.push_back(share);
          edges.emplace_back(*beside_eye_.See(corners[corner]),
                             *beside_eye_.See(corners[corner | axis]));
        }
      }
      // The nose is before the front face.
      const double half_m = 0.5 * object.size_m.x();
      const Vector3 tip = object.sensor_from_box * Vector3(half_m + 1.0, 0.0, 0.0);
      for (const double side : {-0.5, 0.5}) {
        const Vector3 foot =
            object.sensor_from_box * Vector3(half_m, side * object.size_m.y(), 0.0);
        edges.emplace_back(*beside_eye_.See(foot), *beside_eye_.See(tip));
      }
      names.push_back(
          *beside_eye_.See(object.sensor_from_box * Vector3(0.0, 0.0, 0.5 * object.size_m.z())));
    }
    EXPECT_GE(shares.size(), 22U);
    EXPECT_GE(*std::ranges::min_element(shares), 0.4);
    EXPECT_GE(std::accumulate(shares.begin(), shares.end(), 0.0),
              0.85 * static_cast<double>(shares.size()));
    // Nothing else has this colour, except the names above the boxes.
    for (const Pixel& pixel : PointsOf(run_.ColorOf("wagon"), picture)) {
      const Eigen::Vector2d middle = MiddleOf(pixel);
      const bool is_in_name = std::ranges::any_of(names, [&](const Eigen::Vector2d& foot) {
        return std::abs(middle.x() - foot.x()) < 40.0 && middle.y() < foot.y() + 2.0 &&
               middle.y() > foot.y() - 0.04 * kHeight;
      });
      const bool is_on_edge = std::ranges::any_of(edges, [&](const auto& edge) {
        return DistanceToSegment_px(middle, edge.first, edge.second) <= 1.8;
      });
      EXPECT_TRUE(is_in_name || is_on_edge) << pixel.x << ' ' << pixel.y;
    }
  }
}

TEST_F(Overlays, HaveTheTrackAxisBetweenTheRails) {
  const std::string camera = "--eye 5,6,5 --target 25,0,-2.5";
  const Eye eye({5, 6, 5}, {25, 0, -2.5}, kWidth, kHeight);
  const Picture lines = Show("track", camera);
  ExpectLine(lines, eye, {12, 0, kRailTop_m}, {40, 0, kRailTop_m}, kYellow);
  // Points on the rails are 0.7175 m and half a head to the side of the axis.
  const Picture points = Draw(camera + " " + path_);
  int num_left = 0;
  int num_right = 0;
  const ShownFrame& shown = run_.frame(0);
  const std::uint32_t rail = run_.info().labels.Id("rail");
  for (std::size_t i = 0; i < shown.num_points(); ++i) {
    const Vector3 place_m = PositionOf(shown, i);
    if (shown.frame().label[shown.slots[i]] != rail || std::abs(place_m.y()) > 1.5 ||
        place_m.x() < 12.0 || place_m.x() > 40.0) {
      continue;
    }
    const Pixel at = PixelAt(*eye.See(place_m));
    if (!IsClearOfWords(at, points)) continue;
    if (points.At(at.x, at.y) != run_.ColorOf("rail")) continue;
    // Search along the picture's row for the axis.
    const auto is_axis = [&](int x) { return lines.At(x, at.y) == kYellow; };
    int left = at.x;
    while (left > 0 && !is_axis(left)) --left;
    int right = at.x;
    while (right < kWidth - 1 && !is_axis(right)) ++right;
    // Seen from the left of the track, the left rail is nearer and so to the left of the axis in
    // the picture.
    EXPECT_TRUE(is_axis(place_m.y() > 0.0 ? right : left)) << place_m.transpose();
    (place_m.y() > 0.0 ? num_left : num_right) += 1;
  }
  EXPECT_GT(num_left, 30);
  EXPECT_GT(num_right, 30);
}

TEST_F(Overlays, HaveATickAtEveryTenMetresAndALongOneAtEveryFifty) {
  const Picture picture = Show("track", "--eye 25,6,5 --target 43,0,-2.5");
  const Eye eye({25, 6, 5}, {43, 0, -2.5}, kWidth, kHeight);
  const auto share = [&](double s_m, double from_m, double to_m) {
    const double x_m = s_m - kSensorChainage_m;
    return ShareDrawn(picture, eye, {x_m, from_m, kRailTop_m}, {x_m, to_m, kRailTop_m}, kYellow);
  };
  EXPECT_GE(share(440, 0.1, 0.5), 0.9);
  EXPECT_LE(share(440, 0.6, 1.3), 0.1);
  EXPECT_GE(share(450, -1.3, 1.3), 0.6);  // Its word hides a part of it.
  EXPECT_LE(share(445, 0.1, 0.5), 0.2);
}

TEST_F(Overlays, HaveRingsAtTheirDistancesFromBelowTheSensor) {
  const Picture picture = Show("rings", "--camera chase");
  const Eye eye = ChaseEye(kWidth, kHeight);
  constexpr Rgb kGrey{150, 150, 150};
  for (const double radius_m : {10.0, 25.0, 50.0}) {
    const auto at = [&](double angle_deg) {
      const double angle_rad = angle_deg * std::numbers::pi / 180.0;
      return Vector3(radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), kRailTop_m);
    };
    int num_seen = 0;
    for (double angle_deg = -60.0; angle_deg < 60.0; angle_deg += 5.0) {
      // Skip where the words "50 m", straight ahead, and the status hide the ring.
      if (radius_m == 10.0 && angle_deg > 45.0) continue;
      if (std::abs(angle_deg + 2.5) < 10.0) continue;
      const double share = ShareDrawn(picture, eye, at(angle_deg), at(angle_deg + 5.0), kGrey);
      if (std::isnan(share)) continue;
      EXPECT_GE(share, 0.6) << radius_m << ' ' << angle_deg;  // Points hide parts of it.
      ++num_seen;
    }
    EXPECT_GT(num_seen, 3) << radius_m;
  }
}

TEST_F(Overlays, HaveTheGaugeRoundTheTrack) {
  const Picture picture = Show("gauge", beside_);
  // At chainage 440 m; the clear space is widest at 3.58 m and narrows evenly down to 1.16 m.
  const double x_m = 440.0 - kSensorChainage_m;
  const auto at = [&](double y_m, double height_m) {
    return Vector3(x_m, y_m, kRailTop_m + height_m);
  };
  ExpectLine(picture, beside_eye_, at(1.69, 1.16), at(1.754, 3.58), kReddishPurple);
  ExpectLine(picture, beside_eye_, at(-1.754, 3.58), at(-1.69, 1.16), kReddishPurple);
  ExpectLine(picture, beside_eye_, at(1.754, 3.58), at(1.754, 3.58) + Vector3(20, 0, 0),
             kReddishPurple);
}

TEST_F(Overlays, HaveTheSensorsAxes) {
  const Picture picture = Show("axes", "--eye -5,-5,3 --target 0,0,0");
  const Eye eye({-5, -5, 3}, {0, 0, 0}, kWidth, kHeight);
  // The ends are left out, because the letters are there.
  ExpectLine(picture, eye, {0.1, 0, 0}, {1.7, 0, 0}, kVermillion);
  ExpectLine(picture, eye, {0, 0.1, 0}, {0, 1.7, 0}, kBluishGreen);
  ExpectLine(picture, eye, {0, 0, 0.1}, {0, 0, 1.7}, kBlue);
}

TEST_F(Overlays, HaveTheFrustumAtTheScansCorners) {
  const Picture picture = Show("frustum", "--camera top");
  // The frustum is 60 deg wide and 30 deg high and drawn out to 100 m.
  const double wide_rad = 30.0 * std::numbers::pi / 180.0;
  const double high_rad = 15.0 * std::numbers::pi / 180.0;
  for (const double side : {-1.0, 1.0}) {
    const Vector3 corner(100.0 * std::cos(high_rad) * std::cos(wide_rad),
                         100.0 * std::cos(high_rad) * std::sin(side * wide_rad),
                         100.0 * std::sin(high_rad));
    EXPECT_GE(ShareDrawn(picture, TopEye(kWidth, kHeight), 0.2 * corner, 0.8 * corner, kSkyBlue),
              0.9);
  }
}

TEST_F(Overlays, HaveSurfacesBehindThePoints) {
  const Picture points = Draw("--camera driver " + path_);
  const Picture both = Draw("--camera driver --show surfaces " + path_);
  const Eye eye = DriverEye(kWidth, kHeight);
  // Surfaces of the standing wagon, whose rear face fills its outline from here.
  const Corners outline = OutlineOf(run_.ObjectOf(0, "standing"), eye);
  int num_inside = 0;
  int num_between = 0;  // Pixels between the points.
  int num_changed = 0;
  int num_reddish = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (DistanceOutside_px({x + 0.5, y + 0.5}, outline) > 0.0) continue;
      ++num_inside;
      if (points.At(x, y) == kDark) {
        ++num_between;
        num_changed += both.At(x, y) != kDark ? 1 : 0;
      }
      num_reddish += both.At(x, y)[0] > both.At(x, y)[2] + 10 ? 1 : 0;
    }
  }
  EXPECT_GT(num_inside, 500);
  EXPECT_GT(num_between, 500);
  EXPECT_GE(num_changed, 0.95 * num_between);
  EXPECT_GE(num_reddish, 0.8 * num_inside);
  // The sky is unchanged.
  const Picture sky = both.Part({400, 0}, 240, 60);
  EXPECT_EQ(sky, points.Part({400, 0}, 240, 60));
}

TEST_F(Overlays, HaveTheFanOfFiringsThatBroughtNothingBack) {
  const Picture without = Draw("--camera top " + path_);
  const Picture with = Draw("--camera top --show empty-beams " + path_);
  const Eye eye = TopEye(kWidth, kHeight);
  const Eigen::Vector2d sensor = *eye.See({0, 0, 0});
  const double twelve_m_px = (*eye.See({12, 0, 0}) - sensor).norm();
  std::size_t num_in_fan = 0;
  std::size_t num_outside = 0;
  for (const Pixel& pixel : Differences(without, with)) {
    if (!IsClearOfWords(pixel, with)) continue;
    const Eigen::Vector2d way = MiddleOf(pixel) - sensor;
    // Ahead is up in the picture; the width of a pixel is allowed for.
    const double angle_rad = std::atan2(std::abs(way.x()) - 1.5, -way.y());
    (angle_rad <= 30.0 * std::numbers::pi / 180.0 ? num_in_fan : num_outside) += 1;
  }
  // At least half of the sector of 60 deg with a radius of 12 m.
  EXPECT_GT(static_cast<double>(num_in_fan),
            0.5 * std::numbers::pi / 6.0 * twelve_m_px * twelve_m_px);
  EXPECT_EQ(num_outside, 0U);
}

TEST_F(Overlays, AreRefusedWhereTheyCannotBeDrawn) {
  const std::string cloud = (run_.path() / "frames/000000.pcd").string();
  const auto fault_of = [&](const std::string& what) {
    const Ended ended = View("--screenshot " + PathOf("out.png") + " --show " + what + " " + cloud);
    EXPECT_EQ(ended.status, 1);
    EXPECT_FALSE(std::filesystem::exists(PathOf("out.png")));
    return ended.said;
  };
  for (const std::string what : {"gauge", "surfaces"}) {
    EXPECT_EQ(fault_of(what),
              "error: " + cloud + ": gauge and surfaces need the scenario, which is not known\n");
  }
  EXPECT_EQ(fault_of("boxes"),
            "error: " + cloud + ": boxes need a sequence's objects, or a scenario and poses\n");
}

}  // namespace
}  // namespace railcast
