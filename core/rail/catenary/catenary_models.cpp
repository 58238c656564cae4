#include "core/rail/catenary/catenary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/catenary/independent_wires.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

// HEB 240 (EN 10365).
constexpr double kDepth_m = 2.0 * kMastHalfDepth_m;
constexpr double kWidth_m = 0.240;
constexpr double kWeb_m = 0.010;
constexpr double kFlange_m = 0.017;

constexpr double kMastHeight_m = 8.0;
constexpr double kMastAboveMessenger_m = 0.5;

constexpr double kThickTubeRadius_m = 0.030;
constexpr double kThinTubeRadius_m = 0.021;
constexpr double kSteadyArmRadius_m = 0.013;
constexpr double kHangerRadius_m = 0.006;
constexpr int kTubeSides = 8;

constexpr double kInsulatorGap_m = 0.10;  ///< From the mast's face.
constexpr double kInsulatorLength_m = 0.50;
constexpr double kInsulatorRadius_m = 0.055;
constexpr int kInsulatorSides = 10;

/// Height of the registration tube above the contact wire, and length of the steady arm.
constexpr double kRegistrationHeight_m = 0.40;
constexpr double kSteadyArmLength_m = 1.0;
constexpr double kTubeBeyondHinge_m = 0.15;
/// Distance along the strut from its hinge to the start of the registration tube.
constexpr double kTubeRoot_m = kInsulatorGap_m + kInsulatorLength_m + 0.1;

/// Adds the tubes of a cantilever to its two parts.
class CantileverPen {
 public:
  CantileverPen(const RailSurfaces& surfaces, Model& model) : surfaces_(surfaces), model_(model) {}

  void Tube(const Vector3& from_m, const Vector3& to_m, double radius_m) {
    const std::array<Vector3, 2> line_m{from_m, to_m};
    MeshOf(surfaces_.cantilever, model_).Append(MakeTube(line_m, radius_m, kTubeSides));
  }

  /// Adds a tube whose first metre, at the mast, carries an insulator with five sheds.
  void InsulatedTube(const Vector3& mast_m, const Vector3& to_m, double radius_m) {
    Tube(mast_m, to_m, radius_m);
    const Vector3 along = (to_m - mast_m).normalized();
    constexpr int kSheds = 5;
    std::vector<Vector3> line_m;
    std::vector<double> radii_m;
    for (int i = 0; i <= 2 * kSheds; ++i) {
      line_m.emplace_back(mast_m +
                          along * (kInsulatorGap_m + kInsulatorLength_m * i / (2.0 * kSheds)));
      radii_m.push_back(i % 2 == 1 ? kInsulatorRadius_m : 0.7 * kInsulatorRadius_m);
    }
    MeshOf(surfaces_.insulator, model_).Append(MakeTube(line_m, radii_m, kInsulatorSides));
  }

  void Clamp(const Vector3& middle_m, const Vector3& half_size_m) {
    MeshOf(surfaces_.cantilever, model_)
        .Append(MakeBox({middle_m - half_size_m, middle_m + half_size_m}));
  }

 private:
  const RailSurfaces& surfaces_;
  Model& model_;
};

/// Outline of the HEB 240 with its flanges along the first coordinate.
std::array<Eigen::Vector2d, 12> Section_m() {
  constexpr double kX = 0.5 * kWidth_m;
  constexpr double kY = 0.5 * kDepth_m;
  constexpr double kWebX = 0.5 * kWeb_m;
  constexpr double kWebY = 0.5 * kDepth_m - kFlange_m;
  return {{{kX, kY},
           {-kX, kY},
           {-kX, kWebY},
           {-kWebX, kWebY},
           {-kWebX, -kWebY},
           {-kX, -kWebY},
           {-kX, -kY},
           {kX, -kY},
           {kX, -kWebY},
           {kWebX, -kWebY},
           {kWebX, kWebY},
           {kX, kWebY}}};
}

