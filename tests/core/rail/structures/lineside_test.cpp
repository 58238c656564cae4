#include "railcast/lineside.h"

#include <gtest/gtest.h>

#include "core/rail/clearance/cleared.h"
#include "core/rail/structures/lineside_models.h"
#include "core/rail/structures/structures.h"
#include "core/rail/track/cross_section.h"
#include "tests/core/rail/structures/structure_probe.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

/// Two coordinates of a chunk's frame in float32, up to 50 m.
constexpr double kChunkRounding_m = 1e-5;

template <class Spec>
Spec ThingAt(double s_m) {
  Spec spec;
  spec.name = "thing";
  spec.s_m = s_m;
  return spec;
}

SignalSpec SignalAt(double s_m, SignalKind kind) {
  SignalSpec signal = ThingAt<SignalSpec>(s_m);
  signal.kind = kind;
  return signal;
}

BoardSpec BoardAt(double s_m, BoardKind kind) {
  BoardSpec board = ThingAt<BoardSpec>(s_m);
  board.kind = kind;
  return board;
}

FurnitureSpec FurnitureAt(double s_m, FurnitureKind kind) {
  FurnitureSpec furniture = ThingAt<FurnitureSpec>(s_m);
  furniture.kind = kind;
  return furniture;
}

BuildingSpec House() {
  return {.name = "house",
          .footprint_m = {{110.0, 10.0}, {122.0, 10.0}, {122.0, 18.0}, {110.0, 18.0}}};
}

WorldSpec CurveWith(const StructureSpec& structure) {
  WorldSpec spec = CantedArc(300.0, 400.0);
  spec.structures = {structure};
  return spec;
}

/// The surface's points, at (s, d, h) relative to the alignment's top of rail at `s_m`: x and y in
/// the level frame of the line there.
std::vector<Vector3> PointsOfSurface(const TestLine& line,
                                     const SurfaceClass& surface,
                                     double s_m) {
  const int index = static_cast<int>(s_m / TestLine::kChunkLength_m);
  Chunk chunk;
  AddStructures(line.Context(index), chunk);
  const AxisPoint axis = line.alignment().At(s_m);
  const Transform axis_from_chunk =
      MakeTransform(RotationFromYawPitchRoll(axis.heading_rad, 0.0, 0.0), axis.position_m)
          .inverse() *
      line.WorldFromChunk(index);
  std::vector<Vector3> points;
  for (const Eigen::Vector3f& vertex : MeshOfSurface(chunk, surface).vertices) {
    points.emplace_back(axis_from_chunk * vertex.cast<double>());
  }
  return points;
}

Eigen::AlignedBox3d BoundsOfSurface(const TestLine& line, const SurfaceClass& surface, double s_m) {
  Eigen::AlignedBox3d box;
  for (const Vector3& point : PointsOfSurface(line, surface, s_m)) box.extend(point);
  return box;
}

TEST(Lineside, IsSeenByABeamAtTheMiddleOfEachThing) {
  struct Row {
    StructureSpec structure;
    SurfaceClass LinesideSurfaces::*surface;
    Vector3 middle;  ///< Chainage, d, h.
  };
  const std::vector<Row> rows = {
      {SignalAt(120.0, SignalKind::kMain), &LinesideSurfaces::signal_mast, {120, -3.1, 4.8}},
      {SignalAt(120.0, SignalKind::kDistant), &LinesideSurfaces::signal_mast, {120, -3.1, 4.0}},
      {SignalAt(120.0, SignalKind::kShunting), &LinesideSurfaces::signal_mast, {120, -2.2, 0.5}},
      {BoardAt(120.0, BoardKind::kSpeed), &LinesideSurfaces::board_face, {120, -3.0, 1.95}},
      {BoardAt(120.0, BoardKind::kSpeedAnnouncement),
       &LinesideSurfaces::board_face,
       {120, -3.0, 2.1}},
      {BoardAt(120.0, BoardKind::kKilometre), &LinesideSurfaces::board_face, {120, -3.0, 0.5}},
      {BoardAt(120.0, BoardKind::kFoulingPoint), &LinesideSurfaces::board_face, {120, -2.0, -0.1}},
      {ThingAt<BaliseSpec>(120.0), &LinesideSurfaces::balise, {120, 0.0, -0.19}},
      {ThingAt<DerailerSpec>(120.0), &LinesideSurfaces::derailer, {120, -0.75, -0.05}},
      {ThingAt<RelayBoxSpec>(120.0), &LinesideSurfaces::relay_box, {120, -4.0, 0.0}},
      {FurnitureAt(120.0, FurnitureKind::kLamp), &LinesideSurfaces::furniture_steel, {120, -5, 2}},
      {FurnitureAt(120.0, FurnitureKind::kBench),
       &LinesideSurfaces::furniture_wood,
       {120, -5, -0.3}},
      {FurnitureAt(120.0, FurnitureKind::kShelter),
       &LinesideSurfaces::furniture_glass,
       {120, -5.6, 0.5}},
      {House(), &LinesideSurfaces::wall, {116.0, 14.0, 2.0}},
      {BufferStopSpec{.name = "stop", .track = "main", .at = TrackTip::kEnd},
       &LinesideSurfaces::buffer_frame,
       {298.0, 0.0, 1.0}},
      {BufferStopSpec{.name = "stop", .track = "main", .at = TrackTip::kBegin},
       &LinesideSurfaces::buffer_frame,
       {2.0, 0.0, 1.0}}};
  for (const Row& row : rows) {
    const StructureProbe probe(CurveWith(row.structure));
    const SurfaceClass& surface = probe.line().surfaces().structures.lineside.*row.surface;
    const Vector3 back = row.middle.x() < 10.0 ? Vector3(-20.0, 0.0, 0.0) : Vector3(20.0, 0.0, 0.0);
    const Vector3 eye(row.middle.x() - back.x(), 0.0, 2.5);
    EXPECT_EQ(probe.LabelSeen(eye, row.middle), surface.label)
        << "structure type " << row.structure.index() << " at " << row.middle.transpose();
  }
}

