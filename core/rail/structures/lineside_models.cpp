#include "core/rail/structures/lineside_models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numeric>
#include <string>

#include "core/base/error.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

using S = LinesideSurfaces;

/// A coordinate in a model's frame: a sum of 1 m and of the lengths that a thing leaves open, each
/// times a factor.
struct LinesideCoordinate {
  constexpr LinesideCoordinate(double value_m) : factors{value_m} {}
  constexpr LinesideCoordinate(std::size_t of, double factor) : factors{} { factors[of] = factor; }
  std::array<double, 5> factors;  ///< Times 1 m, half the length, half the depth, height, shift.
};

constexpr LinesideCoordinate operator+(LinesideCoordinate a, const LinesideCoordinate& b) {
  for (std::size_t i = 0; i < a.factors.size(); ++i) a.factors[i] += b.factors[i];
  return a;
}

constexpr LinesideCoordinate operator-(LinesideCoordinate a, const LinesideCoordinate& b) {
  for (std::size_t i = 0; i < a.factors.size(); ++i) a.factors[i] -= b.factors[i];
  return a;
}

// Where things of that length, depth and height end, and the shift of the rails.
constexpr LinesideCoordinate kX(1, 1.0);
constexpr LinesideCoordinate kY(2, 1.0);
constexpr LinesideCoordinate kZ(3, 1.0);
constexpr LinesideCoordinate kShift(4, 1.0);
constexpr LinesideCoordinate kSeatX(1, 0.7);  // The end of a shelter's bench.
// The main signal's lamps are in the middles of thirds of its screen.
constexpr LinesideCoordinate kUpper = kZ - 1.4 * 0.5 / 3.0;
constexpr LinesideCoordinate kMiddle = kZ - 1.4 * 1.5 / 3.0;
constexpr LinesideCoordinate kLower = kZ - 1.4 * 2.5 / 3.0;

/// A box between two corners or, if it has sides, a tube along an axis.
struct LinesideShape {
  SurfaceClass S::*surface;
  std::array<LinesideCoordinate, 3> begin;  ///< The corner of least coordinates if it is a box.
  std::array<LinesideCoordinate, 3> end;
  double radius_m = 0.0;  ///< From the axis to the corners of the section.
  int num_sides = 0;
  double taper_m = 0.0;   ///< By how much the tube is thinner at its end.
  double roll_rad = 0.0;  ///< By how much the box is turned about its middle's x axis.
};

struct LinesideThing {
  std::string_view name;
  std::initializer_list<LinesideShape> shapes;  ///< Parts and triangles have their order.
};

