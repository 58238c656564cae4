#include "generator/extras/insert/clouds/sidecars.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/text.h"
#include "core/io/run/camera_files.h"
#include "core/io/run/frame_record.h"
#include "core/io/run/sequence_files.h"

namespace railcast {
namespace {

/// The recorded slots whose returns are in no slot any more.
std::vector<std::uint32_t> LostSlots(const InsertedFrame& inserted) {
  std::vector<std::uint32_t> kept;
  for (const SlotEdit& edit : inserted.edits) {
    if (edit.has_point && !edit.is_added) kept.push_back(edit.from_slot.value_or(edit.slot));
  }
  std::ranges::sort(kept);
  std::vector<std::uint32_t> lost;
  for (const SlotEdit& edit : inserted.edits) {
    if (edit.had_point && !std::ranges::binary_search(kept, edit.slot)) lost.push_back(edit.slot);
  }
  return lost;
}

/// A row of points/NNNNNN.npy.
struct PointRow {
  std::uint32_t label{};
  std::uint32_t instance{};
  std::uint8_t outcome{};
  PointChange change = PointChange::kNone;
};

std::string PointsNpy(const RecordedFirings& firings,
                      const InsertedFrame& inserted,
                      const std::vector<std::uint32_t>& slots,
                      const std::vector<std::uint32_t>& labels) {
  const RecordedFrame& before = firings.recorded;
  const Frame& after = inserted.recorded.frame;
  std::vector<PointChange> changes(after.num_slots(), PointChange::kKept);
  for (std::size_t slot = 0; slot < changes.size(); ++slot) {
    if (std::isnan(after.x[slot])) changes[slot] = PointChange::kNone;
  }
  for (const SlotEdit& edit : inserted.edits) {
    if (edit.is_added) {
      changes[edit.slot] = PointChange::kAdded;
    } else if (edit.has_point && edit.is_weaker) {
      changes[edit.slot] = PointChange::kWeaker;
    } else if (edit.had_point && !edit.has_point) {
      changes[edit.slot] = PointChange::kRemoved;
    }
  }
  std::string bytes = NpyHeader(kInsertPointType, "(" + NumberText(slots.size()) + ",)");
  std::size_t place = bytes.size();
  bytes.resize(place + kInsertPointBytes * slots.size());
  for (const std::uint32_t slot : slots) {
    PointRow row;
    if (slot != kNoSlot) {
      row.change = changes[slot];
      const bool is_added = row.change == PointChange::kAdded;
      row.instance = after.instance[slot];
      row.label = labels[slot];
      const bool is_known = is_added || before.Has("outcome") || std::isnan(after.x[slot]);
      row.outcome = static_cast<std::uint8_t>(is_known ? after.outcome[slot] : Outcome::kReturned);
    }
    std::memcpy(&bytes[place], &row.label, sizeof row.label);
    std::memcpy(&bytes[place + 4], &row.instance, sizeof row.instance);
    bytes[place + 8] = static_cast<char>(row.outcome);
    bytes[place + 9] = static_cast<char>(row.change);
    place += kInsertPointBytes;
  }
  return bytes;
}

/// The points of some slots as a frame of one row.
Frame CloudOfSlots(const Frame& frame, const std::vector<std::uint32_t>& slots) {
  Frame points;
  points.has_velocity = frame.has_velocity;
  points.Resize(1, static_cast<std::uint32_t>(slots.size()), 1);
  std::vector<const void*> all;
  ForEachField(frame, [&](std::string_view, std::string_view, const auto& values) {
    all.push_back(&values);
  });
  std::size_t i = 0;
  ForEachField(points, [&](std::string_view, std::string_view, auto& values) {
    const auto& from = *static_cast<const std::remove_reference_t<decltype(values)>*>(all[i++]);
    for (std::size_t k = 0; k < slots.size(); ++k) values[k] = from[slots[k]];
  });
  return points;
}

FrameFile EncodedCloud(const Frame& points, const std::string& name) {
  FrameFile file{name, {}};
  EncodePcd(points,
            FieldSelection("x,y,z,intensity,range_m,time_ns,ring,column,return_index,label,"
                           "instance,outcome,true_range_m"),
            PcdEncoding::kBinary, file.bytes);
  return file;
}

InsertedObjectRecord ObjectEntry(const RecordedObject& object,
                                 const Frame& after,
                                 const InsertedFrame& inserted) {
  InsertedObjectRecord entry{.name = object.name,
                             .type = object.type,
                             .label = object.label,
                             .instance = object.instance,
                             .center_sensor_m = object.sensor_from_box.translation(),
                             .firings_visible = object.firings_visible,
                             .firings_alone = object.firings_alone};
  for (const SlotEdit& edit : inserted.edits) {
    const bool is_new = edit.is_added && !edit.is_merged;
    if (!is_new || after.instance[edit.slot] != object.instance) continue;
    ++entry.returns;
    const double range_m = after.range_m[edit.slot];
    entry.nearest_return_m = std::min(entry.nearest_return_m.value_or(range_m), range_m);
  }
  entry.is_visible = entry.returns > 0;
  return entry;
}

}  // namespace

std::vector<FrameFile> SidecarFiles(const RecordedFirings& firings,
                                    const InsertedFrame& inserted,
                                    const std::vector<std::uint32_t>& slots,
                                    const LabelNumbers& labels,
                                    std::uint32_t frame) {
  const std::string digits = FrameDigits(frame);
  std::vector<FrameFile> files;
  const std::vector<std::uint32_t> written = WrittenLabels(inserted, labels);
  files.push_back({std::string(kInsertPointsFolder) + "/" + digits + ".npy",
                   PointsNpy(firings, inserted, slots, written)});
  std::vector<std::uint32_t> added;
  for (const SlotEdit& edit : inserted.edits) {
    if (edit.is_added) added.push_back(edit.slot);
  }
  if (!added.empty()) {
    Frame points = CloudOfSlots(inserted.recorded.frame, added);
    for (std::size_t i = 0; i < added.size(); ++i) points.label[i] = written[added[i]];
    files.push_back(EncodedCloud(points, "added/" + digits + ".pcd"));
  }
  const std::vector<std::uint32_t> lost = LostSlots(inserted);
  if (lost.empty()) return files;
  Frame points = CloudOfSlots(firings.recorded.frame, lost);
  std::size_t i = 0;
  for (const SlotEdit& edit : inserted.edits) {
    if (i == lost.size() || edit.slot != lost[i]) continue;
    points.outcome[i] = edit.lost_to;
    points.instance[i] = edit.hidden_by;
    ++i;
  }
  files.push_back(EncodedCloud(points, "removed/" + digits + ".pcd"));
  return files;
}

InsertRecord InsertEntry(const RecordedFirings& firings,
                         const InsertedFrame& inserted,
                         const InsertPlan& plan,
                         std::uint32_t frame) {
  const RecordedFrame& recorded = firings.recorded;
  const Frame& after = inserted.recorded.frame;
  const std::int64_t time_ns = plan.frame_times_ns.at(frame);
  const PoseRecord pose(plan.first_stamp_ns + time_ns, after.world_from_sensor);
  InsertRecord entry{
      .frame = {.frame = frame, .stamp_ns = pose.stamp_ns, .scan_poses = ScanPosesOf(after)},
      .source = std::filesystem::path(recorded.name).filename().string(),
      .plan_hash = plan.identity.scenario_hash,
      .seed = plan.scenario.seed,
      .time_ns = time_ns,
      .pose = {pose.position_m, pose.rotation, recorded.has_pose},
      .removed = LostSlots(inserted).size(),
      .are_points_alone = firings.are_points_alone};
  entry.frame.counts.points = static_cast<std::uint64_t>(
      std::ranges::count_if(after.x, [](float x) { return !std::isnan(x); }));
  for (const SlotEdit& edit : inserted.edits) {
    entry.added += edit.is_added;
    entry.weaker += edit.has_point && !edit.is_added && edit.is_weaker;
  }
  for (const RecordedObject& object : inserted.objects) {
    InsertedObjectRecord& added = entry.objects.emplace_back(ObjectEntry(object, after, inserted));
    const auto& specs = plan.scenario.world.objects;
    const auto place = std::ranges::find(specs, object.name, &ObjectSpec::name);
    const auto index = static_cast<std::size_t>(place - specs.begin());
    if (place == specs.end() || index >= plan.places.size()) continue;
    const PlacedThing& placed = plan.places[index];
    added.asked = placed.asked;
    added.placed = {placed.s_m, placed.d_m, placed.h_m, placed.is_on_ground, placed.has_ground};
  }
  return entry;
}

}  // namespace railcast
