#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "analysis/fit/known_planes.h"
#include "analysis/fit/trial.h"
#include "core/io/recording/recording.h"

namespace railcast {

/// The trials of one or more recordings, and what these say besides.
struct RecordedTrials {
  std::vector<Trial> trials;  ///< A sample (analysis/fit/trial_sample.h).
  std::vector<FitSurface> surfaces;
  std::uint64_t num_frames{};
  std::uint64_t num_seen{};  ///< Trials, before the sample was drawn.
  std::uint64_t
      num_hidden{};     ///< Firings whose point is clutter: what they should have met is lost.
  bool knows_losses{};  ///< Whether slots are firings: else what is lost leaves no trace.
  /// Scatter of the points across their beam (up and down) over that along it; NaN = not known.
  double lateral_ratio = std::numeric_limits<double>::quiet_NaN();
  std::vector<KnownPlane> planes;             ///< As refined.
  std::vector<std::size_t> num_plane_points;  ///< That each rests on.
};

/// Scatter across the beam of more than this share of that along it is noise in all directions.
inline constexpr double kIsotropicRatio = 0.3;

using TrialProgress = std::function<void(std::uint64_t num_frames)>;

/// Reads recordings to their ends, in parallel, in bounded memory: from planes if there are any,
/// else from truth fields. Surfaces get the shapes of the scenario's materials, if there is one.
/// @throws InputError as recordings do; "source: must have truth fields, or planes given with
///   --planes"; if the sources' materials differ.
[[nodiscard]] RecordedTrials ReadTrials(const std::vector<std::filesystem::path>& sources,
                                        std::vector<KnownPlane> planes,
                                        const TrialProgress& on_progress);

}  // namespace railcast
