#pragma once

#include <optional>
#include <vector>

#include "generator/import/network/track_runs.h"

namespace railcast {

/// A stretch on which a track is parallel to its line.
struct TrackLevel {
  double begin_s_m{};
  double end_s_m{};
  double d_m{};
};

/// A track that is parallel to its line but for S-curves between its levels.
struct TrackLevels {
  std::vector<TrackLevel> levels;  ///< At least one, in order of chainage.

  /// As a track with `offsets_m` has it; beyond its ends the first or the last level.
  [[nodiscard]] double OffsetAt_m(double s_m) const;
};

/// Divides a run into levels within 0.35 m of which its points lie, each at least 60 m long, and
/// S-curves of radii of 1000 m and more between them. Absent if more than 30 % of the run, or of
/// 150 m if it is shorter, lie on none, or if levels change more often than every 200 m.
[[nodiscard]] std::optional<TrackLevels> LevelsOf(const TrackRun& run);

}  // namespace railcast
