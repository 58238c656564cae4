#include "core/extras/insert/insert_record.h"

#include "core/io/record/read_record.h"
#include "core/scenario/archive.h"

namespace railcast {

void Describe(Archive& a, InsertSourceRecord& s) {
  a.Required("version", s.version, "Version of railcast that made it.");
  a.Required("scenario_xxh3", s.scenario_hash, "Hash of its scenario, as in its run.json.");
  a.Required("data_xxh3", s.data_hash, "Hash of its data, as in its manifest.json.");
}

void Describe(Archive& a, InsertRunRecord& s) {
  a.Required("version", s.version, "Version of railcast.");
  a.Required("embree", s.embree, "Version of Embree.");
  a.Required("recording", s.recording,
             "Path of the recording, as the command line or the recipe names it.");
  a.Required("recording_xxh3", s.recording_hash,
             "Hash of the names and sizes of the recording's files.");
  a.Required("kind", s.kind, "What kind of recording it is.");
  a.Required("kitti_labels", s.has_kitti_labels, "Whether labels are those of SemanticKITTI.");
  a.Required("plan_xxh3", s.plan_hash, "Hash of the plan with its defaults.");
  a.Required("seed", s.seed, "Seed of the insertion.");
  a.Required("format", s.format, "Format of the clouds, as `--format` names it.");
  a.Required("points_alone", s.may_use_points_alone, "Whether --points-alone was given.");
  a.Required("first_frame", s.first_frame, "Number of the first frame, in the recording.");
  a.Required("num_frames", s.num_frames, "Number of frames.");
  a.Optional("source", s.source, "The run that made the recording, if it is a sequence.");
  a.Optional("certify", s.certify, "Share of the time that certificates may take.");
}

void Describe(Archive& a, InsertManifestRecord& s) {
  Describe(a, s.run);
  a.Required("remarks", s.remarks, "Remarks on the plan.");
  a.Optional("certificate", s.certificate, "The numerical error of what was put in.");
  a.Required("files_xxh3", s.files, "Hashes of all files but those that insert.jsonl names.");
}

void Describe(Archive& a, PlaceRecord& s) {
  a.Required("s_m", s.s_m, "Chainage along the line.");
  a.Required("d_m", s.d_m, "Distance from the track's axis, positive to the left.");
  a.Required("h_m", s.h_m, "Height above top of rail.");
  a.Required("is_on_ground", s.is_on_ground, "Whether the height is that of the recorded ground.");
  a.Required("has_ground", s.has_ground, "Whether the recording shows ground there.");
}

void Describe(Archive& a, InsertedObjectRecord& s) {
  a.Required("name", s.name, "Name of the object in the plan.");
  a.Required("type", s.type, "Type of the object.");
  a.Required("label", s.label, "Name of the object's class.");
  a.Required("instance", s.instance, "The object's number in the clouds.");
  a.Required("center_sensor_m", s.center_sensor_m, "Centre of its box, in the sensor's axes.");
  a.Required("returns", s.returns, "Number of returns from it.");
  a.Nullable("nearest_return_m", s.nearest_return_m,
             "Range of the nearest of these; null without any.");
  a.Required("firings_visible", s.firings_visible,
             "Firings whose beam meets it first, as in objects.jsonl.");
  a.Required("firings_alone", s.firings_alone,
             "Firings whose beam would meet it if nothing else stood there.");
  a.Required("is_visible", s.is_visible, "Whether any firing meets it first.");
  a.Optional("asked", s.asked, "Where the plan wants it, in its words.");
  a.Optional("placed", s.placed, "Where it is at first.");
}

void Describe(Archive& a, InsertPoseRecord& s) {
  a.Required("position_m", s.position_m, "Position of the sensor in the world.");
  DescribeRotation(a, s.rotation);
  a.Required("is_recorded", s.is_recorded, "Whether the recording has poses.");
}

void Describe(Archive& a, InsertRecord& s) {
  a.Required("frame", s.frame.frame, "Number of the frame in the recording.");
  a.Required("source", s.source, "Name of the recorded file.");
  a.Required("plan_xxh3", s.plan_hash, "Hash of the plan with its defaults.");
  a.Required("seed", s.seed, "Seed of the insertion.");
  a.Required("stamp_ns", s.frame.stamp_ns, "Stamp of the frame.");
  a.Required("time_ns", s.time_ns, "Time of the frame since the recording's first frame.");
  a.Required("pose", s.pose, "The sensor's pose at the stamp.");
  a.Required("scan_poses", s.frame.scan_poses,
             "The sensor's poses after the stamp, as in frames.jsonl.", NonEmptyList());
  a.Required("points", s.frame.counts.points, "Number of slots with a point.");
  a.Required("added", s.added, "Number of points that were not recorded.");
  a.Required("removed", s.removed, "Number of recorded points that are gone.");
  a.Required("weaker", s.weaker, "Number of points whose intensity has changed.");
  a.Required("are_points_alone", s.are_points_alone, "Whether firings without points are unknown.");
  a.Required("objects", s.objects, "The inserted objects within range.");
  a.Optional("split", s.split,
             "Part of its data set to which the recording says that the frame belongs.");
  a.Optional("source_xxh3", s.source_hash, "Hash of the recorded cloud.");
  a.Optional("certificate", s.frame.certificate, "What is known of the frame's numerical error.");
  a.Required("files", s.frame.files, "The frame's files.");
  a.Required("records_xxh3", s.frame.records_hash, "Hash of the frame's lines in the other files.");
}

InsertRecord ReadInsertLine(std::string_view line, const std::string& place) {
  auto record = ReadRecordLine<InsertRecord>(line, place);
  CheckTimes(record.frame.scan_poses, place);
  return record;
}

}  // namespace railcast
