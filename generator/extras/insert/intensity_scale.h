#pragma once

#include <cstdint>
#include <string>

#include "railcast/io/recording.h"

namespace railcast {

/// On which scale a recording has its intensities.
struct IntensityScale {
  double per_reflectance = 1.0;  ///< Recorded intensity of a white Lambertian surface.
  /// What a recorded intensity of 0 stands for, as an intensity: the middle of all that is rounded
  /// to it, a quarter of the least other one.
  double of_zero = 0.0;
  /// What was taken for known, or found, in a sentence for the user.
  std::string remark;
};

/// Finds the scale of a recording's intensities.
///
/// Those of captures and of railcast's sequences are reflectances. Clouds do not say what theirs
/// are: what they hold is taken to be reflectances where hardly any is above 1, hundredths where
/// hardly any is above 100, bytes of which 255 is white where none is above 255, and else 16-bit
/// counts. "Hardly any" are one in a hundred: of retroreflectors.
class IntensityScaleFinder {
 public:
  explicit IntensityScaleFinder(const RecordingInfo& info);

  /// Takes the points of a frame into account.
  void Add(const RecordedFrame& recorded);
  [[nodiscard]] IntensityScale Found() const;

 private:
  bool are_reflectances_;
  std::uint64_t num_points_ = 0;
  std::uint64_t num_above_1_ = 0;
  std::uint64_t num_above_100_ = 0;
  float highest_ = 0.0F;
  float least_ = 0.0F;  ///< Least intensity above 0; 0 = none.
};

}  // namespace railcast
