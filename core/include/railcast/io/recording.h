#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "railcast/frame.h"
#include "railcast/remark.h"
#include "railcast/scenario.h"
#include "railcast/transform.h"

namespace railcast {

/// One line of objects.jsonl: an object as seen in one frame.
struct RecordedObject {
  std::string name;
  std::string type;
  std::string label;
  std::uint32_t instance{};
  Vector3 size_m = Vector3::Zero();  ///< Length, width and height of the bounding box.
  /// Pose of the bounding box (centre and axes) at the stamp.
  Transform sensor_from_box = Transform::Identity();
  Vector3 velocity_world_mps = Vector3::Zero();  ///< Velocity of the box's centre.
  std::uint32_t points{};                        ///< Slots with a point on the object.
  /// Mean time of those points since the stamp; absent without points and in older recordings.
  std::optional<std::uint32_t> points_time_ns{};
  std::uint32_t firings_visible{};  ///< ObjectView::firings_visible; firings_alone likewise.
  std::uint32_t firings_alone{};
  std::optional<double> occlusion{};  ///< ObjectView::occlusion(), 0 to 1.
};

/// A per-point value of a foreign cloud that has no counterpart in Frame, such as `curvature`.
struct ForeignField {
  std::string name;           ///< Name in the file, without CloudCompare's prefix `scalar_`.
  std::vector<float> values;  ///< One per slot, in the file's unit; NaN where missing.
};

/// The slot of a point that was left out of a frame.
inline constexpr std::uint32_t kNoSlot = std::numeric_limits<std::uint32_t>::max();

/// Direction and origin of a firing's beam, in the sensor's axes at the time of the firing.
struct RecordedBeam {
  Vector3 direction = Vector3::UnitX();  ///< Unit vector.
  Vector3 origin_m = Vector3::Zero();
};

/// Whose axes the points of a frame are in.
enum class PointAxes : std::uint8_t {
  kSensorAtFiring,  ///< The sensor's at the time of each firing, as it measures.
  kSensorAtStamp,   ///< The sensor's at the stamp: its motion is undone, as in KITTI's format.
  kOther,           ///< Others, or left-handed ones; never those of a recording that was opened.
};

/// One frame of a recording, whether or not railcast made it.
///
/// `frame` is laid out as in railcast/frame.h, with points in the sensor's axes (x forward, y left,
/// z up). Fields that the recording lacks hold NaN or 0 and are not listed in `fields`. Values that
/// follow from the positions are filled in: range_m always, ring and column where `is_grid`.
/// Intensities of captures are reflectances (converted back from the vendor's byte values); those
/// of foreign clouds are as stored.
struct RecordedFrame {
  Frame frame;
  std::set<std::string, std::less<>> fields;  ///< Names, as in ForEachField(), of the known fields.
  std::string name;                           ///< For messages: a file name, or "file: turn 3".
  /// Whether slots correspond to firings, so that a slot without a point is a firing without a
  /// return. If false, the frame has a single row that holds points only.
  bool is_grid{};
  bool has_pose{};  ///< Whether world_from_sensor is known.
  PointAxes axes = PointAxes::kSensorAtFiring;
  std::vector<RecordedObject> objects;  ///< railcast sequences only.
  /// What the estimate of the frame's numerical error rests on (docs/certificate.md): the JSON of
  /// `certificate` in frames.jsonl; empty if the frame is not certified.
  std::string certificate_json{};
  /// Fields of the file that have no counterpart in `frame`, in the file's order, at most 64.
  /// Colours are left out.
  std::vector<ForeignField> foreign{};
  /// Offset that was subtracted from the stored positions, so that float32 can represent those of
  /// `frame`: position + origin_m = stored position. It is 0 unless positions were stored as
  /// float64 far from 0, as in a national grid; range_m is then still the distance from the 0 of
  /// the stored positions. Frames of one recording may have different origins.
  Vector3 origin_m = Vector3::Zero();
  /// For each point of the file or message, in its order, its slot or kNoSlot. Empty for captures.
  std::vector<std::uint32_t> slot_of_entry{};
  /// Why the frame is not a grid, as a clause: "it has no ...". Empty if it is one.
  std::string why_no_grid{};
  /// Why it is not known where the sensor was among the points, so that range_m, azimuths and
  /// elevations are not those of beams, as a clause. Empty if it was at their origin.
  std::string why_no_ranges{};
  /// Captures only, null for others: the beam of a cell, from its packet and the sensor's table of
  /// angles, whether or not anything returned.
  std::function<RecordedBeam(std::uint32_t row, std::uint32_t column)> beam_of{};
  /// Remarks of the reader of this frame's file or message; OpenRecording() moves them to
  /// RecordingInfo::remarks.
  std::vector<Remark> remarks{};

