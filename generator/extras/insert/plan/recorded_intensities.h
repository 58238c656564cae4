#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/io/recording/turn_noise.h"
#include "railcast/io/recording.h"
#include "railcast/scenario.h"

namespace railcast {

/// How intensities vary on the smooth surfaces of a recording, for what is put beside them.
struct RecordedIntensities {
  bool is_simulated{};         ///< Then the sensor and the materials of its scenario are known.
  std::string why_not{};       ///< Why the recording does not say; empty if it does.
  JackknifedFigure noise{};    ///< Standard deviation of log intensity from turn to turn.
  JackknifedFigure texture{};  ///< Its semideviation 0.1 m apart in a ring, less the noise.
  double range_m{};            ///< Mean range of the surfaces of the texture.
  bool is_noise_given{};       ///< Whether the plan's own file has the sensor's `intensity_noise`.
};

/// Measures turns in their order (FindTurnNoise()).
/// @param per_reflectance As IntensityScale has it.
[[nodiscard]] RecordedIntensities IntensitiesOf(std::vector<RecordedFrame> turns,
                                                double per_reflectance);

/// Measures the first few turns of a recording, unless it is simulated.
/// @throws InputError as reading the recording does.
[[nodiscard]] RecordedIntensities MeasureIntensities(const std::filesystem::path& plan_file,
                                                     const std::filesystem::path& recording);

/// Gives the plan's sensor the noise that was measured, unless its own file does, and materials
/// without a texture one with which a surface that faces the beam at `range_m` has the measured
/// semideviation. Materials with one are known better, and retroreflectors were not measured. What
/// the recording does not say stays as it is. What is within two standard errors of 0 is 0.
/// @returns What is used and from where, in a sentence for the user; empty where the plan puts
///   nothing in that has either.
[[nodiscard]] std::string UseIntensities(const RecordedIntensities& recorded, ScenarioSpec& plan);

}  // namespace railcast