TEST(Lineside, FacesTheTrainsOfItsDirectionOnTheirRight) {
  for (const RunningDirection direction : {RunningDirection::kRising, RunningDirection::kFalling}) {
    const double ahead = direction == RunningDirection::kRising ? 1.0 : -1.0;
    BoardSpec board = BoardAt(120.0, BoardKind::kSpeed);
    board.direction = direction;
    const StructureProbe probe(CurveWith(board));
    const LinesideSurfaces& surfaces = probe.line().surfaces().structures.lineside;
    const Eigen::AlignedBox3d face = BoundsOfSurface(probe.line(), surfaces.board_face, 120.0);
    EXPECT_NEAR(face.center().y(), -3.0 * ahead, kChunkRounding_m);
    EXPECT_NEAR(face.center().x(), -0.034 * ahead, kChunkRounding_m) << "It must be in front.";
    EXPECT_NEAR(face.max().z(), 2.4, kChunkRounding_m);
  }
  BoardSpec left = BoardAt(120.0, BoardKind::kSpeed);
  left.side = TrackSide::kLeft;
  left.distance_m = 2.6;
  left.height_m = 3.2;
  left.size_m = {0.5, 0.6};
  const StructureProbe probe(CurveWith(left));
  const Eigen::AlignedBox3d face =
      BoundsOfSurface(probe.line(), probe.line().surfaces().structures.lineside.board_face, 120.0);
  EXPECT_NEAR(face.center().y(), 2.6, kChunkRounding_m);
  EXPECT_NEAR(face.max().z(), 3.2, kChunkRounding_m);
  EXPECT_NEAR(face.sizes().y(), 0.5, kChunkRounding_m);
  EXPECT_NEAR(face.sizes().z(), 0.6, kChunkRounding_m);
}

TEST(Lineside, LaysTheBaliseOnTheMiddleOfTheNearestSleeper) {
  for (const auto& [sleeper, top_m] :
       {std::pair(SleeperType::kConcrete, -0.221), std::pair(SleeperType::kWood, -0.190)}) {
    WorldSpec spec = StraightLine(300.0);
    spec.tracks.front().sleeper = sleeper;
    spec.structures = {ThingAt<BaliseSpec>(120.2)};
    const StructureProbe probe(spec);
    const Eigen::AlignedBox3d box =
        BoundsOfSurface(probe.line(), probe.line().surfaces().structures.lineside.balise, 120.0);
    EXPECT_NEAR(box.center().x(), 0.0, kChunkRounding_m);
    EXPECT_NEAR(box.center().y(), 0.0, kChunkRounding_m);
    EXPECT_NEAR(box.min().z(), top_m, kChunkRounding_m);
    EXPECT_NEAR(box.sizes().x(), 0.358, kChunkRounding_m);
  }
}

