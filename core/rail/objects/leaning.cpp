#include "core/rail/objects/leaning.h"

#include "core/base/units.h"
#include "railcast/transform.h"

namespace railcast {
namespace {

Vector3 FootOf(const Model& model) {
  const Eigen::AlignedBox3d bounds_m = model.Bounds();
  return {bounds_m.center().x(), bounds_m.center().y(), bounds_m.min().z()};
}

}  // namespace

void Lean(double roll_deg, double pitch_deg, Model& model) {
  if (roll_deg == 0.0 && pitch_deg == 0.0) return;
  if (model.Bounds().isEmpty()) return;
  const auto transform = [&](const Transform& to_from_model) {
    for (Part& part : model.parts) {
      for (Eigen::Vector3f& vertex : part.mesh.vertices) {
        vertex = (to_from_model * vertex.cast<double>()).cast<float>();
      }
    }
  };
  const Vector3 foot_m = FootOf(model);
  transform(MakeTransform(
      RotationFromYawPitchRoll(0.0, RadFromDeg(pitch_deg), RadFromDeg(roll_deg)), Vector3::Zero()));
  transform(Transform(Eigen::Translation3d(foot_m - FootOf(model))));
}

}  // namespace railcast
