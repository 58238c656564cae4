#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/detect/base/normal_table.h"
#include "core/detect/beam/facet_parts.h"
#include "core/detect/beam/wire_set.h"

namespace railcast {
namespace {

TEST(WireSet, EverySegmentIsInsideTheBallOfItsGroupAndInOneGroup) {
  WireSet wires;
  for (const int num_points : {2, 3, 9, 10, 40}) {
    std::vector<Vector3> points_m;
    for (int i = 0; i < num_points; ++i) {
      points_m.emplace_back(10.0 * std::cos(0.3 * i), 10.0 * std::sin(0.3 * i), 0.1 * i);
    }
    wires.Add(points_m, 0.5, 3);
  }
  EXPECT_EQ(wires.segments.size(), 1U + 2U + 8U + 9U + 39U);
  std::uint32_t next = 0;
  for (const WireGroup& group : wires.groups) {
    EXPECT_EQ(group.first_segment, next);
    next = group.end_segment;
    for (std::uint32_t i = group.first_segment; i < next; ++i) {
      const WireSegment& segment = wires.segments[i];
      for (const Eigen::Vector3f& end_m : {segment.begin_m, segment.end_m}) {
        EXPECT_LE((end_m - group.ball.center_m).norm() + segment.radius_m,
                  group.ball.radius_m * 1.000001F);
      }
    }
  }
  EXPECT_EQ(next, wires.segments.size());
}

TEST(WireSet, BallsContainAWireThatMovesAtAllTimes) {
  WireSet wires;
  std::vector<Vector3> points_m;
  std::vector<Vector3> moves_m;
  for (int i = 0; i < 20; ++i) {
    points_m.emplace_back(5.0 * i, 0.0, 6.0);
    moves_m.emplace_back(0.0, 0.01 * i * (19 - i), 0.1);
  }
  wires.Add(points_m, 0.006, 3, moves_m);
  EXPECT_FLOAT_EQ(wires.segments[9].travel_m, std::hypot(0.9F, 0.1F));
  for (const WireGroup& group : wires.groups) {
    for (std::uint32_t i = group.first_segment; i < group.end_segment; ++i) {
      for (const float shutter : {0.0F, 0.5F, 1.0F}) {
        const WireSegment now = SegmentAt(wires.segments[i], shutter);
        for (const Eigen::Vector3f& end_m : {now.begin_m, now.end_m}) {
          for (const WireBall& ball : {group.ball, wires.balls[i]}) {
            EXPECT_LE((end_m - ball.center_m).norm() + now.radius_m, ball.radius_m * 1.000001F);
          }
        }
      }
    }
  }
  const WireSegment end = SegmentAt(wires.segments[9], 1.0F);
  EXPECT_TRUE(end.begin_m.isApprox((points_m[9] + moves_m[9]).cast<float>()));
  EXPECT_TRUE(end.end_m.isApprox((points_m[10] + moves_m[10]).cast<float>()));
  EXPECT_EQ(end.travel_m, 0.0F);
}

// Of a closer look.
constexpr float kShareOfOne = 1.0F / kNumCloserSubRays;

/// Everything between two distances from the line through the beam's middle in a direction.
struct Band {
  double turn_rad{};
  double begin{}, end{};