/// The things. Lamps of 200 mm are two tubes, hood and lens: the lens closes the hood, a little
/// proud of it, since its inside is black and deep.
constexpr LinesideThing kLinesideThings[] = {
    // A mast of 140 mm with a black screen of 0.80 x 1.40 m whose top is `height_m` above top of
    // rail, three lamps with hoods, and a retroreflecting mast board of 150 x 750 mm. 232
    // triangles.
    {"main_signal",
     {{&S::signal_mast, {0.0, 0.0, kFoot_m}, {0.0, 0.0, kZ}, 0.07, 8},
      {&S::signal_foot, {-0.3, -0.3, -1.4}, {0.3, 0.3, -0.55}},
      {&S::signal_screen, {-0.11, -0.4, kZ - 1.4}, {-0.07, 0.4, kZ}},
      {&S::signal_screen, {-0.11, 0.0, kUpper}, {-0.31, 0.0, kUpper}, 0.12, 8},
      {&S::signal_lamp, {-0.31, 0.0, kUpper}, {-0.315, 0.0, kUpper}, 0.1, 8},
      {&S::signal_screen, {-0.11, 0.0, kMiddle}, {-0.31, 0.0, kMiddle}, 0.12, 8},
      {&S::signal_lamp, {-0.31, 0.0, kMiddle}, {-0.315, 0.0, kMiddle}, 0.1, 8},
      {&S::signal_screen, {-0.11, 0.0, kLower}, {-0.31, 0.0, kLower}, 0.12, 8},
      {&S::signal_lamp, {-0.31, 0.0, kLower}, {-0.315, 0.0, kLower}, 0.1, 8},
      {&S::signal_board, {-0.08, -0.075, kZ - 2.45}, {-0.07, 0.075, kZ - 1.7}}}},
    // As the main signal, with two lamps on a screen of 0.80 x 0.90 m and, at the foot of its mast,
    // the retroreflecting board of 450 x 900 mm that marks a distant signal. 176 triangles.
    {"distant_signal",
     {{&S::signal_mast, {0.0, 0.0, kFoot_m}, {0.0, 0.0, kZ}, 0.07, 8},
      {&S::signal_foot, {-0.3, -0.3, -1.4}, {0.3, 0.3, -0.55}},
      {&S::signal_screen, {-0.11, -0.4, kZ - 0.9}, {-0.07, 0.4, kZ}},
      {&S::signal_screen, {-0.11, 0.0, kZ - 0.225}, {-0.31, 0.0, kZ - 0.225}, 0.12, 8},
      {&S::signal_lamp, {-0.31, 0.0, kZ - 0.225}, {-0.315, 0.0, kZ - 0.225}, 0.1, 8},
      {&S::signal_screen, {-0.11, 0.0, kZ - 0.675}, {-0.31, 0.0, kZ - 0.675}, 0.12, 8},
      {&S::signal_lamp, {-0.31, 0.0, kZ - 0.675}, {-0.315, 0.0, kZ - 0.675}, 0.1, 8},
      {&S::signal_board, {-0.08, -0.225, kZ - 2.1}, {-0.07, 0.225, kZ - 1.2}}}},
    // A low signal: a case of 0.50 x 0.50 m, 200 mm deep, with three lamps, on a post. Its top is
    // `height_m` above top of rail. Two lamps above, one below: they show two lights on a slant for
    // "shunting permitted". 208 triangles.
    {"shunting_signal",
     {{&S::signal_mast, {0.0, 0.0, kFoot_m}, {0.0, 0.0, kZ - 0.5}, 0.05, 8},
      {&S::signal_screen, {-0.1, -0.25, kZ - 0.5}, {0.1, 0.25, kZ}},
      {&S::signal_screen, {-0.1, -0.12, kZ - 0.13}, {-0.2, -0.12, kZ - 0.13}, 0.12, 8},
      {&S::signal_lamp, {-0.2, -0.12, kZ - 0.13}, {-0.205, -0.12, kZ - 0.13}, 0.1, 8},
      {&S::signal_screen, {-0.1, 0.12, kZ - 0.13}, {-0.2, 0.12, kZ - 0.13}, 0.12, 8},
      {&S::signal_lamp, {-0.2, 0.12, kZ - 0.13}, {-0.205, 0.12, kZ - 0.13}, 0.1, 8},
      {&S::signal_screen, {-0.1, 0.0, kZ - 0.37}, {-0.2, 0.0, kZ - 0.37}, 0.12, 8},
      {&S::signal_lamp, {-0.2, 0.0, kZ - 0.37}, {-0.205, 0.0, kZ - 0.37}, 0.1, 8}}},
    // The post of MakeBoard(), whose top is `height_m` above top of rail.
    {"board", {{&S::board_steel, {0.0, 0.0, kFoot_m}, {0.0, 0.0, kZ}, 0.03, 8}}},
    // A fouling point marker (Ra 12): a painted post of 150 x 150 mm, white with a red band, whose
    // top is `height_m` above top of rail. 36 triangles.
    {"fouling_marker",
     {{&S::marker_white, {-0.075, -0.075, kFoot_m}, {0.075, 0.075, kZ - 0.4}},
      {&S::marker_red, {-0.075, -0.075, kZ - 0.4}, {0.075, 0.075, kZ - 0.2}},
      {&S::marker_white, {-0.075, -0.075, kZ - 0.2}, {0.075, 0.075, kZ}}}},
    // Eurobalise of standard size (SUBSET-036): 358 mm along the track, 488 mm across, 50 mm high.
    // Its origin is at the middle of its underside. 12 triangles.
    {"balise", {{&S::balise, {-0.179, -0.244, 0.0}, {0.179, 0.244, 0.05}}}},
    // A cabinet of that length, depth and height above the ground, where its origin is, on a
    // concrete plinth of 0.15 m that reaches 0.4 m into the ground. The door faces -y. 36
    // triangles.
    {"relay_box",
     {{&S::relay_foot, {0.03 - kX, 0.03 - kY, -0.4}, {kX - 0.03, kY - 0.03, 0.15}},
      {&S::relay_box, {0.03 - kX, 0.03 - kY, 0.15}, {kX - 0.03, kY - 0.03, kZ - 0.05}},
      {&S::relay_box, {0.0 - kX, 0.0 - kY, kZ - 0.05}, {kX, kY, kZ}}}},
    // A fixed buffer stop on the last metres of a track: two frames of steel on the rails,
    // `shift_m` farther from the middle than on standard gauge, a beam with two buffers (1.06 m
    // high, 1.75 m apart, UIC, as on wagons) and a retroreflecting board. The buffers' faces are at
    // x = 0 and look towards -x; it is kBufferStopLength_m long, 2.5 m wide, 1.6 m high. 252
    // triangles.
    {"buffer_stop",
     {{&S::buffer_beam, {0.4, -1.25, 0.86}, {0.6, 1.25, 1.26}},
      {&S::buffer_frame, {0.0, -0.875, 1.06}, {0.06, -0.875, 1.06}, 0.225, 12},
      {&S::buffer_frame, {0.06, -0.875, 1.06}, {0.4, -0.875, 1.06}, 0.09, 8},
      {&S::buffer_frame, {0.0, 0.875, 1.06}, {0.06, 0.875, 1.06}, 0.225, 12},
      {&S::buffer_frame, {0.06, 0.875, 1.06}, {0.4, 0.875, 1.06}, 0.09, 8},
      {&S::buffer_board, {0.4, -0.3, 1.26}, {0.41, 0.3, 1.6}},
      {&S::buffer_frame, {0.69, -0.75 - kShift, 0.0}, {0.69, -0.75 - kShift, 1.26}, 0.09, 4},
      {&S::buffer_frame, {0.69, -0.75 - kShift, 1.06}, {2.41, -0.75 - kShift, 0.09}, 0.09, 4},
      {&S::buffer_frame, {0.4, -0.84 - kShift, 0.0}, {kBufferStopLength_m, -0.66 - kShift, 0.09}},
      {&S::buffer_frame, {0.69, 0.75 + kShift, 0.0}, {0.69, 0.75 + kShift, 1.26}, 0.09, 4},
      {&S::buffer_frame, {0.69, 0.75 + kShift, 1.06}, {2.41, 0.75 + kShift, 0.09}, 0.09, 4},
      {&S::buffer_frame, {0.4, 0.66 + kShift, 0.0}, {kBufferStopLength_m, 0.84 + kShift, 0.09}},
      {&S::buffer_frame, {1.5, -0.75 - kShift, 0.55}, {1.5, 0.75 + kShift, 0.55}, 0.09, 4}}},
    // A derailer that lies on the rail at y = 0.75 m + `shift_m` (RailShift_m), with its machine
    // outside. The shoe is 0.60 x 0.30 x 0.20 m and rises 0.10 m above the rail. 36 triangles.
    {"derailer",
     {{&S::derailer, {-0.3, 0.6 + kShift, -0.1}, {0.3, 0.9 + kShift, 0.1}},
      {&S::derailer_machine, {-0.03, 0.9 + kShift, -0.1}, {0.03, 1.15 + kShift, -0.04}},
      {&S::derailer_machine, {-0.35, 1.15 + kShift, -0.35}, {0.35, 1.55 + kShift, 0.02}}}},
    // A lamp of that height above the ground, where its origin is: a tapered pole with an arm of
    // 1.0 m towards -y, whose outer half is the case. 60 triangles.
    {"lamp",
     {{&S::furniture_steel, {0.0, 0.0, -0.4}, {0.0, 0.0, kZ}, 0.08, 8, 0.04},
      {&S::furniture_steel, {0.0, 0.0, kZ - 0.12}, {0.0, -0.5, kZ - 0.12}, 0.03, 6},
      {&S::furniture_steel, {-0.15, -1.0, kZ - 0.18}, {0.15, -0.5, kZ - 0.06}}}},
    // A bench on the ground, 1.80 m long, 0.55 m deep, 0.80 m high with its back; one looks towards
    // -y from it. 48 triangles.
    {"bench",
     {{&S::furniture_wood, {-0.9, -0.275, 0.4}, {0.9, 0.275, 0.45}},
      {&S::furniture_wood, {-0.9, 0.225, 0.55}, {0.9, 0.275, 0.8}},
      {&S::furniture_steel, {-0.73, -0.2, -0.1}, {-0.67, 0.225, 0.4}},
      {&S::furniture_steel, {0.67, -0.2, -0.1}, {0.73, 0.225, 0.4}}}},
    // A shelter on the ground with glass at its back and sides and a bench at the back: that
    // length, depth and height. It is open towards -y. 108 triangles.
    {"shelter",
     {{&S::furniture_steel, {0.0 - kX, 0.0 - kY, kZ - 0.1}, {kX, kY, kZ}},
      {&S::furniture_steel, {0.04 - kX, 0.04 - kY, -0.4}, {0.12 - kX, 0.12 - kY, kZ - 0.1}},
      {&S::furniture_steel, {0.04 - kX, kY - 0.12, -0.4}, {0.12 - kX, kY - 0.04, kZ - 0.1}},
      {&S::furniture_steel, {kX - 0.12, 0.04 - kY, -0.4}, {kX - 0.04, 0.12 - kY, kZ - 0.1}},
      {&S::furniture_steel, {kX - 0.12, kY - 0.12, -0.4}, {kX - 0.04, kY - 0.04, kZ - 0.1}},
      {&S::furniture_glass, {0.12 - kX, kY - 0.085, 0.15}, {kX - 0.12, kY - 0.075, kZ - 0.1}},
      {&S::furniture_glass, {0.075 - kX, 0.12 - kY, 0.15}, {0.085 - kX, kY - 0.12, kZ - 0.1}},
      {&S::furniture_glass, {kX - 0.085, 0.12 - kY, 0.15}, {kX - 0.075, kY - 0.12, kZ - 0.1}},
      {&S::furniture_wood, {0.0 - kSeatX, kY - 0.58, 0.425}, {kSeatX, kY - 0.18, 0.475}}}},
    // What MakeHalfBarrier() stands on, on the road's surface.
    {"boom_pedestal", {{&S::crossing_steel, {-0.15, -0.15, -0.5}, {0.15, 0.15, 1.1}}}},
    // The counterweight of MakeBoom(). Like the boom, it is in front of the pedestal, towards -y.
    {"boom_weight",
     {{&S::crossing_steel, {-0.8, -0.3, -0.12}, {-0.35, -0.1, 0.12}},
      {&S::crossing_steel, {-0.35, -0.22, -0.04}, {0.0, -0.18, 0.04}}}},
    // A St Andrew's cross, retroreflecting, above two lamps on a black screen, on a post. Its
    // origin is on the ground; drivers who see it travel along x. Beams of 1.20 x 0.15 m, one in
    // front of the other, crossing 3.25 m above the ground at 55 degrees from the horizontal: the
    // cross is higher than wide. 176 triangles.
    {"crossing_sign",
     {{&S::crossing_steel, {0.0, 0.0, -0.5}, {0.0, 0.0, 3.75}, 0.045, 8},
      {&S::barrier_white, {-0.053, -0.6, 3.175}, {-0.045, 0.6, 3.325}, 0.0, 0, 0.0, -0.96},
      {&S::barrier_white, {-0.061, -0.6, 3.175}, {-0.053, 0.6, 3.325}, 0.0, 0, 0.0, 0.96},
      {&S::crossing_screen, {-0.085, -0.2, 1.9}, {-0.045, 0.2, 2.7}},
      {&S::crossing_screen, {-0.085, 0.0, 2.5}, {-0.285, 0.0, 2.5}, 0.12, 8},
      {&S::crossing_lamp, {-0.285, 0.0, 2.5}, {-0.29, 0.0, 2.5}, 0.1, 8},
      {&S::crossing_screen, {-0.085, 0.0, 2.1}, {-0.285, 0.0, 2.1}, 0.12, 8},
      {&S::crossing_lamp, {-0.285, 0.0, 2.1}, {-0.29, 0.0, 2.1}, 0.1, 8}}}};

