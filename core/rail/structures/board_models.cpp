#include <span>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/structures/lineside_models.h"
#include "core/rail/structures/lineside_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

constexpr double kBoardPostRadius_m = 0.030;
constexpr double kSheetThickness_m = 0.002;
constexpr double kPlateThickness_m = 0.003;

/// A plate of any outline (y, z) in front of its post.
Model MakeBoardOf(std::span<const Eigen::Vector2d> outline_m,
                  double height_m,
                  const LinesideSurfaces& surfaces) {
  Model model{.name = "board", .parts = {}};
  MeshOf(surfaces.board_steel, model)
      .Append(MakePost({.bottom_m = kFoot_m, .top_m = height_m, .radius_m = kBoardPostRadius_m}));
  const double back_m = -kBoardPostRadius_m;
  const double seam_m = back_m - kPlateThickness_m;
  MeshOf(surfaces.board_steel, model).Append(MakeExtrusion(outline_m, seam_m, back_m));
  MeshOf(surfaces.board_face, model)
      .Append(MakeExtrusion(outline_m, seam_m - kSheetThickness_m, seam_m));
  return model;
}

}  // namespace

Model MakeBoard(const PlateSize& plate, double height_m, const LinesideSurfaces& surfaces) {
  const double side_m = 0.5 * plate.width_m;
  const double low_m = height_m - plate.height_m;
  const std::vector<Eigen::Vector2d> outline_m = {
      {-side_m, low_m}, {side_m, low_m}, {side_m, height_m}, {-side_m, height_m}};
  return MakeBoardOf(outline_m, height_m, surfaces);
}

Model MakeTriangularBoard(const PlateSize& plate,
                          double height_m,
                          const LinesideSurfaces& surfaces) {
  const double side_m = 0.5 * plate.width_m;
  const std::vector<Eigen::Vector2d> outline_m = {
      {0.0, height_m - plate.height_m}, {side_m, height_m}, {-side_m, height_m}};
  return MakeBoardOf(outline_m, height_m, surfaces);
}

Model MakeFoulingMarker(double height_m, const LinesideSurfaces& surfaces) {
  constexpr double kWidth_m = 0.150;
  constexpr double kBand_m = 0.200;
  Model model{.name = "fouling_marker", .parts = {}};
  const auto add = [&](double bottom_m, double top_m, const SurfaceClass& surface) {
    MeshOf(surface, model)
        .Append(MakeBlockAbout({0.0, 0.0, 0.5 * (bottom_m + top_m)},
                               {kWidth_m, kWidth_m, top_m - bottom_m}));
  };
  add(kFoot_m, height_m - 2.0 * kBand_m, surfaces.marker_white);
  add(height_m - 2.0 * kBand_m, height_m - kBand_m, surfaces.marker_red);
  add(height_m - kBand_m, height_m, surfaces.marker_white);
  return model;
}

}  // namespace railcast
