#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/io/recording/turn_noise.h"
#include "railcast/io/recording.h"
#include "railcast/scenario.h"
#include "railcast/transform.h"

namespace railcast {

/// How intensities vary on the smooth surfaces of a recording, for what is put beside them.
struct RecordedIntensities {
  std::string why_not{};       ///< Why the recording does not say; empty if it does.
  JackknifedFigure noise{};    ///< Standard deviation of log intensity from turn to turn.
  JackknifedFigure texture{};  ///< Its semideviation 0.1 m apart in a ring, less the noise.
  double range_m{};            ///< Mean range of the surfaces of the texture.
  /// Whether the plan has the effect, and its own file does not give the sensor's noise.
  bool wants_noise = true, wants_texture = true;
};

/// Measures turns in their order (FindTurnNoise()).
/// @param per_reflectance As IntensityScale has it.
[[nodiscard]] RecordedIntensities IntensitiesOf(std::vector<RecordedFrame> turns,
                                                double per_reflectance);

/// Measures the first few turns of a recording.
/// @param at_frames world_from_vehicle when each frame begins: ranges alone do not tell that a
///   sensor moves along a tunnel.
/// @return Nothing of a recording that is simulated, whose sensor and materials are known, and
///   where the plan wants neither figure.
/// @throws InputError as reading the recording does.
[[nodiscard]] std::optional<RecordedIntensities> MeasureIntensities(
    const std::filesystem::path& plan_file,
    const ScenarioSpec& plan,
    const std::filesystem::path& recording,
    const std::vector<Transform>& at_frames);

/// Gives the plan's sensor the noise that was measured, and its materials a texture with which a
/// surface that faces the beam at `range_m` has the measured semideviation; retroreflectors, which
/// were not measured, and materials that have a texture keep theirs. What the plan's own file
/// gives, and what the recording does not tell, or not from 0, stays as it is.
/// @returns What is used and from where, in a sentence for the user.
[[nodiscard]] std::string UseIntensities(const RecordedIntensities& recorded, ScenarioSpec& plan);

}  // namespace railcast