TEST(Lineside, EndsTheTrackWithTheBufferStop) {
  WorldSpec spec = StraightLine(300.0);
  spec.tracks.front().start_s_m = 20.0;
  spec.tracks.front().end_s_m = 240.0;
  BufferStopSpec begin{.name = "a", .track = "main", .at = TrackTip::kBegin};
  BufferStopSpec end{.name = "b", .track = "main", .at = TrackTip::kEnd};
  spec.structures = {begin, end};
  const StructureProbe probe(spec);
  const SurfaceClass& frame = probe.line().surfaces().structures.lineside.buffer_frame;
  const Eigen::AlignedBox3d first = BoundsOfSurface(probe.line(), frame, 20.0);
  EXPECT_NEAR(first.min().x(), 0.0, kChunkRounding_m);
  EXPECT_NEAR(first.max().x(), kBufferStopLength_m, kChunkRounding_m);
  const Eigen::AlignedBox3d last = BoundsOfSurface(probe.line(), frame, 239.0);
  EXPECT_NEAR(last.min().x(), 1.0 - kBufferStopLength_m, kChunkRounding_m);
  EXPECT_NEAR(last.max().x(), 1.0, kChunkRounding_m);
}

TEST(Lineside, StandsOnThePlatformThatIsThere) {
  PlatformSpec platform = StructureBeside<PlatformSpec>(TrackSide::kRight, "platform", 60.0, 190.0);
  platform.width_m = 5.0;
  WorldSpec spec = StraightLine(300.0);
  spec.structures = {platform, FurnitureAt(120.0, FurnitureKind::kBench)};
  const StructureProbe probe(spec);
  const SurfaceClass& wood = probe.line().surfaces().structures.lineside.furniture_wood;
  EXPECT_NEAR(BoundsOfSurface(probe.line(), wood, 120.0).max().z(), 0.76 + 0.80, kChunkRounding_m);
  FurnitureSpec lower = FurnitureAt(120.0, FurnitureKind::kBench);
  lower.h_m = 0.2;
  spec.structures.back() = lower;
  const StructureProbe below(spec);
  EXPECT_NEAR(BoundsOfSurface(below.line(), wood, 120.0).max().z(), 0.2 + 0.80, kChunkRounding_m);
}

TEST(Lineside, BuildsBetweenTheCornersOfTheFootprint) {
  const StructureProbe probe(CurveWith(House()));
  const TestLine& line = probe.line();
  const SurfaceClass& wall = line.surfaces().structures.lineside.wall;
  const std::vector<Vector3> points = PointsOfSurface(line, wall, 116.0);
  const AxisPoint axis = line.alignment().At(116.0);
  const Transform axis_from_world =
      MakeTransform(RotationFromYawPitchRoll(axis.heading_rad, 0.0, 0.0), axis.position_m)
          .inverse();
  for (const auto& [s_m, d_m] : House().footprint_m) {
    const Vector3 corner =
        axis_from_world * line.alignment().WorldFromTrack(s_m, d_m).translation();
    double nearest_m = 1.0;
    for (const Vector3& point : points) {
      nearest_m = std::min(nearest_m, (point - corner).head<2>().norm());
    }
    EXPECT_LT(nearest_m, kChunkRounding_m) << s_m << ", " << d_m;
  }
}

TEST(Lineside, BelongsToOneChunkWhereverItsPartsReach) {
  BuildingSpec building = House();
  building.footprint_m = {{60.0, 10.0}, {170.0, 10.0}, {170.0, 18.0}, {60.0, 18.0}};
  EXPECT_GE(OverhangOf_m(building), 55.0);
  const StructureProbe probe(CurveWith(building));
  for (int chunk = 0; chunk < 6; ++chunk) {
    Chunk built;
    AddStructures(probe.line().Context(chunk), built);
    EXPECT_EQ(built.ground.parts.empty(), chunk != 2) << chunk;
  }
}

TEST(Lineside, KeepsPlantsOutOfBuildingsAndMastsOffSignals) {
  const WorldSpec house = CurveWith(House());
  EXPECT_TRUE(IsCleared(house, 116.0, 14.0, Clearing::kTree));
  EXPECT_TRUE(IsCleared(house, 116.0, 14.0, Clearing::kGrass));
  EXPECT_FALSE(IsCleared(house, 116.0, 6.0, Clearing::kTree));
  const WorldSpec signal = CurveWith(SignalAt(120.0, SignalKind::kMain));
  EXPECT_TRUE(IsCleared(signal, 120.5, -3.3, Clearing::kMast));
  EXPECT_FALSE(IsCleared(signal, 122.0, -3.3, Clearing::kMast));
}

}  // namespace
}  // namespace railcast