  [[nodiscard]] bool Contains(const BeamPlace& place) const {
    const double aside = std::cos(turn_rad) * static_cast<double>(place.v) -
                         std::sin(turn_rad) * static_cast<double>(place.h);
    return begin <= aside && aside <= end;
  }
};

std::vector<BeamPlace> PlacesIn(const Band& band, const BeamSubRays& rays) {
  std::vector<BeamPlace> places;
  for (std::size_t i = 0; i < rays.num; ++i) {
    const BeamPlace place{rays.h[i], rays.v[i]};
    if (band.Contains(place)) places.push_back(place);
  }
  return places;
}

std::vector<BeamPlace> PlacesOfCloserLook(const Band& band) {
  return PlacesIn(band, SubRaysOfCloserLook());
}

/// The share of a band as FacetParts finds it: a second strip is fitted to what is met in the
/// first. 0 if no strip fits.
double ShareByStrips(const Band& band) {
  std::vector<BeamPlace> places = PlacesOfCloserLook(band);
  std::optional<ThinStrip> strip =
      FitStrip(places, kShareOfOne * static_cast<float>(places.size()));
  if (!strip) return 0.0;
  const float share_of_one = strip->Share() / kNumSubRays;
  places = PlacesIn(band, SubRaysIn(*strip, 0, 1));
  strip = FitStrip(places, share_of_one * static_cast<float>(places.size()));
  if (!strip) return 0.0;
  const BeamSubRays rays = SubRaysIn(*strip, 1, kNumStripSets - 1);
  return static_cast<double>(strip->Share()) * static_cast<double>(PlacesIn(band, rays).size()) /
         static_cast<double>(rays.num);
}

TEST(ThinStrip, FindsTheShareOfLinesWithinASixth) {
  double sum = 0.0, square = 0.0, square_alone = 0.0;
  int num = 0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 2.0 * std::fmod(i * std::numbers::phi, 1.0) - 1.0;
    const double half = 0.02 + 0.06 * std::fmod(i * std::numbers::sqrt2, 1.0);
    const Band band{0.1 * i, middle - half, middle + half};
    const double share = ShareByStrips(band);
    if (share == 0.0) continue;
    const double error = share / NormalShare(band.begin, band.end) - 1.0;
    sum += error;
    square += error * error;
    const double share_alone =
        static_cast<double>(kShareOfOne) * static_cast<double>(PlacesOfCloserLook(band).size());
    square_alone += std::pow(share_alone / NormalShare(band.begin, band.end) - 1.0, 2.0);
    ++num;
    EXPECT_LT(std::fabs(error), 1.0 / 6.0) << i;
  }
  EXPECT_GT(num, 180);
  EXPECT_LT(std::fabs(sum / num), 0.02);
  EXPECT_LT(std::sqrt(square / num), 0.05);
  EXPECT_GT(std::sqrt(square_alone / num), 0.15);
  RecordProperty("alone", std::to_string(std::sqrt(square_alone / num)));
}

TEST(ThinStrip, FindsTheShareOfWhatReachesIntoTheBeamFromOutside) {
  double square = 0.0;
  int num = 0;
  for (int i = 0; i < 200; ++i) {
    const double edge = 1.6 + 1.0 * std::fmod(i * std::numbers::phi, 1.0);
    const Band band{0.1 * i, edge, kNormalReach};
    const double share = ShareByStrips(band);
    if (share == 0.0) continue;
    const double error = share / NormalShare(band.begin, band.end) - 1.0;
    square += error * error;
    ++num;
  }
  EXPECT_GT(num, 180);
  EXPECT_LT(std::sqrt(square / num), 0.12);
}

TEST(ThinStrip, IsNotFittedToOnePlaceInTheMiddle) {
  EXPECT_FALSE(FitStrip(std::vector<BeamPlace>{}, 0.0F));
  EXPECT_FALSE(FitStrip(std::vector<BeamPlace>{{0.3F, -0.2F}}, kShareOfOne));
  EXPECT_TRUE(FitStrip(std::vector<BeamPlace>{{2.3F, -0.2F}}, kShareOfOne));
}

TEST(ThinStrip, IsNotFittedToWhatFillsTheBeam) {
  const Band half{0.3, -0.4, kNormalReach};
  const std::vector<BeamPlace> places = PlacesOfCloserLook(half);
  EXPECT_FALSE(FitStrip(places, kShareOfOne * static_cast<float>(places.size())));
}

TEST(ThinStrip, HasSubRaysOfEqualShare) {
  const ThinStrip strip{{0.8F, 0.6F}, -2.5F, -1.5F};
  const double all = NormalShare(strip.begin, strip.end);
  EXPECT_NEAR(static_cast<double>(strip.Share()), all, 1e-7);
  // Halves of the strip along and across it have their shares of the sub-rays of all sets.
  int inner = 0, upper = 0, num = 0;
  const BeamSubRays rays = SubRaysIn(strip, 0, kNumStripSets);
  for (std::size_t i = 0; i < rays.num; ++i) {
    const BeamPlace place{rays.h[i], rays.v[i]};
    EXPECT_GT(strip.Aside(place), strip.begin - 1e-4F);
    EXPECT_LT(strip.Aside(place), strip.end + 1e-4F);
    EXPECT_LE(std::sqrt(place.h * place.h + place.v * place.v), rays.largest_offset);
    inner += strip.Aside(place) > -1.8F ? 1 : 0;
    upper += strip.direction.h * place.h + strip.direction.v * place.v > 0.0F ? 1 : 0;
    ++num;
  }
  EXPECT_NEAR(static_cast<double>(inner) / num, NormalShare(-1.8, -1.5) / all, 0.01);
  EXPECT_EQ(2 * upper, num);
}

}  // namespace
}  // namespace railcast
