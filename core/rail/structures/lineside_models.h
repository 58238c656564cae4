#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/scene.h"

namespace railcast {

/// Shapes of which things beside the track are composed.

/// A box about a middle.
[[nodiscard]] Mesh MakeBlockAbout(const Vector3& middle_m, const Vector3& size_m);

/// An upright post with eight sides, over the place (x, y).
struct PostShape {
  double x_m = 0.0;
  double y_m = 0.0;
  double bottom_m{};
  double top_m{};
  double radius_m{};
};
[[nodiscard]] Mesh MakePost(const PostShape& post);

/// The surfaces of a lamp and of the hood that shades it.
struct LampSurfaces {
  SurfaceClass lens;
  SurfaceClass hood;
};

/// Adds a lamp of 200 mm whose hood reaches `depth_m` towards -x from `middle_m`. 56 triangles.
void AddSignalLamp(const Vector3& middle_m,
                   double depth_m,
                   const LampSurfaces& surfaces,
                   Model& model);

/// Single things beside and in the track, as models that are placed once or many times.
///
/// Unless noted otherwise, a model stands upright with its origin at the middle of its footprint at
/// the height of top of rail. x is the direction of travel of the trains that it is for, so that
/// what they should see faces -x. Dimensions are those of docs/results/world_dimensions.md unless a
/// source is named. Posts reach down to kFoot_m, which is below the ground beside a track.
inline constexpr double kFoot_m = -1.0;

/// Width along y and height along z of a flat thing.
struct PlateSize {
  double width_m{};
  double height_m{};
};

inline constexpr PlateSize kMainScreen{.width_m = 0.80, .height_m = 1.40};
inline constexpr PlateSize kDistantScreen{.width_m = 0.80, .height_m = 0.90};
inline constexpr PlateSize kShuntingScreen{.width_m = 0.50, .height_m = 0.50};

/// A mast of 140 mm with a black screen of kMainScreen whose top is `height_m` above top of rail,
/// three lamps with hoods, and a retroreflecting mast board of 150 x 750 mm. 232 triangles.
[[nodiscard]] Model MakeMainSignal(double height_m, const LinesideSurfaces& surfaces);

/// As the main signal, with two lamps on a screen of kDistantScreen and, at the foot of its mast,
/// the retroreflecting board of 450 x 900 mm that marks a distant signal. 176 triangles.
[[nodiscard]] Model MakeDistantSignal(double height_m, const LinesideSurfaces& surfaces);

/// A low signal: a case of kShuntingScreen, 200 mm deep, with three lamps, on a post. Its top is
/// `height_m` above top of rail. 208 triangles.
[[nodiscard]] Model MakeShuntingSignal(double height_m, const LinesideSurfaces& surfaces);

/// A plate on a post of 60 mm: retroreflecting in front, steel behind. Its upper edge is `height_m`
/// above top of rail. 52 triangles.
[[nodiscard]] Model MakeBoard(const PlateSize& plate,
                              double height_m,
                              const LinesideSurfaces& surfaces);

/// As MakeBoard(), with a triangular plate that stands on its tip. 44 triangles.
[[nodiscard]] Model MakeTriangularBoard(const PlateSize& plate,
                                        double height_m,
                                        const LinesideSurfaces& surfaces);

/// A fouling point marker (Ra 12): a painted post of 150 x 150 mm, white with a red band, whose top
/// is `height_m` above top of rail. 36 triangles.
[[nodiscard]] Model MakeFoulingMarker(double height_m, const LinesideSurfaces& surfaces);

/// Eurobalise of standard size (SUBSET-036): 358 mm along the track, 488 mm across, 50 mm high. Its
/// origin is at the middle of its underside. 12 triangles.
inline constexpr double kBaliseLength_m = 0.358;
inline constexpr double kBaliseWidth_m = 0.488;
inline constexpr double kBaliseHeight_m = 0.050;
[[nodiscard]] Model MakeBalise(const LinesideSurfaces& surfaces);

/// A cabinet of that length, depth and height above the ground, where its origin is, on a concrete
/// plinth of 0.15 m that reaches 0.4 m into the ground. The door faces -y. 36 triangles.
[[nodiscard]] Model MakeRelayBox(const Vector3& size_m, const LinesideSurfaces& surfaces);

/// A fixed buffer stop on the last metres of a track: two frames of steel on the rails, a beam with
/// two buffers (1.06 m high, 1.75 m apart, UIC) and a retroreflecting board. The buffers' faces are
/// at x = 0 and look towards -x; it ends at x = kBufferStopLength_m. 252 triangles.
/// @param shift_m How much farther from the middle the rails lie than on standard gauge.
inline constexpr double kBufferStopLength_m = 2.5;
inline constexpr double kBufferStopWidth_m = 2.5;
inline constexpr double kBufferStopHeight_m = 1.60;
[[nodiscard]] Model MakeBufferStop(const LinesideSurfaces& surfaces, double shift_m);

/// A derailer that lies on the rail at y = 0.75 m + shift_m (RailShift_m), with its machine
/// outside. The shoe is 0.60 x 0.30 x 0.20 m and rises 0.10 m above the rail. 36 triangles.
[[nodiscard]] Model MakeDerailer(const LinesideSurfaces& surfaces, double shift_m);

/// A lamp of that height above the ground, where its origin is: a tapered pole with an arm of 1.0 m
/// towards -y. 60 triangles.
[[nodiscard]] Model MakeLamp(double height_m, const LinesideSurfaces& surfaces);

/// A bench on the ground, 1.80 m long, 0.55 m deep, 0.80 m high with its back; one looks towards -y
/// from it. 48 triangles.
[[nodiscard]] Model MakeBench(const LinesideSurfaces& surfaces);

/// A shelter on the ground with glass at its back and sides: that length, depth and height. It is
/// open towards -y. 108 triangles.
[[nodiscard]] Model MakeShelter(const Vector3& size_m, const LinesideSurfaces& surfaces);

/// A half barrier on the road's surface, where its origin is: pedestal, counterweight, and a boom
/// of that length from the pedestal's middle, in stripes of 0.6 m, red and retroreflecting white.
/// Closed, the boom lies along x, 0.95 m high. 36 triangles and 12 for each stripe.
/// @param angle_rad From 0 = closed to pi / 2 = upright.
[[nodiscard]] Model MakeHalfBarrier(double boom_length_m,
                                    double angle_rad,
                                    const LinesideSurfaces& surfaces);

/// Height of a half barrier's axis, about which its boom turns, above the road.
inline constexpr double kBoomAxis_m = 0.95;
/// The two parts of a half barrier: the boom with its counterweight, about its axis at the origin
/// and closed, and the pedestal on the road's surface. They turn by angle_rad about y.
[[nodiscard]] Model MakeBoom(double boom_length_m, const LinesideSurfaces& surfaces);
[[nodiscard]] Model MakeBoomPedestal(const LinesideSurfaces& surfaces);
/// Turns a boom and puts it on its pedestal.
[[nodiscard]] Transform BarrierFromBoom(double angle_rad);

/// A St Andrew's cross, retroreflecting, above two lamps on a black screen, on a post. Its origin
/// is on the ground; drivers who see it travel along x. Beams of 1.20 x 0.15 m, crossing 3.25 m
/// above the ground. 176 triangles.
[[nodiscard]] Model MakeCrossingSign(const LinesideSurfaces& surfaces);

/// What a building is made from.
struct BuildingShape {
  std::vector<Eigen::Vector2d> footprint_m;  ///< Corners in plan, in either direction round.
  double eaves_m{};                          ///< Height of the walls above the ground.
  /// Pitch of a gable roof over a footprint of four corners, with its ridge along the longer sides;
  /// absent = a flat roof.
  std::optional<double> gable_pitch_rad;
  bool has_windows = true;
};

/// Windows stand in rows, one for each full storey, on every wall long enough for one.
inline constexpr double kStorey_m = 3.0;
inline constexpr double kWindowWidth_m = 1.2;
inline constexpr double kWindowHeight_m = 1.4;
inline constexpr double kWindowSill_m = 0.9;      ///< Above the storey's floor.
inline constexpr double kWindowSpacing_m = 3.0;   ///< At least, between middles.
inline constexpr std::size_t kMostWindows = 150;  ///< Then they are farther apart.

/// A building in the frame of its footprint, with the ground at z = 0, into which its walls reach 1
/// m deep. Windows are panes 20 mm in front of the walls. Two triangles for each wall and window,
/// and two less than corners (flat) or six (gable) for the roof.
[[nodiscard]] Model MakeBuilding(const BuildingShape& shape, const LinesideSurfaces& surfaces);

/// Height of the ridge above the eaves; 0 of a flat roof.
[[nodiscard]] double RidgeRise_m(const BuildingShape& shape);

}  // namespace railcast
