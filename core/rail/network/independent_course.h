#pragma once

#include <optional>
#include <string>

#include "core/rail/network/network.h"
#include "core/rail/network/turnout_place.h"

namespace railcast {

/// A track that is not parallel to the alignment, and the turnouts at its ends.
struct IndependentTrack {
  std::string pointer;
  const TrackSpec& spec;
  const std::optional<TurnoutPlace>& begin;
  const std::optional<TurnoutPlace>& end;
  double line_length_m{};
};

/// What could be made of it. Turnouts lack their `branch`.
struct IndependentCourse {
  std::optional<TrackCourse> course;
  std::optional<TurnoutSite> begin;
  std::optional<TurnoutSite> end;
};

/// Makes the course of such a track by the rules of Network and adds all faults found.
[[nodiscard]] IndependentCourse MakeIndependentCourse(const IndependentTrack& track,
                                                      WorldFaults& faults);

}  // namespace railcast
