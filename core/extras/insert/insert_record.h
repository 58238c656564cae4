#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/certify/certified_figures.h"
#include "core/io/run/frame_record.h"
#include "core/scenario/value_type.h"

namespace railcast {

// The files that say what an insertion has put into a recording (docs/insert.md).

/// Beside kInsertFile: the plan as a scenario whose line is the recording's.
inline constexpr std::string_view kInsertWorldFile = "world.resolved.json";
/// Beside kInsertFile: a NumPy array for each frame, with a row for each point of its cloud.
inline constexpr std::string_view kInsertPointsFolder = "points";
inline constexpr const char* kInsertPointType =
    "[('label', '<u4'), ('instance', '<u4'), ('outcome', 'u1'), ('change', 'u1')]";
inline constexpr std::size_t kInsertPointBytes = 10;

/// The run that made the recording, if it is a sequence.
struct InsertSourceRecord {
  std::string version;
  std::string scenario_hash;
  std::string data_hash;
};
void Describe(Archive& a, InsertSourceRecord& s);

/// The content of run.json of an insertion.
struct InsertRunRecord {
  std::string version;
  std::string embree;
  std::string recording;  ///< Its path.
  std::string recording_hash;
  std::string kind;  ///< RecordingInfo::kind.
  bool has_kitti_labels{};
  std::string plan_hash;
  std::uint64_t seed{};
  std::string format;
  bool may_use_points_alone{};
  std::uint32_t first_frame{};
  std::uint32_t num_frames{};
  std::optional<InsertSourceRecord> source{};
  std::optional<double> certify{};  ///< Share of the time that certificates may take.
};
void Describe(Archive& a, InsertRunRecord& s);

/// The content of manifest.json of an insertion.
struct InsertManifestRecord {
  InsertRunRecord run{};
  std::vector<std::string> remarks{};
  std::optional<RunCertificate> certificate{};  ///< If it is certified.
  NamedValues<std::string> files{};             ///< The hashes of all files but those of frames.
};
void Describe(Archive& a, InsertManifestRecord& s);

/// Where an object of a plan is at first.
struct PlaceRecord {
  double s_m{};
  double d_m{};
  double h_m{};
  bool is_on_ground{};
  bool has_ground{};
};
void Describe(Archive& a, PlaceRecord& s);

/// An inserted object in a frame.
struct InsertedObjectRecord {
  std::string name{};
  std::string type{};
  std::string label{};
  std::uint32_t instance{};
  Vector3 center_sensor_m = Vector3::Zero();
  std::uint32_t returns{};
  std::optional<double> nearest_return_m{};
  std::uint32_t firings_visible{};
  std::uint32_t firings_alone{};
  bool is_visible{};
  std::string asked{};  ///< Where the plan wants it, in its words.
  std::optional<PlaceRecord> placed{};
};
void Describe(Archive& a, InsertedObjectRecord& s);

/// Where the sensor was at a frame's stamp.
struct InsertPoseRecord {
  Vector3 position_m = Vector3::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  bool is_recorded{};
};
void Describe(Archive& a, InsertPoseRecord& s);

/// A line of insert.jsonl, which states that a frame is complete.
struct InsertRecord {
  /// Its number, stamp, poses, files, number of points and certificate, and the hash of its other
  /// lines.
  FrameRecord frame{};
  std::string source{};  ///< Name of the recorded file.
  std::string plan_hash{};
  std::uint64_t seed{};
  std::int64_t time_ns{};  ///< Time in the recording.
  InsertPoseRecord pose{};
  std::uint64_t added{};
  std::uint64_t removed{};
  std::uint64_t weaker{};
  bool are_points_alone{};
  std::vector<InsertedObjectRecord> objects{};
  std::string split{};        ///< The part of a data set that the recording says the frame is of.
  std::string source_hash{};  ///< Hash of the recorded cloud's files.
};
void Describe(Archive& a, InsertRecord& s);

/// @throws InputError "place: rule" if it is not a line of insert.jsonl. Its hash is not checked.
[[nodiscard]] InsertRecord ReadInsertLine(std::string_view line, const std::string& place);

}  // namespace railcast
