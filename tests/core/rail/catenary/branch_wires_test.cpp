#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "core/rail/catenary/catenary.h"
#include "core/rail/clearance/tunnel_shape.h"
#include "core/rail/network/network_draft.h"
#include "core/rail/world/world_draft.h"
#include "railcast/scenario.h"
#include "tests/core/rail/test_line.h"

namespace railcast {
namespace {

constexpr int kNumChunks = 20;

/// A world on a straight from west to east, so that chainage is x and offset y.
struct BranchCase {
  std::string name;
  WorldSpec world;
};

/// A loop, a crossover and an electrified ladder for each type of turnout, on both sides.
std::vector<BranchCase> BranchCases() {
  std::vector<BranchCase> cases;
  for (const TurnoutType type : kTurnoutTypes) {
    for (const double side : {-1.0, 1.0}) {
      const std::string name = std::to_string(static_cast<int>(type)) + (side > 0.0 ? "l" : "r");
      WorldSpec loop = StraightLine(1000.0);
      loop.tracks.push_back({.name = "loop",
                             .offset_m = 4.5 * side,
                             .begin = TurnoutSpec{"main", 171.0, type, {}, {}},
                             .end = TurnoutSpec{"main", 771.0, type, {}, {}}});
      cases.push_back({"loop " + name, loop});
      WorldSpec crossover = StraightLine(1000.0);
      crossover.tracks.push_back({.name = "second", .offset_m = 4.5 * side});
      crossover.tracks.push_back({.name = "crossover",
                                  .begin = TurnoutSpec{"main", 300.0, type, {}, {}},
                                  .end = TurnoutSpec{"second", {}, type, {}, {}}});
      cases.push_back({"crossover " + name, crossover});
      WorldSpec ladder = StraightLine(1000.0);
      const TrackSide hand = side > 0.0 ? TrackSide::kLeft : TrackSide::kRight;
      ladder.yards.push_back({.name = "yard",
                              .begin = TurnoutSpec{"main", 100.0, type, hand, {}},
                              .num_tracks = 4,
                              .spacing_m = 4.5,
                              .usable_length_m = 200.0,
                              .electrified = true});
      cases.push_back({"ladder " + name, WithTracksOfYards(ladder)});
    }
  }
  return cases;
}

/// The same with 100 mm of cant all along the straight.
std::vector<BranchCase> CantedBranchCases() {
  std::vector<BranchCase> cases = BranchCases();
  for (BranchCase& branch : cases) {
    branch.name = "canted " + branch.name;
    branch.world.alignment.cants_mm = {{0.0, 100.0}, {500.0, 100.0}};
  }
  return cases;
}

TEST(BranchWires, KeepTheStrictLimitsButForSomeSpansOfARealStation) {
  for (const BranchCase& branch : BranchCases()) {
    EXPECT_EQ(TestLine(branch.world).plan().num_relaxed_spans(), 0U) << branch.name;
  }
  const ScenarioSpec throat =
      ReadScenario(RAILCAST_SOURCE_DIR "/scenarios/osm_sankt_poelten/station_throat.json");
  const Alignment alignment(throat.world.alignment);
  const Network network = MakeNetwork(throat.world, alignment.length_m());
  const CatenaryPlan plan({throat.world, network.courses}, alignment);
  EXPECT_EQ(plan.supports().size(), 277U);
  EXPECT_EQ(plan.num_relaxed_spans(), 20U);
}

struct Piece {
  std::uint32_t track{};
  double radius_m{};
  Vector3 a_m;
  Vector3 b_m;
};

std::vector<Piece> WiresOf(const TestLine& line, bool are_droppers) {
  // Droppers are thinner than contact wire and messenger.
  constexpr double kThinnestLongWire_m = 0.004;
  std::vector<Piece> pieces;
  const auto num_tracks = static_cast<std::uint32_t>(line.spec().tracks.size());
  for (int chunk = 0; chunk < kNumChunks; ++chunk) {
    const Transform world_from_chunk = line.WorldFromChunk(chunk);
    for (const Wire& wire : WiresInChunk(line.Context(chunk), line.plan())) {
      if ((wire.radius_m < kThinnestLongWire_m) != are_droppers) continue;
      for (std::size_t i = 0; i + 1 < wire.points_m.size(); ++i) {
        pieces.push_back({wire.span.number % num_tracks, wire.radius_m,
                          world_from_chunk * wire.points_m[i],
                          world_from_chunk * wire.points_m[i + 1]});
      }
    }
  }
  std::ranges::sort(pieces, {}, [](const Piece& piece) { return piece.a_m.x(); });
  return pieces;
}

std::vector<Piece> ContactAndMessengerWires(const TestLine& line) {
  return WiresOf(line, false);
}

/// Nearest distance of two pieces, over chainages in steps of 0.1 m: both are nearly parallel to x.
double AirBetween_m(const Piece& p, const Piece& q) {
  const double begin_m = std::max(p.a_m.x(), q.a_m.x());
  const double end_m = std::min(p.b_m.x(), q.b_m.x());
  double least_m = 100.0;
  const auto at = [](const Piece& piece, double x_m) -> Vector3 {
    const double fraction = (x_m - piece.a_m.x()) / (piece.b_m.x() - piece.a_m.x());
    return piece.a_m + fraction * (piece.b_m - piece.a_m);
  };
  for (double x_m = begin_m; x_m <= end_m; x_m += 0.1) {
    least_m = std::min(least_m, (at(p, x_m) - at(q, x_m)).norm());
  }
  return least_m - p.radius_m - q.radius_m;
}

TEST(BranchWires, HaveAirBetweenThemAndTheWiresOfOtherTracks) {
  std::vector<BranchCase> cases = BranchCases();
  std::ranges::move(CantedBranchCases(), std::back_inserter(cases));
  for (const BranchCase& branch : cases) {
    const TestLine line(branch.world);
    const std::vector<Piece> pieces = ContactAndMessengerWires(line);
    ASSERT_GT(pieces.size(), 500U) << branch.name;
    double least_m = 100.0;
    double where_m = 0.0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      for (std::size_t j = i + 1; j < pieces.size() && pieces[j].a_m.x() < pieces[i].b_m.x(); ++j) {
        if (pieces[i].track == pieces[j].track) continue;
        const double air_m = AirBetween_m(pieces[i], pieces[j]);
        if (air_m < least_m) where_m = pieces[j].a_m.x();
        least_m = std::min(least_m, air_m);
      }
    }
    EXPECT_GE(least_m, 0.020) << branch.name << " at " << where_m;
    EXPECT_LT(least_m, 0.5) << branch.name;
  }
}

/// From a wire that passes a dropper to that dropper, which is nearly upright.
double AirBesideDropper_m(const Piece& dropper, const Piece& wire) {
  const double fraction = (dropper.a_m.x() - wire.a_m.x()) / (wire.b_m.x() - wire.a_m.x());
  const Vector3 place_m = wire.a_m + fraction * (wire.b_m - wire.a_m);
  const Vector3 way_m = dropper.b_m - dropper.a_m;
  const double nearest =
      std::clamp((place_m - dropper.a_m).dot(way_m) / way_m.squaredNorm(), 0.0, 1.0);
  return (dropper.a_m + nearest * way_m - place_m).norm() - dropper.radius_m - wire.radius_m;
}

TEST(BranchWires, HaveAirBetweenTheirDroppersAndTheWiresOfOtherTracks) {
  std::vector<BranchCase> cases = BranchCases();
  std::ranges::move(CantedBranchCases(), std::back_inserter(cases));
  for (const BranchCase& branch : cases) {
    const TestLine line(branch.world);
    const std::vector<Piece> wires = ContactAndMessengerWires(line);
    const std::vector<Piece> droppers = WiresOf(line, true);
    ASSERT_GT(droppers.size(), 200U) << branch.name;
    for (const Piece& dropper : droppers) {
      for (const Piece& wire : wires) {
        if (wire.a_m.x() > dropper.a_m.x()) break;
        if (wire.b_m.x() < dropper.a_m.x() || wire.track == dropper.track) continue;
        EXPECT_GE(AirBesideDropper_m(dropper, wire), 0.020)
            << branch.name << ", track " << dropper.track << " at " << dropper.a_m.x();
      }
    }
  }
}

TEST(BranchWires, EndWithTheirTracksWhereNoTurnoutLeadsOn) {
  for (const BranchCase& branch : BranchCases()) {
    const TestLine line(branch.world);
    std::size_t num_free_ends = 0;
    for (const bool are_droppers : {false, true}) {
      for (const Piece& piece : WiresOf(line, are_droppers)) {
        const TrackCourse& course = line.network().courses[piece.track];
        if (line.spec().tracks[piece.track].end || course.end_s_m() >= 1000.0) continue;
        EXPECT_LE(piece.b_m.x(), course.end_s_m()) << branch.name << ", track " << piece.track;
        ++num_free_ends;
      }
    }
    EXPECT_EQ(num_free_ends > 0, branch.name.starts_with("ladder")) << branch.name;
  }
}

TEST(BranchWires, KeepTheirHeightAboveTheCantedPlaneOfTheirOwnTrack) {
  constexpr double kChordError_m = 2e-3;
  for (const BranchCase& branch : CantedBranchCases()) {
    const TestLine line(branch.world);
    const CatenarySpec& spec = line.spec().catenary;
    const double cos_cant = std::cos(line.alignment().At(0.0).cant_rad);
    double most_lift_m = 0.0;
    for (const Piece& piece : ContactAndMessengerWires(line)) {
      const TrackCourse& course = line.network().courses[piece.track];
      const double s_m = piece.a_m.x();
      if (piece.radius_m < 0.006 || s_m < course.begin_s_m() || s_m > course.end_s_m()) continue;
      const Vector3 axis_m = course.WorldFromTrack(line.alignment(), s_m).translation();
      const double too_high_m = piece.a_m.z() - axis_m.z() - spec.contact_height_m * cos_cant;
      EXPECT_LE(too_high_m, kRunInLift_m + kChordError_m) << branch.name << " at " << s_m;
      EXPECT_GE(too_high_m, -kContactPresag * spec.max_span_m - kChordError_m)
          << branch.name << " at " << s_m;
      most_lift_m = std::max(most_lift_m, std::abs(axis_m.z()));
    }
    EXPECT_GT(most_lift_m, 0.1) << branch.name;
  }
}

/// What stands or hangs at a support: an interval of offsets.
struct Part1d {
  std::string name;
  double s_m{};
  double right_m{};
  double left_m{};
};

std::vector<Part1d> PartsOfSupports(const TestLine& line) {
  std::vector<Part1d> parts;
  for (int index = 0; index < kNumChunks; ++index) {
    Chunk chunk;
    AddCatenary(line.Context(index), line.plan(), line.mast_model(), chunk);
    for (const Placement& placement : chunk.placements) {
      const Eigen::Affine3d world_from_model =
          Eigen::Affine3d(line.WorldFromChunk(index)) * placement.chunk_from_model;
      const double d_m = world_from_model.translation().y();
      const bool is_mast = placement.model->name == "mast";
      // The block below a mast is wider than the mast.
      const Eigen::AlignedBox3d box = placement.model->Bounds();
      parts.push_back({placement.model->name, world_from_model.translation().x(),
                       is_mast ? d_m - 0.12 : d_m + box.min().y(),
                       is_mast ? d_m + 0.12 : d_m + box.max().y()});
    }
  }
  return parts;
}

TEST(BranchWires, HangFromMastsClearOfAllTracks) {
  for (const BranchCase& branch : BranchCases()) {
    const TestLine line(branch.world);
    std::size_t num_masts = 0;
    for (const Part1d& mast : PartsOfSupports(line)) {
      if (mast.name != "mast") continue;
      ++num_masts;
      for (const TrackCourse& course : line.network().courses) {
        // Half a wagon may stand beyond the end of a track.
        constexpr double kBeyond_m = 10.0;
        const double on_s_m = std::clamp(mast.s_m, course.begin_s_m(), course.end_s_m());
        if (std::abs(mast.s_m - on_s_m) > kBeyond_m) continue;
        const TrackOffset axis = course.OffsetAt(on_s_m);
        const double across = 1.0 / std::hypot(1.0, axis.slope);
        EXPECT_GE(across * (std::abs(0.5 * (mast.right_m + mast.left_m) - axis.d_m) - 0.12), 2.2)
            << branch.name << " at " << mast.s_m;
      }
    }
    EXPECT_GT(num_masts, 20U) << branch.name;
  }
}

TEST(BranchWires, HangFromCantileversThatDoNotMeetNorReachThroughMasts) {
  // A hinge and the end of its tube reach 0.012 m into the face of their mast.
  constexpr double kHinge_m = 0.013;
  for (const BranchCase& branch : BranchCases()) {
    const TestLine line(branch.world);
    const std::vector<Part1d> parts = PartsOfSupports(line);
    std::size_t num_pairs = 0;
    for (const Part1d& cantilever : parts) {
      if (cantilever.name != "cantilever") continue;
      for (const Part1d& other : parts) {
        if (&other == &cantilever || other.name == "portal") continue;
        if (std::abs(other.s_m - cantilever.s_m) > 0.5) continue;
        ++num_pairs;
        EXPECT_TRUE(other.left_m <= cantilever.right_m + kHinge_m ||
                    cantilever.left_m <= other.right_m + kHinge_m)
            << branch.name << " at " << other.s_m << ": " << cantilever.right_m << " to "
            << cantilever.left_m << ", " << other.name << " " << other.right_m << " to "
            << other.left_m;
      }
    }
    EXPECT_GT(num_pairs, 20U) << branch.name;
  }
}

}  // namespace
}  // namespace railcast