  [[nodiscard]] bool Has(std::string_view field) const { return fields.contains(field); }
};

/// Provenance of a railcast sequence.
struct SequenceOrigin {
  std::string version;  ///< Version of railcast.
  std::string embree;   ///< Version of Embree; empty in sequences of older versions.
  std::string isa;      ///< Instruction set used for tracing; empty in sequences of older versions.
  std::string scenario_hash;  ///< Hash of the scenario that was run.
  /// Hash of all files; empty if unfinished or written by an older version.
  std::string data_hash;
  bool is_finished{};
  bool has_commands{};  ///< Whether commands changed the scenario during the run.
  /// Names of the effects that fidelity `auto` chose. Empty if the run has another fidelity, or has
  /// not finished: until then they are recorded nowhere.
  std::vector<std::string> chosen_effects{};
};

/// Properties of a recording as a whole.
struct RecordingInfo {
  std::filesystem::path source;
  std::string kind;  ///< Human-readable: "sequence", "point cloud file", "capture of VLP-16", ...
  /// Absent for captures, whose length is known only at their end.
  std::optional<std::size_t> num_frames;
  LabelTable labels;  ///< Empty: labels have numbers only.
  /// Whether labels are SemanticKITTI numbers (Label::semantic_kitti) instead of Label::id.
  bool has_kitti_labels{};
  std::vector<std::string> materials;    ///< Names by index; empty: materials have numbers only.
  std::optional<ScenarioSpec> scenario;  ///< railcast sequences only, as resolved.
  /// railcast sequences only, including those in KITTI's format.
  std::optional<SequenceOrigin> origin;
  /// What the readers left out, bridged, guessed or rounded so far; complete once Next() has
  /// returned nothing and all frames have been read. Shared by all copies.
  std::shared_ptr<RemarkLog> remarks = std::make_shared<RemarkLog>();
};

/// Reads frames one after another from a sequence directory, cloud files or a capture.
///
///     const auto recording = OpenRecording("out/run1");
///     while (const auto read = recording->Next()) {
///       const RecordedFrame recorded = (*read)();
///       // Use recorded.frame ...
///     }
class Recording {
 public:
  virtual ~Recording() = default;

  [[nodiscard]] virtual const RecordingInfo& info() const = 0;

  /// Reads one frame. May be called from any thread, concurrently with readers of other frames.
  /// @throws InputError with one line if the frame's file cannot be read or is damaged.
  using FrameReader = std::function<RecordedFrame()>;

  /// Returns the reader of the next frame, or nothing at the end. Frames come in order of time.
  /// @throws InputError as FrameReader does.
  [[nodiscard]] virtual std::optional<FrameReader> Next() = 0;
};

/// Opens a sequence directory, a .pcd or .ply file, a directory of such files (in order of their
/// names), a .pcap or .pcapng capture of one of the sensors that docs/packets.md lists, or a bag of
/// ROS 2 (.mcap, .db3 or a rosbag2 directory), also one of several topics as TopicOfBag() names it,
/// with "#frame_id" behind it where that has several sensors.
/// @throws InputError with one line if `source` is none of these.
[[nodiscard]] std::unique_ptr<Recording> OpenRecording(const std::filesystem::path& source);

/// Whether the source is a bag of ROS 2, which may have several topics.
[[nodiscard]] bool IsBagOfTopics(const std::filesystem::path& source);

/// The path by which OpenRecording() opens one topic of a bag: "run.mcap:/lidar/points".
[[nodiscard]] std::filesystem::path TopicOfBag(const std::filesystem::path& bag,
                                               const std::string& topic);

}  // namespace railcast
