#include "core/io/cloud/track_fields.h"

#include <cmath>
#include <limits>
#include <optional>

#include "core/base/error.h"
#include "core/io/cloud/scan_motion.h"

namespace railcast {
namespace {

/// The points of a frame in the world; undoes OutputAxes (core/simulate/output_axes.h).
class WorldPoints {
 public:
  WorldPoints(const Frame& frame, const FrameTrack& track)
      : frame_(frame),
        output_(track.output),
        sensor_from_vehicle_(track.vehicle_from_sensor.inverse()),
        origin_m_(output_.origin_m.data()),
        motion_(frame) {}

  [[nodiscard]] Vector3 At(std::size_t slot) const {
    Vector3 point_m(static_cast<double>(frame_.x[slot]), static_cast<double>(frame_.y[slot]),
                    static_cast<double>(frame_.z[slot]));
    if (output_.handedness == Handedness::kLeft) point_m.y() = -point_m.y();
    if (output_.frame == OutputFrame::kWorld) return point_m + origin_m_;
    if (output_.frame == OutputFrame::kVehicle) point_m = sensor_from_vehicle_ * point_m;
    return frame_.world_from_sensor * motion_.AtStamp(point_m, frame_.time_ns[slot]);
  }

 private:
  const Frame& frame_;
  const OutputSpec& output_;
  Transform sensor_from_vehicle_;
  Vector3 origin_m_;
  ScanMotion motion_;
};

}  // namespace

TrackFields TrackFieldsOf(const Frame& frame, const FrameTrack& track) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const std::size_t num_slots = frame.num_slots();
  TrackFields fields{std::vector(num_slots, kNone), std::vector(num_slots, kNone),
                     std::vector(num_slots, kNone), std::vector<std::uint8_t>(num_slots)};
  const WorldPoints points(frame, track);
  double near_s_m = track.track.begin_s_m();
  for (std::size_t slot = 0; slot < num_slots; ++slot) {
    if (std::isnan(frame.x[slot])) continue;
    const std::optional<PlaceByTrack> place = track.track.PlaceOf(points.At(slot), near_s_m);
    if (!place) continue;
    near_s_m = place->chainage_m;
    fields.chainage_m[slot] = static_cast<float>(place->chainage_m);
    fields.track_lateral_m[slot] = static_cast<float>(place->lateral_m);
    fields.track_height_m[slot] = static_cast<float>(place->height_m);
    fields.in_gauge[slot] = track.track.IsInGauge(*place) ? 1 : 0;
  }
  return fields;
}

SelectedFields::SelectedFields(const Frame& frame, const FieldSelection& selection)
    : frame_(frame), selection_(selection) {
  if (!selection.NeedsTrack()) return;
  Check(selection.track() != nullptr, "fields of the track have a track");
  track_ = TrackFieldsOf(frame, *selection.track());
}

}  // namespace railcast