Vector3 PointAt(const std::array<LinesideCoordinate, 3>& point, const LinesideSizes& sizes) {
  const std::array<double, 5> lengths_m = {1.0, 0.5 * sizes.length_m, 0.5 * sizes.depth_m,
                                           sizes.height_m, sizes.shift_m};
  const auto value_m = [&](const LinesideCoordinate& of) {
    return std::inner_product(lengths_m.begin(), lengths_m.end(), of.factors.begin(), 0.0);
  };
  return {value_m(point[0]), value_m(point[1]), value_m(point[2])};
}

Mesh MeshOf(const LinesideShape& shape, const LinesideSizes& sizes) {
  const std::array<Vector3, 2> ends_m = {PointAt(shape.begin, sizes), PointAt(shape.end, sizes)};
  if (shape.num_sides > 0) {
    const std::array<double, 2> radii_m = {shape.radius_m, shape.radius_m - shape.taper_m};
    return MakeTube(ends_m, radii_m, shape.num_sides);
  }
  if (shape.roll_rad == 0.0) return MakeBox({ends_m[0], ends_m[1]});
  const Vector3 half_m = 0.5 * (ends_m[1] - ends_m[0]);
  Mesh turned;
  turned.Append(MakeBox({-half_m, half_m}),
                MakeTransform(RotationFromYawPitchRoll(0.0, 0.0, shape.roll_rad),
                              0.5 * (ends_m[0] + ends_m[1])));
  return turned;
}

