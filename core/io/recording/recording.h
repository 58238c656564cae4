#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/transform.h"
#include "core/frame/frame.h"
#include "core/frame/labels.h"
#include "core/scenario/scenario_spec.h"

namespace railcast {

/// A line of objects.jsonl: what one frame shows of one object.
struct RecordedObject {
  std::string name;
  std::string type;
  std::string label;
  std::uint32_t instance{};
  Vector3 size_m = Vector3::Zero();
  Transform sensor_from_box = Transform::Identity();  ///< At the stamp, box centre and axes.
  Vector3 velocity_world_mps = Vector3::Zero();       ///< Of the box's centre.
  std::uint32_t points{};
  std::uint32_t firings_visible{};
  std::uint32_t firings_alone{};
};

/// A number that somebody's cloud has of every point and that is none of ours: `curvature`, ...
struct ForeignField {
  std::string name;           ///< As the file has it, less CloudCompare's `scalar_`.
  std::vector<float> values;  ///< Of each slot, in the file's unit; NaN where none.
};

/// One frame of a recording, ours or anybody's.
///
/// `frame` is as core/frame/frame.h says, points in the sensor's axes (x forward, y left, z up). A
/// field that the recording lacks holds NaN or 0 and is not in `fields`; what can be computed from
/// the positions is there: range_m always, and ring and column where `is_grid`. Intensities of
/// captures are reflectances (the vendors' bytes undone); of foreign clouds they are as stored.
struct RecordedFrame {
  Frame frame;
  std::set<std::string, std::less<>> fields;  ///< Of ForEachField's names, those that are known.
  std::string name;                           ///< For messages: a file, or "file: turn 3".
  /// Whether slots are firings: one without a point is a firing that brought nothing back. If not,
  /// the frame has one row of points only.
  bool is_grid{};
  bool has_pose{};                      ///< Whether world_from_sensor is known.
  std::vector<RecordedObject> objects;  ///< Of our sequences only.
  /// What no field of `frame` was read from, in the file's order, up to 64; colours are left out.
  std::vector<ForeignField> foreign{};
  /// What was subtracted from stored positions so that float32 can hold those of `frame`: positions
  /// + origin_m = as stored. 0 unless they were stored as float64 and far from 0, as in a national
  /// grid; then range_m is still the distance from the stored 0. Frames of one recording may
  /// differ.
  Vector3 origin_m = Vector3::Zero();

  [[nodiscard]] bool Has(std::string_view field) const { return fields.contains(field); }
};

/// By whom one of our sequences was made, and what it is.
struct SequenceOrigin {
  std::string version;        ///< Of railcast.
  std::string embree;         ///< Version; empty in directories of older programs, ...
  std::string isa;            ///< ... as is the instruction set that was traced with.
  std::string scenario_hash;  ///< Of what it is a run of.
  std::string data_hash;  ///< Of all its files; empty if it is unfinished or of an older program.
  bool is_finished{};
  bool has_commands{};  ///< Whether commands changed what the scenario says.
};

/// What is known of a recording as a whole.
struct RecordingInfo {
  std::filesystem::path source;
  std::string kind;  ///< For people: "sequence", "point cloud file", "capture of VLP-16", ...
  std::optional<std::size_t> num_frames;  ///< Not known of captures before their end.
  LabelTable labels;                      ///< Empty: labels have numbers only.
  /// Whether frames have SemanticKITTI's label numbers: Label::semantic_kitti, not Label::id.
  bool has_kitti_labels{};
  std::vector<std::string> materials;    ///< Names by id; empty: they have numbers only.
  std::optional<ScenarioSpec> scenario;  ///< Of our sequences, as resolved.
  std::optional<SequenceOrigin> origin;  ///< Of our sequences, KITTI's format as well.
};

/// Frames one after another, from a sequence directory, cloud files or a capture.
class Recording {
 public:
  virtual ~Recording() = default;

  [[nodiscard]] virtual const RecordingInfo& info() const = 0;

  /// Reads one frame; any thread may call it, also beside those of other frames.
  /// @throws InputError with one line if its file cannot be read or is damaged.
  using FrameReader = std::function<RecordedFrame()>;

  /// How the next frame is read; nothing at the end. Frames come in order of time.
  /// @throws InputError as FrameReader does.
  [[nodiscard]] virtual std::optional<FrameReader> Next() = 0;
};

/// Opens a sequence directory, a .pcd or .ply file, a directory of such files (in order of their
/// names), or a .pcap or .pcapng capture of VLP-16, HDL-32E, VLP-32C or Pandar64.
/// @throws InputError with one line if it is none of these.
[[nodiscard]] std::unique_ptr<Recording> OpenRecording(const std::filesystem::path& source);

}  // namespace railcast
