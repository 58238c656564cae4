#include "core/io/run/object_record.h"

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/record/read_record.h"
#include "core/io/run/frame_record.h"
#include "core/scenario/archive.h"

namespace railcast {

Transform BoxRecord::ToFromBox() const {
  return MakeTransform(rotation.normalized().toRotationMatrix(), center_m);
}

void Describe(Archive& a, BoxRecord& s) {
  a.Required("center_m", s.center_m, "Centre of the box.");
  a.Required("size_m", s.size_m, "Length, width and height of the box.");
  DescribeRotation(a, s.rotation);
}

void Describe(Archive& a, ContactRecord& s) {
  a.Required("with", s.with, "Name of the other object.");
  a.Required("overlap", s.is_overlap, "Whether the two overlap.");
  a.Required("gap_m", s.gap_m, "Distance between the two; negative where they overlap.");
}

void Describe(Archive& a, ObjectRecord& s) {
  a.Required("name", s.name, "Name of the object.");
  a.Required("type", s.type, "Type of the object.");
  a.Required("label", s.label, "Name of the object's class.");
  a.Required("instance", s.instance, "The object's number in the clouds.");
  a.Required("world", s.world, "Its box at the stamp in the world.");
  a.Required("sensor", s.sensor,
             "Its box at the stamp in the sensor's axes, which are right-handed.");
  a.Required("output", s.output, "Its box at the stamp in the axes of the frame's points.");
  a.Required("velocity_mps", s.velocity_world_mps,
             "Velocity of the box's centre, mean over the scan.");
  a.Required("points", s.points, "Number of slots with a point on it.");
  a.Nullable("points_time_ns", s.points_time_ns, "Mean time of these points since the stamp.");
  a.Required("firings_visible", s.firings_visible,
             "Firings whose beam meets it first with any of its rays, detected or not.");
  a.Required("firings_alone", s.firings_alone,
             "Firings whose beam would meet it if nothing else stood there.");
  a.Ensure({"firings_visible"}, s.firings_visible <= s.firings_alone,
           "must be <= firings_alone, " + NumberText(s.firings_alone));
  a.Nullable("occlusion", s.occlusion, "Share of its firings that something hides.", Within(0, 1));
  a.Ensure({"occlusion"}, s.firings_alone > 0 || !s.occlusion,
           "must be null, as no firing would meet the object even alone");
  a.Ensure({"occlusion"}, s.firings_alone == 0 || s.occlusion, "must be a number");
  a.Required("contacts", s.contacts, "The objects that it touches or overlaps.");
}

void Describe(Archive& a, ObjectsRecord& s) {
  a.Required("frame", s.frame, "Number of the frame.");
  a.Required("stamp_ns", s.stamp_ns, "Simulation time of the frame.");
  a.Required("objects", s.objects,
             "The objects within the sensor's range, except its own vehicle.");
}

ObjectsRecord ReadObjectsRecord(std::string_view line,
                                std::uint32_t frame,
                                const std::string& place) {
  auto record = ReadRecordLine<ObjectsRecord>(line, place);
  if (record.frame == frame) return record;
  throw InputError(place + ": frame: must be " + NumberText(frame) +
                   ", as in frames.jsonl or insert.jsonl" + Got(record.frame));
}

}  // namespace railcast
