#pragma once

#include <memory>

#include "generator/extras/insert/recorded_firings.h"
#include "railcast/io/recording.h"
#include "railcast/lidar.h"

namespace railcast {

/// Finds the firings of a recording's frames:
/// - of captures as their packets and the angles of their decoder state them (beam_of),
/// - of what railcast simulated with this very scan from the scan, exactly, also without stated
///   rows and columns and with the sensor's motion undone,
/// - of grids of a spinning sensor from their points and the sensor's channels (FindRingFirings()).
class FiringFinder {
 public:
  /// @param scan The sensor's, as the plan names it or as it was found. Of a capture only its rows
  ///   are checked: its packets state the rest.
  /// @param may_use_points_alone Whether frames whose firings cannot be found are taken point by
  ///   point.
  FiringFinder(const RecordingInfo& info, const ScanSpec& scan, bool may_use_points_alone);
  ~FiringFinder();

  /// Thread-safe.
  /// @throws InputError with one line that says why the firings of this frame cannot be found.
  [[nodiscard]] RecordedFirings Find(RecordedFrame recorded) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace railcast
