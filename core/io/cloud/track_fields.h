#pragma once

#include <cstdint>
#include <vector>

#include "core/rail/world/own_track.h"
#include "railcast/frame.h"
#include "railcast/io/cloud_files.h"
#include "railcast/transform.h"

namespace railcast {

/// The track that a sensor's vehicle is on, and the axes in which the sensor's frames have their
/// points.
struct FrameTrack {
  OwnTrack track;
  OutputSpec output;
  Transform vehicle_from_sensor = Transform::Identity();
};

/// Where the points of a frame are in the axes of the vehicle's track: one value for each slot.
/// NaN, and not in the gauge, where there is no point, or one beyond the ends of the track.
struct TrackFields {
  /// Along the route. float32 resolves it to 1 mm up to 16 km, to 1 cm up to 130 km.
  std::vector<float> chainage_m;
  std::vector<float> track_lateral_m;  ///< From the track's axis, left positive.
  std::vector<float> track_height_m;   ///< Above top of rail, square to the plane of the rails.
  std::vector<std::uint8_t> in_gauge;  ///< 1 = inside the vehicle's outline.
};

/// As ForEachField() of a frame, whose fields these follow.
template <typename Visitor>
void ForEachTrackField(const TrackFields& fields, Visitor&& visit) {
  visit("chainage_m", "m", fields.chainage_m);
  visit("track_lateral_m", "m", fields.track_lateral_m);
  visit("track_height_m", "m", fields.track_height_m);
  visit("in_gauge", "", fields.in_gauge);
}

/// @param track.output Of the frame.
[[nodiscard]] TrackFields TrackFieldsOf(const Frame& frame, const FrameTrack& track);

/// The fields of a frame that a file stores.
class SelectedFields {
 public:
  /// @param selection Must outlive this, as must the frame.
  /// @pre The selection has a track if it needs one.
  SelectedFields(const Frame& frame, const FieldSelection& selection);

  /// Calls `visit(name, unit, values)` for each of them, in the order in which files store them.
  template <typename Visitor>
  void ForEach(Visitor&& visit) const {
    const auto visit_selected = [&](std::string_view name, std::string_view unit,
                                    const auto& values) {
      if (selection_.Has(name)) visit(name, unit, values);
    };
    ForEachField(frame_, visit_selected);
    ForEachTrackField(track_, visit_selected);
  }

 private:
  const Frame& frame_;
  const FieldSelection& selection_;
  TrackFields track_;
};

}  // namespace railcast