/// A plate of any outline (y, z) in front of its post: a sheet of 2 mm on 3 mm of steel.
Model MakeBoardOf(const std::vector<Eigen::Vector2d>& outline_m,
                  double height_m,
                  const LinesideSurfaces& surfaces) {
  constexpr double kBack_m = -0.030;
  constexpr double kSeam_m = kBack_m - 0.003;
  Model model = MakeLinesideModel("board", surfaces, {.height_m = height_m});
  MeshOf(surfaces.board_steel, model).Append(MakeExtrusion(outline_m, kSeam_m, kBack_m));
  MeshOf(surfaces.board_face, model).Append(MakeExtrusion(outline_m, kSeam_m - 0.002, kSeam_m));
  return model;
}

}  // namespace

Model MakeLinesideModel(std::string_view name,
                        const LinesideSurfaces& surfaces,
                        const LinesideSizes& sizes) {
  const auto* thing = std::ranges::find(kLinesideThings, name, &LinesideThing::name);
  Check(thing != std::end(kLinesideThings), "the table has the thing beside the track");
  Model model{.name = std::string(name), .parts = {}};
  for (const LinesideShape& shape : thing->shapes) {
    MeshOf(surfaces.*shape.surface, model).Append(MeshOf(shape, sizes));
  }
  return model;
}