/// An upright beam with its flanges facing along y. An extrusion runs along x over (y, z), so its x
/// becomes z, and its y and z become x and y.
Mesh UprightBeam(double bottom_m, double top_m) {
  Eigen::Matrix3d upright_from_extrusion;
  upright_from_extrusion << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  Mesh mesh;
  mesh.Append(MakeExtrusion(Section_m(), bottom_m, top_m),
              MakeTransform(upright_from_extrusion, Vector3::Zero()));
  return mesh;
}

double MastTop_m(const CatenarySpec& spec) {
  return std::max(kMastHeight_m,
                  spec.contact_height_m + spec.system_height_m + kMastAboveMessenger_m);
}

/// Height of the strut's hinge.
double StrutHinge_m(const CatenarySpec& spec) {
  return spec.contact_height_m + kRegistrationHeight_m + 0.10;
}

/// Where the steady arm of a wire is hinged to the registration tube that begins at `root_y_m`. The
/// wire pulls towards the middle of the track, and the arm holds it from its own side; of several
/// wires, or where there is no room for that, from the side of the mast.
double SteadyArmHinge_m(const CantileverShape& shape, const CantileverWire& wire, double root_y_m) {
  const double mast_side = shape.face_m < 0.0 ? -1.0 : 1.0;
  const double stagger_side = wire.y_m < 0.0 ? -1.0 : 1.0;
  const double beyond_m = -mast_side * (shape.room_m - wire.y_m) - kTubeBeyondHinge_m;
  if (stagger_side != mast_side && shape.wires.size() == 1 && beyond_m >= kSteadyArmLength_m) {
    return wire.y_m + stagger_side * kSteadyArmLength_m;
  }
  const double room_m = std::abs(root_y_m - wire.y_m) - kTubeBeyondHinge_m;
  return wire.y_m + mast_side * std::min(kSteadyArmLength_m, room_m);
}

}  // namespace

Model MakeMast(const CatenarySpec& spec, const RailSurfaces& surfaces) {
  constexpr double kBlockTop_m = -0.50;
  constexpr double kBlockBottom_m = -1.70;
  constexpr double kBlockHalfWidth_m = 0.40;
  Model model{.name = "mast", .parts = {}};
  MeshOf(surfaces.mast, model).Append(UprightBeam(kBlockTop_m, MastTop_m(spec)));
  const SurfaceClass block{.material = surfaces.sleeper_concrete.material,
                           .label = surfaces.mast.label};
  MeshOf(block, model)
      .Append(MakeBox({Vector3(-kBlockHalfWidth_m, -kBlockHalfWidth_m, kBlockBottom_m),
                       Vector3(kBlockHalfWidth_m, kBlockHalfWidth_m, kBlockTop_m)}));
  return model;
}

Model MakeHangingPost(const CatenarySpec& spec, const RailSurfaces& surfaces) {
  constexpr double kBelowHinge_m = 0.20;
  constexpr double kAboveMessenger_m = 0.40;
  Model model{.name = "hanging post", .parts = {}};
  MeshOf(surfaces.mast, model)
      .Append(UprightBeam(StrutHinge_m(spec) - kBelowHinge_m,
                          spec.contact_height_m + spec.system_height_m + kAboveMessenger_m));
  return model;
}

Model MakePortal(const CatenarySpec& spec,
                 const PortalSite& site,
                 double shift_m,
                 const RailSurfaces& surfaces) {
  constexpr double kPostBelowHinge_m = 0.20;
  Model model{.name = "portal", .parts = {}};
  Mesh& mesh = MeshOf(surfaces.mast, model);
  // The extrusion's x becomes y.
  const Eigen::Matrix3d beam_from_extrusion =
      RotationFromYawPitchRoll(0.5 * std::numbers::pi, 0.0, 0.0);
  mesh.Append(
      MakeExtrusion(Section_m(), site.right_d_m - shift_m - kMastHalfDepth_m,
                    site.left_d_m - shift_m + kMastHalfDepth_m),
      MakeTransform(beam_from_extrusion, Vector3(0.0, 0.0, MastTop_m(spec) + 0.5 * kDepth_m)));
  for (const double d_m : site.posts_d_m) {
    mesh.Append(
        UprightBeam(StrutHinge_m(spec) - kPostBelowHinge_m + site.lowest_lift_m, MastTop_m(spec)),
        MakeTransform(Eigen::Matrix3d::Identity(), Vector3(0.0, d_m, 0.0)));
  }
  return model;
}

