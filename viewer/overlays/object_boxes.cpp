#include "viewer/overlays/overlays.h"

#include <algorithm>

#include "core/io/recording/recorded_motion.h"

namespace railcast {
namespace {

constexpr Rgb kWhite{255, 255, 255};
// Large enough to be seen on a person, small enough not to look like a coupling on a wagon.
constexpr double kMostNose_m = 1.0;

// The bits of a corner: 1 = front, 2 = left, 4 = top.
Vector3 Corner(const RecordedObject& object, unsigned corner) {
  const Vector3 half_m = 0.5 * object.size_m;
  return object.sensor_from_box * Vector3((corner & 1U) != 0 ? half_m.x() : -half_m.x(),
                                          (corner & 2U) != 0 ? half_m.y() : -half_m.y(),
                                          (corner & 4U) != 0 ? half_m.z() : -half_m.z());
}

void AddEdges(const RecordedObject& object, Rgb rgb, Overlay& drawing) {
  for (unsigned corner = 0; corner < 8; ++corner) {
    for (const unsigned axis : {1U, 2U, 4U}) {
      if ((corner & axis) != 0) continue;
      AddSegment(Corner(object, corner), Corner(object, corner | axis), rgb, drawing);
    }
  }
}

void AddNose(const RecordedObject& object, Rgb rgb, Overlay& drawing) {
  const double front_m = 0.5 * object.size_m.x();
  const double nose_m = std::min(0.5 * object.size_m.y(), kMostNose_m);
  const Vector3 tip = object.sensor_from_box * Vector3(front_m + nose_m, 0.0, 0.0);
  for (const double side_m : {0.5 * object.size_m.y(), -0.5 * object.size_m.y()}) {
    AddSegment(object.sensor_from_box * Vector3(front_m, side_m, 0.0), tip, rgb, drawing);
  }
}

}  // namespace

Overlay DrawObjectBoxes(const RecordedFrame& recorded, const LabelTable& labels) {
  Overlay drawing;
  const RecordedMotion motion(recorded, Compensation::kAll);
  for (RecordedObject object : recorded.objects) {
    object.sensor_from_box = motion.BoxOf(object);
    if (object.sensor_from_box.translation().norm() > kMostBoxRange_m) continue;
    const Label* label = labels.Find(object.label);
    const Rgb rgb = label != nullptr ? label->rgb : kWhite;
    AddEdges(object, rgb, drawing);
    AddNose(object, rgb, drawing);
    AddWord(object.sensor_from_box * Vector3(0.0, 0.0, 0.5 * object.size_m.z()), object.name, rgb,
            drawing);
  }
  return drawing;
}

}  // namespace railcast