Model MakeBoard(const PlateSize& plate, double height_m, const LinesideSurfaces& surfaces) {
  const double side_m = 0.5 * plate.width_m;
  const double low_m = height_m - plate.height_m;
  return MakeBoardOf({{-side_m, low_m}, {side_m, low_m}, {side_m, height_m}, {-side_m, height_m}},
                     height_m, surfaces);
}

Model MakeTriangularBoard(const PlateSize& plate,
                          double height_m,
                          const LinesideSurfaces& surfaces) {
  const double side_m = 0.5 * plate.width_m;
  return MakeBoardOf({{0.0, height_m - plate.height_m}, {side_m, height_m}, {-side_m, height_m}},
                     height_m, surfaces);
}

Model MakeBoom(double length_m, const LinesideSurfaces& surfaces) {
  constexpr double kStripe_m = 0.60;
  Model model{.name = "boom", .parts = {}};
  const int num_stripes = std::max(1, static_cast<int>(std::lround(length_m / kStripe_m)));
  for (int i = 0; i < num_stripes; ++i) {
    MeshOf(i % 2 == 0 ? surfaces.barrier_red : surfaces.barrier_white, model)
        .Append(MakeBox({Vector3(length_m * i / num_stripes, -0.225, -0.06),
                         Vector3(length_m * (i + 1) / num_stripes, -0.175, 0.06)}));
  }
  AppendModel(MakeLinesideModel("boom_weight", surfaces), Transform::Identity(), model);
  return model;
}

Transform BarrierFromBoom(double angle_rad) {
  return MakeTransform(RotationFromYawPitchRoll(0.0, -angle_rad, 0.0), {0.0, 0.0, kBoomAxis_m});
}

Model MakeHalfBarrier(double boom_length_m, double angle_rad, const LinesideSurfaces& surfaces) {
  Model model{.name = "half_barrier", .parts = {}};
  AppendModel(MakeBoom(boom_length_m, surfaces), BarrierFromBoom(angle_rad), model);
  AppendModel(MakeLinesideModel("boom_pedestal", surfaces), Transform::Identity(), model);
  return model;
}

}  // namespace railcast
