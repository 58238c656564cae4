#pragma once

#include <cstdint>

#include "core/base/transform.h"
#include "core/rail/line/alignment.h"
#include "core/rail/line/speed_profile.h"

namespace railcast {

/// Where something stands across a track, and how.
struct TrackPose {
  double d_m{};          ///< From the alignment's axis, left positive.
  double h_m{};          ///< Above top of rail.
  double heading_rad{};  ///< Turned left against the direction of the chainage.
  bool is_upright{};     ///< Its z is the world's; else it follows gradient and cant.
};

/// The way of something along the line.
class TrackPath {
 public:
  /// @param begin_ns When the profile's time is 0.
  TrackPath(const TrackPose& pose, SpeedProfile profile, std::int64_t begin_ns = 0);

  /// For times from `from_ns` on: see SpeedProfile::WithSpeedFrom.
  [[nodiscard]] TrackPath WithSpeedFrom(std::int64_t from_ns,
                                        double speed_mps,
                                        double acceleration_mps2) const;

  [[nodiscard]] const TrackPose& pose() const { return pose_; }
  [[nodiscard]] bool moves() const { return profile_.moves(); }
  [[nodiscard]] double SpeedAt_mps(std::int64_t time_ns) const;
  [[nodiscard]] double ChainageAt(std::int64_t time_ns) const;
  [[nodiscard]] Transform WorldFromObject(const Alignment& alignment, std::int64_t time_ns) const;

 private:
  TrackPose pose_;
  SpeedProfile profile_;
  std::int64_t begin_ns_;
};

}  // namespace railcast
