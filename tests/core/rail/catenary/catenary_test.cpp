#include "core/rail/catenary/catenary.h"
#include "core/rail/line/line_place.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/core/rail/line/alignment_files.h"
#include "tests/core/rail/test_line.h"

namespace railcast {
namespace {

/// Point of the wire with that surface at chainage `s_m` of a straight from west to east.
Vector3 WireAt(const TestLine& line, const SurfaceClass& surface, double s_m) {
  const int chunk = static_cast<int>(std::floor(s_m / TestLine::kChunkLength_m));
  for (const Wire& wire : WiresInChunk(line.Context(chunk), line.plan())) {
    if (wire.label != surface.label || wire.material != surface.material) continue;
    for (std::size_t i = 0; i + 1 < wire.points_m.size(); ++i) {
      const Vector3 a = line.WorldFromChunk(chunk) * wire.points_m[i];
      const Vector3 b = line.WorldFromChunk(chunk) * wire.points_m[i + 1];
      if (a.x() <= s_m && s_m < b.x()) return a + (s_m - a.x()) / (b.x() - a.x()) * (b - a);
    }
  }
  ADD_FAILURE() << "no wire at " << s_m;
  return Vector3::Zero();
}

TEST(AddCatenary, HangsTheContactWireAtItsHeightAndPresag) {
  const TestLine line(StraightLine(1000.0));
  const SurfaceClass& contact = line.surfaces().contact_wire;
  EXPECT_NEAR(WireAt(line, contact, 130.0).z(), 5.5, 1e-9);
  EXPECT_NEAR(WireAt(line, contact, 130.0).y(), 0.4, 1e-9);
  EXPECT_NEAR(WireAt(line, contact, 195.0).y(), -0.4, 1e-9);
  // At mid-span, where chords of 5 m are 0.4 mm above the parabola.
  EXPECT_NEAR(WireAt(line, contact, 162.5).z(), 5.5 - 0.065, 0.5e-3);
  EXPECT_NEAR(WireAt(line, contact, 162.5).y(), 0.0, 1e-9);
}

TEST(AddCatenary, HangsTheMessengerOnItsParabola) {
  const TestLine line(StraightLine(1000.0));
  const SurfaceClass& messenger = line.surfaces().messenger_wire;
  EXPECT_NEAR(WireAt(line, messenger, 130.0).z(), 7.3, 1e-9);
  for (const double x_m : {10.0, 20.0, 32.5, 60.0}) {
    const double sag_m = 13.0 * x_m * (65.0 - x_m) / (2.0 * 10e3);
    EXPECT_NEAR(WireAt(line, messenger, 130.0 + x_m).z(), 7.3 - sag_m, 2e-3) << x_m;
  }
}

TEST(AddCatenary, JoinsContactWireAndMessengerByDroppers) {
  const TestLine line(StraightLine(1000.0));
  int num_droppers = 0;
  for (int chunk = 0; chunk < 13; ++chunk) {  // Covers ten whole spans of 65 m.
    for (const Wire& wire : WiresInChunk(line.Context(chunk), line.plan())) {
      if (wire.label != line.surfaces().dropper.label) continue;
      ++num_droppers;
      const Vector3 foot = line.WorldFromChunk(chunk) * wire.points_m.front();
      const Vector3 head = line.WorldFromChunk(chunk) * wire.points_m.back();
      EXPECT_LT((foot - WireAt(line, line.surfaces().contact_wire, foot.x())).norm(), 1e-6);
      EXPECT_LT((head - WireAt(line, line.surfaces().messenger_wire, head.x())).norm(), 1e-6);
      EXPECT_GT((head - foot).norm(), 0.5);
    }
  }
  EXPECT_EQ(num_droppers, 10 * 9);  // ceil(65 / 8) = 9 per span.
}

WorldSpec RealLineWithTracksAt(const std::vector<double>& offsets_m) {
  WorldSpec spec;
  spec.alignment = ReadStGallenWil();
  spec.tracks.assign(offsets_m.size(), TrackSpec{});
  for (std::size_t i = 0; i < offsets_m.size(); ++i) spec.tracks[i].offset_m = offsets_m[i];
  return spec;
}

TEST(AddCatenary, TellsEveryWireItsSpan) {
  const TestLine line(RealLineWithTracksAt({0.0, 4.0}));
  std::map<std::uint32_t, Vector3> begin_of_span;
  for (int chunk = 20; chunk < 24; ++chunk) {
    for (const Wire& wire : WiresInChunk(line.Context(chunk), line.plan())) {
      const WireSpan& span = wire.span;
      const Vector3 begin_m = line.WorldFromChunk(chunk) * span.begin_m;
      const auto [known, is_new] = begin_of_span.try_emplace(span.number, begin_m);
      EXPECT_LT((known->second - begin_m).norm(), 1e-6);
      // Its points lie between the supports, straight in plan.
      const Vector3 way_m = span.end_m - span.begin_m;
      const Vector3 side = Vector3::UnitZ().cross(way_m).normalized();
      for (const Vector3& point_m : wire.points_m) {
        EXPECT_NEAR((point_m - span.begin_m).dot(side), 0.0, 1e-9);
        const double at =
            (point_m - span.begin_m).head<2>().dot(way_m.head<2>()) / way_m.head<2>().squaredNorm();
        EXPECT_GE(at, -1e-9);
        EXPECT_LE(at, 1.0 + 1e-9);
      }
      EXPECT_EQ(span.tension_n, 20e3);
      EXPECT_NEAR(span.mass_kg_per_m, 0.89 + 0.44, 0.01);
      EXPECT_DOUBLE_EQ(span.width_m, 0.021);
    }
  }
  // Both tracks' spans of 200 m and what reaches beyond, none twice.
  EXPECT_GE(begin_of_span.size(), 2U * 4U);
  for (const auto& [number, begin_m] : begin_of_span) {
    for (const auto& [other, other_m] : begin_of_span) {
      EXPECT_TRUE(number == other || (begin_m - other_m).norm() > 1.0);
    }
  }
}

TEST(AddCatenary, KeepsTheContactWireAboveThePantographAllAlongARealLine) {
  WorldSpec spec;
  spec.alignment = ReadStGallenWil();
  const TestLine line(spec);
  double widest_m = 0.0;
  double lowest_m = 10.0;
  double highest_m = 0.0;
  const int num_chunks = static_cast<int>(line.alignment().length_m() / TestLine::kChunkLength_m);
  for (int chunk = 0; chunk < num_chunks; ++chunk) {
    const Transform world_from_chunk = line.WorldFromChunk(chunk);
    for (const Wire& wire : WiresInChunk(line.Context(chunk), line.plan())) {
      if (wire.label != line.surfaces().contact_wire.label) continue;
      for (const Vector3& point : wire.points_m) {
        const Vector3 world_m = world_from_chunk * point;
        const double s_m =
            PlaceOnLine(line.alignment(), world_m, (chunk + 0.5) * TestLine::kChunkLength_m).s_m;
        const Vector3 track_m = line.alignment().WorldFromTrack(s_m).inverse() * world_m;
        widest_m = std::max(widest_m, std::abs(track_m.y()));
        lowest_m = std::min(lowest_m, track_m.z());
        highest_m = std::max(highest_m, track_m.z());
      }
    }
  }
  // The plan permits 0.45 m at its samples, 2.5 m apart.
  EXPECT_LE(widest_m, 0.47);
  EXPECT_GT(widest_m, 0.40);
  // Includes the presag and the effect of being up to 0.45 m beside a canted axis.
  EXPECT_GT(lowest_m, 5.5 - 0.065 - 0.05);
  EXPECT_LT(highest_m, 5.5 + 0.05);
}

TEST(AddCatenary, CutsTheSameWireAtAChunksEndAndTheNextOnesBegin) {
  const TestLine line(CantedArc(1000.0, 300.0));
  const auto ends = [&](int chunk, bool last) {
    std::vector<Vector3> points;
    for (const Wire& wire : WiresInChunk(line.Context(chunk), line.plan())) {
      if (wire.label == line.surfaces().dropper.label) continue;
      points.push_back(line.WorldFromChunk(chunk) *
                       (last ? wire.points_m.back() : wire.points_m.front()));
    }
    return points;
  };
  // The last piece of each chunk overlaps the first piece of the next by 1 mm.
  const auto before = ends(4, true);
  const auto after = ends(5, false);
  int num_pairs = 0;
  for (const Vector3& end : before) {
    for (const Vector3& begin : after) {
      if ((end - begin).norm() > 0.1) continue;
      ++num_pairs;
      EXPECT_NEAR((end - begin).norm(), kChunkOverlap_m, 0.05e-3);
    }
  }
  EXPECT_EQ(num_pairs, 2);
}

TEST(AddCatenary, NumbersMastsAlongTheWholeLine) {
  const TestLine line(StraightLine(1000.0));
  std::set<std::uint32_t> instances;
  std::size_t num_masts = 0;
  for (int chunk_index = 0; chunk_index < 20; ++chunk_index) {
    Chunk chunk;
    AddCatenary(line.Context(chunk_index), line.plan(), line.mast_model(), chunk);
    for (const Placement& placement : chunk.placements) {
      if (placement.model != line.mast_model()) continue;
      ++num_masts;
      instances.insert(placement.instance);
      EXPECT_NEAR(
          (line.WorldFromChunk(chunk_index) * Vector3(placement.chunk_from_model.translation()))
              .y(),
          -(3.3 + 0.12), 1e-9);
    }
  }
  EXPECT_EQ(num_masts, line.plan().supports().size());
  EXPECT_EQ(instances.size(), num_masts);
  EXPECT_EQ(*instances.begin(), kFirstMastInstance);
  EXPECT_EQ(*instances.rbegin(), kFirstMastInstance + num_masts - 1);
}

std::vector<Placement> PlacedAt(const TestLine& line, int chunk_index, const std::string& name) {
  Chunk chunk;
  AddCatenary(line.Context(chunk_index), line.plan(), line.mast_model(), chunk);
  std::erase_if(chunk.placements,
                [&](const Placement& placement) { return placement.model->name != name; });
  return chunk.placements;
}

TEST(AddCatenary, HoldsTheWiresWithItsCantilevers) {
  const TestLine line(StraightLine(1000.0));
  const Eigen::AlignedBox3d left = PlacedAt(line, 0, "cantilever").at(0).model->Bounds();
  // In y, from the mast's face on the right to the steady arm's hinge, a metre left of the wire,
  // and the end of its tube; in z, from the clamp of the contact wire to that of the messenger
  // wire.
  EXPECT_NEAR(left.min().y(), -3.3, 0.02);
  EXPECT_NEAR(left.max().y(), 0.4 + 1.0 + 0.15, 0.03);
  EXPECT_NEAR(left.min().z(), 5.5, 0.01);
  EXPECT_NEAR(left.max().z(), 7.3, 0.03);
}

TEST(AddCatenary, CarriesTheMessengerByAStrutFromBelow) {
  const TestLine line(StraightLine(1000.0));
  const Placement cantilever = PlacedAt(line, 0, "cantilever").at(0);
  Eigen::AlignedBox3d insulators;
  for (const Part& part : cantilever.model->parts) {
    if (part.label != line.surfaces().insulator.label ||
        part.material != line.surfaces().insulator.material) {
      continue;
    }
    for (const auto& vertex : part.mesh.vertices) insulators.extend(vertex.cast<double>());
  }
  // The tube at the head is level; the strut rises from its hinge, 0.5 m above the contact wire,
  // by 1.225 m in 3.7 m. Its insulator's second ring, of 0.055 m radius and ten corners, is 0.15 m
  // from the hinge.
  const double along = std::hypot(3.7, 1.225);
  const double lowest_m = 6.0 + 0.15 * 1.225 / along - 0.055 * 3.7 / along;
  EXPECT_NEAR(insulators.min().z(), lowest_m, 0.055 * (1.0 - std::cos(M_PI / 10.0)));
}

/// Distances of the masts' faces from their nearest track axes.
struct FaceDistances {
  double least_m = 100.0;
  double most_m = 0.0;
  std::size_t num_masts = 0;
};

FaceDistances MeasureMasts(const TestLine& line) {
  FaceDistances found;
  const int num_chunks =
      static_cast<int>(std::ceil(line.alignment().length_m() / TestLine::kChunkLength_m));
  for (int chunk = 0; chunk < num_chunks; ++chunk) {
    for (const Placement& mast : PlacedAt(line, chunk, "mast")) {
      const Vector3 world_m =
          line.WorldFromChunk(chunk) * Vector3(mast.chunk_from_model.translation());
      const double s_m =
          PlaceOnLine(line.alignment(), world_m, (chunk + 0.5) * TestLine::kChunkLength_m).s_m;
      const AxisPoint axis = line.alignment().At(s_m);
      const Vector3 left(-std::sin(axis.heading_rad), std::cos(axis.heading_rad), 0.0);
      double nearest_m = 100.0;
      for (const TrackSpec& track : line.spec().tracks) {
        const double d_m = (world_m - axis.position_m).dot(left) - track.offset_m.value_or(0.0);
        nearest_m = std::min(nearest_m, std::abs(d_m) - 0.12);
      }
      found.least_m = std::min(found.least_m, nearest_m);
      found.most_m = std::max(found.most_m, nearest_m);
      ++found.num_masts;
    }
  }
  return found;
}

TEST(AddCatenary, PlacesMastsByTheTracksAxisAllAlongARealLine) {
  // The mast's origin lies up to 0.03 m below the plane of the rails. At a gradient of 2 %, this
  // shifts the section through it by less than a millimetre.
  constexpr double kTolerance_m = 1e-4;
  const FaceDistances two = MeasureMasts(TestLine(RealLineWithTracksAt({0.0, 4.0})));
  EXPECT_EQ(two.num_masts, 944U);
  EXPECT_NEAR(two.least_m, 3.3, kTolerance_m);
  EXPECT_NEAR(two.most_m, 3.3, kTolerance_m);
}

TEST(AddCatenary, KeepsMastsOutOfTheTrainsWayBesideAnyNumberOfTracks) {
  for (const std::vector<double>& offsets_m : std::vector<std::vector<double>>{
           {0.0, 4.0, 8.0}, {0.0, 4.5, 9.0, -4.5}, {0.0, 3.0, 6.0, 9.0}, {-9.3, 0.0, 5.0}}) {
    const FaceDistances found = MeasureMasts(TestLine(RealLineWithTracksAt(offsets_m)));
    EXPECT_GE(found.least_m, 2.2) << offsets_m.size();
    EXPECT_GE(found.num_masts, 944U);
  }
}

TEST(AddCatenary, ReachesFromMastsAndPostsToTheShiftedWires) {
  WorldSpec spec = CantedArc(1000.0, 300.0);
  spec.tracks.assign(3, TrackSpec{});
  spec.tracks[1].offset_m = 4.0;
  spec.tracks[2].offset_m = 8.0;
  const TestLine line(spec);
  // Displacement at the wire's height of 5.5 m by a cant of 150 mm to the left.
  const double shift_m = 5.5 * 0.1;
  const auto cantilevers = PlacedAt(line, 10, "cantilever");
  ASSERT_EQ(cantilevers.size(), 3U);
  EXPECT_NEAR(cantilevers[0].model->Bounds().min().y(), -3.3 - shift_m, 0.02);
  EXPECT_NEAR(cantilevers[2].model->Bounds().max().y(), 3.3 - shift_m, 0.02);
  // The post hangs halfway between the pantographs.
  EXPECT_NEAR(cantilevers[1].model->Bounds().min().y(), -2.0 + 0.12, 0.02);

  const auto portals = PlacedAt(line, 10, "portal");
  ASSERT_EQ(portals.size(), 1U);
  const Eigen::AlignedBox3d beam = portals[0].model->Bounds();
  EXPECT_NEAR(beam.min().y(), -3.42 - 0.12 - shift_m, 1e-3);
  EXPECT_NEAR(beam.max().y(), 8.0 + 3.42 + 0.12 - shift_m, 1e-3);
  EXPECT_NEAR(beam.max().z(), 8.24, 1e-6);
  // The posts end below the strut's hinge, 0.5 m above the contact wire.
  EXPECT_NEAR(beam.min().z(), 5.8, 1e-6);
  for (const Placement& cantilever : cantilevers) {
    EXPECT_EQ(cantilever.instance, portals[0].instance);
  }
}

/// A loop beside a straight track, from one turnout to another.
WorldSpec LoopBeside(TurnoutType type, double offset_m, double begin_s_m) {
  WorldSpec spec = StraightLine(1000.0);
  spec.tracks.assign(2, TrackSpec{});
  spec.tracks[1].name = "loop";
  spec.tracks[1].offset_m = offset_m;
  spec.tracks[1].begin = TurnoutSpec{"main", begin_s_m, type, {}, {}};
  spec.tracks[1].end = TurnoutSpec{"main", begin_s_m + 600.0, type, {}, {}};
  return spec;
}

TEST(AddCatenary, KeepsTheWiresOfABranchAboveItsPantographAndApartFromTheOthers) {
  for (const TurnoutType type : kTurnoutTypes) {
    for (const double offset_m : {4.5, -4.5}) {
      for (const double begin_s_m : {150.0, 171.0, 196.0}) {
        const TestLine line(LoopBeside(type, offset_m, begin_s_m));
        const TrackCourse& loop = line.network().courses[1];
        double widest_m = 0.0;
        double nearest_m = 100.0;
        double covered_m = 0.0;
        for (int chunk = 0; chunk < 20; ++chunk) {
          for (const Wire& wire : WiresInChunk(line.Context(chunk), line.plan())) {
            if (wire.label != line.surfaces().contact_wire.label || wire.span.number % 2 == 0 ||
                wire.material != line.surfaces().contact_wire.material || wire.radius_m != 0.006) {
              continue;
            }
            const Transform world_from_chunk = line.WorldFromChunk(chunk);
            for (const Vector3& point : wire.points_m) {
              const Vector3 own_m = world_from_chunk * point;
              if (own_m.x() < loop.begin_s_m() || own_m.x() > loop.end_s_m()) continue;
              covered_m = std::max(covered_m, own_m.x());
              const TrackOffset axis = loop.OffsetAt(own_m.x());
              const double across = 1.0 / std::hypot(1.0, axis.slope);
              widest_m = std::max(widest_m, across * std::abs(own_m.y() - axis.d_m));
              // A rounded chainage may lie in the chunk before.
              if (std::abs(std::remainder(own_m.x(), TestLine::kChunkLength_m)) < 1e-3) continue;
              const Vector3 main_m = WireAt(line, line.surfaces().contact_wire, own_m.x());
              nearest_m = std::min(nearest_m, std::abs(own_m.y() - main_m.y()));
            }
          }
        }
        // The plan samples every 2.5 m, over which an arc of 190 m rises by 4 mm.
        EXPECT_LE(widest_m, 0.4 + 0.05 + 0.004) << begin_s_m;
        EXPECT_GT(widest_m, 0.2);
        EXPECT_GT(covered_m, loop.end_s_m() - 5.0);
        // The parent's wire is straight in plan as well, so both are nearest at a support.
        EXPECT_GE(nearest_m, 0.2 - 1e-6) << begin_s_m;
      }
    }
  }
}

}  // namespace
}  // namespace railcast