Model MakeCantilever(const CatenarySpec& spec,
                     const CantileverShape& shape,
                     const RailSurfaces& surfaces) {
  Model model{.name = "cantilever", .parts = {}};
  CantileverPen pen(surfaces, model);
  const double mast_side = shape.face_m < 0.0 ? -1.0 : 1.0;
  const double registration_m = spec.contact_height_m + kRegistrationHeight_m;
  const double farthest_m =
      std::ranges::min_element(shape.wires, {}, [&](const CantileverWire& wire) {
        return mast_side * wire.y_m;
      })->y_m;

  // Tubes end below the messenger wire, which a clamp holds.
  const double messenger_m = spec.contact_height_m + spec.system_height_m;
  const double lowest_m = std::min(
      0.0, std::ranges::min(shape.wires, {}, &CantileverWire::messenger_lift_m).messenger_lift_m);
  const Vector3 head = Vector3(0.0, farthest_m, messenger_m) - Vector3(0.0, 0.0, 0.075 - lowest_m);
  const Vector3 top_hinge(0.0, shape.face_m, head.z());
  const Vector3 strut_hinge(0.0, shape.face_m, StrutHinge_m(spec));
  pen.InsulatedTube(top_hinge, head, kThinTubeRadius_m);
  pen.InsulatedTube(strut_hinge, head, kThickTubeRadius_m);
  for (const CantileverWire& wire : shape.wires) {
    const double half_lift_m = 0.5 * (wire.messenger_lift_m - lowest_m);
    pen.Clamp(
        Vector3(0.0, wire.y_m, messenger_m) - Vector3(0.0, 0.0, 0.04 - lowest_m - half_lift_m),
        {0.05, 0.03, 0.05 + half_lift_m});
  }
  for (const Vector3& hinge : {top_hinge, strut_hinge}) {
    pen.Clamp(hinge + Vector3(0.0, -0.02 * mast_side, 0.0), {0.06, 0.03, 0.06});
  }

  // The registration tube extends slightly beyond all hinges and wires.
  const Vector3 strut = (head - strut_hinge).normalized();
  const Vector3 root = strut_hinge + strut * kTubeRoot_m;
  std::vector<double> hinges_y_m;
  double innermost_m = std::numeric_limits<double>::infinity();
  for (const CantileverWire& wire : shape.wires) {
    hinges_y_m.push_back(SteadyArmHinge_m(shape, wire, root.y()));
    innermost_m = std::min({innermost_m, mast_side * hinges_y_m.back(), mast_side * wire.y_m});
  }
  const Vector3 tube_end(0.0, mast_side * (innermost_m - kTubeBeyondHinge_m), registration_m);
  const auto on_tube = [&](double y_m) -> Vector3 {
    return root + (y_m - root.y()) / (tube_end.y() - root.y()) * (tube_end - root);
  };
  pen.Tube(root, tube_end, kThinTubeRadius_m);
  pen.Tube(head, on_tube(tube_end.y() + 0.10 * mast_side), kHangerRadius_m);
  for (std::size_t i = 0; i < shape.wires.size(); ++i) {
    const Vector3 wire(0.0, shape.wires[i].y_m,
                       spec.contact_height_m + shape.wires[i].contact_lift_m);
    pen.Tube(on_tube(hinges_y_m[i]), wire + Vector3(0.0, 0.0, 0.02), kSteadyArmRadius_m);
    pen.Clamp(wire + Vector3(0.0, 0.0, 0.016), {0.04, 0.012, 0.014});
  }
  return model;
}

}  // namespace railcast
