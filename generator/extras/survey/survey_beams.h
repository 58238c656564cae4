#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "railcast/io/recording.h"
#include "railcast/transform.h"

namespace railcast {

/// How the points of a recording become those of a survey.
struct SurveySource {
  std::vector<std::filesystem::path> recordings;
  std::uint32_t first_frame = 0;              ///< First frame of each recording, counted from 0.
  std::optional<std::uint32_t> num_frames{};  ///< Absent = all that follow.
  std::uint32_t stride = 1;                   ///< Every how many-th of them.
  /// Poses of the sensor in the world, a line of KITTI's for each frame of the one recording;
  /// empty: those of the recording.
  std::filesystem::path poses{};
  /// Whether frames without a pose were all taken from one place, ...
  bool is_standing = false;
  /// ... or are in the world's axes, from where nobody knows.
  bool is_in_world = false;
  double range_max_m = 60.0;                ///< Points farther from the sensor are left out.
  std::optional<double> white_intensity{};  ///< The recorded intensity of a white surface.
  /// The same where it is absent, of recordings of others than railcast and captures.
  double guessed_white = 1.0;
};

/// A recorded point and where its beam came from, both in the world.
struct SurveyBeam {
  Vector3 origin_m = Vector3::Zero();
  Vector3 point_m = Vector3::Zero();
  float reflectance{};  ///< As recorded, on the scale of the sensor's reflectances; NaN = unknown.
  std::uint16_t label{};  ///< Index into the labels of the survey.
};

/// The points of a frame.
struct SurveyFrame {
  std::vector<SurveyBeam> beams;
  /// Pose of the vehicle at the stamp, with its origin at top of rail; of the sensor if
  /// `has_vehicle` is false.
  Transform world_from_body = Transform::Identity();
  bool has_vehicle = false;
  bool has_origins = false;  ///< Whether the beams' origins and the pose are known.
};

/// The names of a survey's labels, which grow while frames are read. The first three are for
/// points whose label is not known.
class SurveyLabels {
 public:
  [[nodiscard]] std::uint16_t IndexOf(const std::string& name);
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

  static constexpr std::uint16_t kGround = 0;
  static constexpr std::uint16_t kObject = 1;
  static constexpr std::uint16_t kWire = 2;
  static constexpr std::uint16_t kUnknown = 0xFFFF;  ///< No label was recorded.

 private:
  std::vector<std::string> names_{"ground", "object", "contact_wire"};
};

/// What a white surface has in recordings of others, by the highest intensity in all of their
/// frames that the source names: 1, 255 if they have more than 1, or 65535 if LAS has more than
/// 255. Absent where the source says it, or where no such recording has intensities.
/// @throws InputError as OpenRecording() and its readers do.
[[nodiscard]] std::optional<double> GuessWhite(const SurveySource& source);

/// Makes beams of the points of a recorded frame. Echoes of rain, snow and fog are left out where
/// the recording knows them.
/// @throws InputError if it is not known where the points are.
[[nodiscard]] SurveyFrame BeamsOf(const RecordedFrame& recorded,
                                  const RecordingInfo& info,
                                  const SurveySource& source,
                                  SurveyLabels& labels);

/// Calls `visit` with the beams of every frame that the source names, in their order. A survey asks
/// for them twice.
/// @throws InputError as OpenRecording() and its readers do, if there is no such frame, or if there
///   is not one pose for each.
void VisitFrames(const SurveySource& source,
                 SurveyLabels& labels,
                 const std::function<void(const SurveyFrame& frame)>& visit);

}  // namespace railcast
