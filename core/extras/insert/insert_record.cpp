#include "core/extras/insert/insert_record.h"

#include "core/io/record/read_record.h"
#include "core/scenario/archive.h"

namespace railcast {

void Describe(Archive& a, InsertSourceRecord& s) {
  a.Required("version", s.version, "As in its run.json and manifest.json.");
  a.Required("scenario_xxh3", s.scenario_hash, "");
  a.Required("data_xxh3", s.data_hash, "");
}

void Describe(Archive& a, InsertRunRecord& s) {
  a.Required("version", s.version, "Of railcast.");
  a.Required("embree", s.embree, "Its version.");
  a.Required("recording", s.recording, "Its path, as the command line or the recipe names it.");
  a.Required("recording_xxh3", s.recording_hash, "Hash of its files' names and sizes.");
  a.Required("kind", s.kind, "What the recording is.");
  a.Required("kitti_labels", s.has_kitti_labels, "Whether labels are those of SemanticKITTI.");
  a.Required("plan_xxh3", s.plan_hash, "Hash of the plan with its defaults.");
  a.Required("seed", s.seed, "");
  a.Required("format", s.format, "");
  a.Required("points_alone", s.may_use_points_alone, "Whether --points-alone was given.");
  a.Required("first_frame", s.first_frame, "");
  a.Required("num_frames", s.num_frames, "");
  a.Optional("source", s.source, "The run that made the recording, if it is a sequence.");
  a.Optional("certify", s.certify, "Share of the time that certificates may take.");
}

void Describe(Archive& a, InsertManifestRecord& s) {
  Describe(a, s.run);
  a.Required("remarks", s.remarks, "On the plan.");
  a.Optional("certificate", s.certificate, "The numerical error of what was put in.");
  a.Required("files_xxh3", s.files, "Hashes of all files but those that insert.jsonl names.");
}

void Describe(Archive& a, PlaceRecord& s) {
  a.Required("s_m", s.s_m, "Along the line.");
  a.Required("d_m", s.d_m, "From the track's axis, left positive.");
  a.Required("h_m", s.h_m, "Above top of rail.");
  a.Required("is_on_ground", s.is_on_ground, "Whether the height is that of the recorded ground.");
  a.Required("has_ground", s.has_ground, "Whether there is ground.");
}

void Describe(Archive& a, InsertedObjectRecord& s) {
  a.Required("name", s.name, "");
  a.Required("type", s.type, "");
  a.Required("label", s.label, "");
  a.Required("instance", s.instance, "");
  a.Required("center_sensor_m", s.center_sensor_m, "Of its box, in the sensor's axes.");
  a.Required("returns", s.returns, "That it gave.");
  a.Nullable("nearest_return_m", s.nearest_return_m, "");
  a.Required("firings_visible", s.firings_visible, "As in objects.jsonl.");
  a.Required("firings_alone", s.firings_alone, "");
  a.Required("is_visible", s.is_visible, "");
  a.Optional("asked", s.asked, "Where the plan wants it, in its words.");
  a.Optional("placed", s.placed, "Where it is at first.");
}

void Describe(Archive& a, InsertPoseRecord& s) {
  a.Required("position_m", s.position_m, "");
  DescribeRotation(a, s.rotation);
  a.Required("is_recorded", s.is_recorded, "Whether the recording has poses.");
}

void Describe(Archive& a, InsertRecord& s) {
  a.Required("frame", s.frame.frame, "Its number in the recording.");
  a.Required("source", s.source, "Name of the recorded file.");
  a.Required("plan_xxh3", s.plan_hash, "");
  a.Required("seed", s.seed, "");
  a.Required("stamp_ns", s.frame.stamp_ns, "");
  a.Required("time_ns", s.time_ns, "");
  a.Required("pose", s.pose, "Of the sensor at the stamp.");
  a.Required("scan_poses", s.frame.scan_poses, "As in frames.jsonl.", NonEmptyList());
  a.Required("points", s.frame.counts.points, "");
  a.Required("added", s.added, "Points that were not recorded.");
  a.Required("removed", s.removed, "Points that were.");
  a.Required("weaker", s.weaker, "Points with another intensity.");
  a.Required("are_points_alone", s.are_points_alone, "Whether firings without points are unknown.");
  a.Required("objects", s.objects, "The inserted objects within range.");
  a.Optional("split", s.split, "Part of a data set that the recording is of.");
  a.Optional("source_xxh3", s.source_hash, "Hash of the recorded cloud.");
  a.Optional("certificate", s.frame.certificate, "What is known of its numerical error.");
  a.Required("files", s.frame.files, "Of this frame.");
  a.Required("records_xxh3", s.frame.records_hash, "Hash of the frame's lines in the other files.");
}

InsertRecord ReadInsertLine(std::string_view line, const std::string& place) {
  auto record = ReadRecordLine<InsertRecord>(line, place);
  CheckTimes(record.frame.scan_poses, place);
  return record;
}

}  // namespace railcast
