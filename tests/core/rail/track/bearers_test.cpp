#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/rail/line/rail_section.h"
#include "core/rail/network/network_draft.h"
#include "core/rail/network/turnout_place.h"
#include "core/rail/track/track_structure.h"
#include "tests/core/rail/test_line.h"

namespace railcast {
namespace {

constexpr double kStraight_m = 500.0;

struct BearerCase {
  std::string name;
  double slope{};  ///< Of the tracks against each other.
  WorldSpec world;
};

WorldSpec BesideMain(double offset_m) {
  WorldSpec world = StraightLine(kStraight_m);
  world.tracks.push_back({.name = "second", .offset_m = offset_m});
  return world;
}

void AddCrossover(WorldSpec& world, TurnoutType type, bool from_main) {
  const std::string from = from_main ? "main" : "second";
  const std::string to = from_main ? "second" : "main";
  world.tracks.push_back({.name = "from_" + from,
                          .begin = TurnoutSpec{from, 100.0, type, {}, {}},
                          .end = TurnoutSpec{to, {}, type, {}, {}}});
}

/// A straight that crosses the main track at 130 m at 1:n from the left.
void AddAcross(WorldSpec& world, double n, const std::vector<std::pair<std::string, double>>& at) {
  constexpr double kCrossing_m = 130.0;
  world.tracks.push_back({.name = "across",
                          .offset_m = kCrossing_m / n,
                          .elements = {{ElementType::kStraight, 350.0, std::nullopt}},
                          .heading_deg = -std::atan(1.0 / n) * 180.0 / std::numbers::pi});
  for (const auto& [track, s_m] : at) {
    world.diamond_crossings.push_back({{track, "across"}, s_m});
  }
}

/// Ladders, crossovers and diamonds whose long bearers come near each other.
std::vector<BearerCase> CloseTurnouts() {
  std::vector<BearerCase> cases;
  for (const TurnoutType type : kTurnoutTypes) {
    const std::string name(NameOf(type));
    const double slope = std::tan(GeometryOf(type).angle_rad);
    for (const double side : {-1.0, 1.0}) {
      WorldSpec ladder = StraightLine(kStraight_m);
      ladder.yards.push_back(
          {.name = "yard",
           .begin =
               TurnoutSpec{
                   "main", 50.0, type, side > 0.0 ? TrackSide::kLeft : TrackSide::kRight, {}},
           .num_tracks = 4,
           .spacing_m = 4.5,
           .usable_length_m = 100.0,
           .electrified = false});
      cases.push_back({"ladder " + name, slope, WithTracksOfYards(ladder)});
      WorldSpec crossover = BesideMain(4.5 * side);
      AddCrossover(crossover, type, true);
      cases.push_back({"crossover " + name, slope, crossover});
    }
  }
  WorldSpec scissors = BesideMain(6.4);
  AddCrossover(scissors, TurnoutType::k9_190, true);
  AddCrossover(scissors, TurnoutType::k9_190, false);
  scissors.diamond_crossings.push_back({{"from_main", "from_second"}, 139.0});
  cases.push_back({"scissors crossover", 2.0 / 9.0, scissors});
  for (const double n : {4.0, 9.0, 20.0}) {
    WorldSpec diamonds = BesideMain(-4.5);
    AddAcross(diamonds, n, {{"main", 130.0}, {"second", 130.0 + 4.5 * n}});
    cases.push_back({"two diamonds of 1:" + std::to_string(n), 1.0 / n, diamonds});
  }
  return cases;
}

/// A sleeper or bearer, and as seen from above.
struct Footprint {
  Transform world_from_bearer;
  Eigen::Vector2d middle_m;
  Eigen::Vector2d ahead;
  Eigen::Vector2d half_m;
};

std::vector<Footprint> BearersOf(const TestLine& line) {
  std::vector<Footprint> bearers;
  for (int index = 0; index < static_cast<int>(kStraight_m / TestLine::kChunkLength_m); ++index) {
    Chunk chunk;
    AddTracks(line.Context(index), line.models(), chunk);
    for (const Placement& placement : chunk.placements) {
      const std::string& name = placement.model->name;
      if (name != "bearer" && name != "concrete_sleeper" && name != "wood_sleeper") continue;
      const Transform pose =
          line.WorldFromChunk(index) * Transform(placement.chunk_from_model.matrix());
      Eigen::AlignedBox3d box;
      // Without their fastenings.
      for (const auto& vertex : placement.model->parts.front().mesh.vertices) {
        box.extend(vertex.cast<double>());
      }
      bearers.push_back({pose, (pose * box.center()).head<2>(),
                         pose.linear().col(0).head<2>().normalized(), 0.5 * box.sizes().head<2>()});
    }
  }
  std::ranges::sort(bearers, {}, [](const Footprint& box) { return box.middle_m.x(); });
  return bearers;
}

/// How far two rectangles lie in each other: the least along the directions of their sides.
double Overlap_m(const Footprint& a, const Footprint& b) {
  double least_m = 100.0;
  for (const Footprint* of : {&a, &b}) {
    for (const Eigen::Vector2d& way : {of->ahead, Eigen::Vector2d(-of->ahead.y(), of->ahead.x())}) {
      const auto reach_m = [&](const Footprint& box) {
        const Eigen::Vector2d left(-box.ahead.y(), box.ahead.x());
        return std::abs(way.dot(box.ahead)) * box.half_m.x() +
               std::abs(way.dot(left)) * box.half_m.y();
      };
      const double apart_m = std::abs(way.dot(a.middle_m - b.middle_m));
      least_m = std::min(least_m, reach_m(a) + reach_m(b) - apart_m);
    }
  }
  return least_m;
}

/// The same ladders and crossovers with 100 mm of cant.
std::vector<BearerCase> CantedTurnouts() {
  std::vector<BearerCase> cases = CloseTurnouts();
  std::erase_if(cases,
                [](const BearerCase& close) { return !close.world.diamond_crossings.empty(); });
  for (BearerCase& close : cases) {
    close.name = "canted " + close.name;
    close.world.alignment.cants_mm = {{0.0, 100.0}, {250.0, 100.0}};
  }
  return cases;
}

/// What is built of a case.
struct BuiltCase {
  explicit BuiltCase(const BearerCase& close)
      : name(close.name), slope(close.slope), line(close.world), bearers(BearersOf(line)) {}
  std::string name;
  double slope;
  TestLine line;
  std::vector<Footprint> bearers;
};

const std::deque<BuiltCase>& BuiltLevel() {
  static const std::vector<BearerCase> cases = CloseTurnouts();
  static const std::deque<BuiltCase> built(cases.begin(), cases.end());
  return built;
}

const std::deque<BuiltCase>& BuiltCanted() {
  static const std::vector<BearerCase> cases = CantedTurnouts();
  static const std::deque<BuiltCase> built(cases.begin(), cases.end());
  return built;
}

TEST(Bearers, DoNotLieInEachOther) {
  for (const auto& cases : {std::cref(BuiltLevel()), std::cref(BuiltCanted())}) {
    for (const BuiltCase& close : cases.get()) {
      const std::vector<Footprint>& bearers = close.bearers;
      ASSERT_GT(bearers.size(), 1000U) << close.name;
      for (std::size_t i = 0; i < bearers.size(); ++i) {
        for (std::size_t j = i + 1; j < bearers.size(); ++j) {
          if (bearers[j].middle_m.x() > bearers[i].middle_m.x() + 3.0) break;
          EXPECT_LT(Overlap_m(bearers[i], bearers[j]), 1e-3)
              << close.name << ": " << bearers[i].middle_m.transpose() << " and "
              << bearers[j].middle_m.transpose();
        }
      }
    }
  }
}

/// The sleepers and bearers that a rail's foot lies on within 4 m of a place, by how far ahead of
/// the place they cross it, and how far above the plane of their seats the rail is there.
std::vector<Eigen::Vector2d> SeatsNear(const std::vector<Footprint>& bearers,
                                       const Transform& world_from_rail) {
  std::vector<Eigen::Vector2d> seats;
  const Vector3 place_m = world_from_rail.translation();
  const Eigen::Vector2d along = world_from_rail.linear().col(0).head<2>().normalized();
  auto at = std::ranges::lower_bound(bearers, place_m.x() - 4.0, {},
                                     [](const Footprint& box) { return box.middle_m.x(); });
  for (; at != bearers.end() && at->middle_m.x() < place_m.x() + 4.0; ++at) {
    const Vector3 from_m = at->world_from_bearer.inverse() * place_m;
    const Eigen::Vector2d ahead(along.dot(at->ahead),
                                along.dot(Eigen::Vector2d(-at->ahead.y(), at->ahead.x())));
    // To where the rail crosses the bearer's middle, along the rail.
    const double way_m = -from_m.x() / ahead.x();
    if (std::abs(from_m.y() + way_m * ahead.y()) > at->half_m.y()) continue;
    seats.push_back({way_m, from_m.z()});
  }
  return seats;
}

/// Calls `judge` for both rails of all tracks with their seats on both sides, every 0.3 m.
template <typename Judge>
void ForEachSeatOfARail(const BuiltCase& built, Judge judge) {
  const TestLine& line = built.line;
  for (std::size_t track = 0; track < line.network().courses.size(); ++track) {
    const TrackCourse& course = line.network().courses[track];
    const double end_s_m = std::min(course.end_s_m(), kStraight_m) - 3.0;
    for (double s_m = std::max(0.0, course.begin_s_m()) + 3.0; s_m < end_s_m; s_m += 0.3) {
      for (const double rail_m : {-0.7535, 0.7535}) {
        const Transform world_from_rail =
            course.WorldFromTrack(line.alignment(), s_m) * Eigen::Translation3d(0.0, rail_m, 0.0);
        judge(SeatsNear(built.bearers, world_from_rail),
              std::to_string(track) + " at " + std::to_string(s_m));
      }
    }
  }
}

TEST(Bearers, CarryEveryRailWithinTheSpacing) {
  // Two neighbours turn against each other by no more than the tracks do, and this not farther from
  // the rail than half a sleeper.
  constexpr double kTurnAside_m = 1.3;
  for (const BuiltCase& close : BuiltLevel()) {
    ForEachSeatOfARail(close,
                       [&](const std::vector<Eigen::Vector2d>& seats, const std::string& where) {
                         double ahead_m = 100.0;
                         double behind_m = 100.0;
                         for (const Eigen::Vector2d& seat : seats) {
                           double& nearest_m = seat.x() > 0.0 ? ahead_m : behind_m;
                           nearest_m = std::min(nearest_m, std::abs(seat.x()));
                         }
                         EXPECT_LE(ahead_m + behind_m, 0.6 + kTurnAside_m * close.slope)
                             << close.name << ", track " << where;
                       });
  }
}

TEST(Bearers, FollowThePlaneOfTheRailsOfCrossoversOnCant) {
  for (const BuiltCase& close : BuiltCanted()) {
    ForEachSeatOfARail(
        close, [&](const std::vector<Eigen::Vector2d>& seats, const std::string& where) {
          for (const Eigen::Vector2d& seat : seats) {
            if (std::abs(seat.x()) > 0.15) continue;
            EXPECT_LE(std::abs(seat.y()), 0.020) << close.name << ", track " << where;
          }
        });
  }
}

}  // namespace
}  // namespace railcast
