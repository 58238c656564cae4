#include "viewer/frames/frames.h"

#include <algorithm>
#include <filesystem>
#include <ranges>
#include <stop_token>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/cloud/kitti.h"
#include "core/io/run/scenario_identity.h"
#include "railcast/io/recording.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

/// Looks for labels.json in the source's folder, then in `num_above` folders above it.
LabelTable FindLabels(const std::filesystem::path& source, int num_above) {
  std::filesystem::path folder = std::filesystem::absolute(source).lexically_normal();
  // A path that ends in a slash has an empty last component.
  if (!is_directory(folder) || !folder.has_filename()) folder = folder.parent_path();
  for (int i = 0; i <= num_above; ++i, folder = folder.parent_path()) {
    const std::filesystem::path candidate = folder / "labels.json";
    if (is_regular_file(candidate)) return ReadLabelTable(candidate);
  }
  return {};
}

constexpr std::size_t kMaxTurns = 24;  // For captures and bags; a turn of a Pandar64 takes 5 MB.
constexpr std::size_t kMaxReaders = 4096;  // For files; a reader holds a few lines of text.

}  // namespace

std::vector<RecordedObject> ObjectsAt(const World& world,
                                      const LabelTable& labels,
                                      const Frame& frame) {
  const Transform sensor_from_world = frame.world_from_sensor.inverse();
  const std::int64_t end_ns = frame.stamp_ns + frame.duration_ns;
  std::vector<RecordedObject> objects;
  for (std::size_t i = 0; i < world.objects().size(); ++i) {
    const SceneObject& object = world.objects()[i];
    if (object.is_ego) continue;
    const Eigen::AlignedBox3d bounds_m = object.model->Bounds();
    const Label* const label = labels.Find(object.label);
    RecordedObject recorded;
    recorded.name = object.name;
    recorded.type = object.type;
    recorded.label = label == nullptr ? std::string() : label->name;
    recorded.instance = object.instance;
    recorded.size_m = bounds_m.sizes();
    const Transform world_from_object = world.WorldFromObject(i, frame.stamp_ns);
    recorded.sensor_from_box =
        sensor_from_world * world_from_object * Eigen::Translation3d(bounds_m.center());
    if (object.moves && frame.duration_ns > 0) {
      const Vector3 way_m = world.WorldFromObject(i, end_ns) * bounds_m.center() -
                            world_from_object * bounds_m.center();
      recorded.velocity_world_mps = way_m / SecondsFromNs(frame.duration_ns);
    }
    objects.push_back(std::move(recorded));
  }
  return objects;
}

void Frames::UseScenario(const ScenarioSpec& scenario) {
  if (info_.scenario) {
    if (IdentityOf(*info_.scenario) == IdentityOf(scenario)) return;
    throw InputError(ShownPath(info_.source) +
                     ": has a scenario of its own: --scenario must be the same or be left out");
  }
  world_ = MakeWorld(scenario);
  info_.scenario = scenario;
  info_.labels = LabelTable(scenario.labels);
  if (info_.has_kitti_labels) info_.labels = SemanticKittiLabels(info_.labels);
  info_.materials.clear();
  const MaterialLibrary library(scenario.materials);
  for (const Material& material : library.materials()) info_.materials.push_back(material.name);
}

std::shared_ptr<const ShownFrame> Frames::Shown(RecordedFrame recorded) const {
  if (world_ && recorded.has_pose && recorded.objects.empty()) {
    recorded.objects = ObjectsAt(*world_, LabelTable(info_.scenario->labels), recorded.frame);
  }
  return std::make_shared<const ShownFrame>(MakeShownFrame(std::move(recorded)));
}

LabelTable LabelsOf(const RecordingInfo& info) {
  if (!info.labels.labels().empty()) return info.labels;
  if (!info.has_kitti_labels) return FindLabels(info.source, 1);
  return SemanticKittiLabels(FindLabels(info.source, 3));
}

FrameCounter::FrameCounter(std::filesystem::path source)
    : thread_([this, source = std::move(source)](const std::stop_token& stop) {
        Count(source, stop);
      }) {}

void FrameCounter::Count(const std::filesystem::path& source, const std::stop_token& stop) {
  try {
    const auto recording = OpenRecording(source);
    while (!stop.stop_requested() && recording->Next()) ++num_counted_;
  } catch (const InputError&) {
    // The error is reported when that frame is asked for.
  }
}

RecordedFrames::RecordedFrames(const std::filesystem::path& source)
    : recording_(OpenRecording(source)), pictures_(source) {
  info_ = recording_->info();
  info_.labels = LabelsOf(info_);
  num_passed_ = info_.num_frames.value_or(0);
  if (!info_.num_frames) counter_.emplace(source);
}

std::size_t RecordedFrames::num_known() const {
  return counter_ ? std::max(num_passed_, counter_->num_counted()) : num_passed_;
}

void RecordedFrames::Reopen() {
  recording_ = OpenRecording(info_.source);
  readers_.clear();
  first_reader_ = 0;
}

bool RecordedFrames::Advance() {
  auto reader = recording_->Next();
  if (!reader) {
    is_end_known_ = true;
    num_passed_ = first_reader_ + readers_.size();
    return false;
  }
  readers_.push_back(std::move(*reader));
  const bool holds_data = info_.kind.starts_with("capture") || info_.kind.starts_with("bag");
  if (readers_.size() > (holds_data ? kMaxTurns : kMaxReaders)) {
    readers_.pop_front();
    ++first_reader_;
  }
  num_passed_ = std::max(num_passed_, first_reader_ + readers_.size());
  return true;
}

std::shared_ptr<const ShownFrame> RecordedFrames::Get(std::size_t place) {
  if (auto kept = kept_.Use(place)) return kept;
  if (is_end_known_ && place >= num_passed_) return nullptr;
  if (place < first_reader_) Reopen();
  while (first_reader_ + readers_.size() <= place) {
    if (!Advance()) return nullptr;
  }
  auto shown = Shown(readers_[place - first_reader_]());
  kept_.Put(place, shown);
  return shown;
}

std::size_t RecordedFrames::PlaceOf(std::uint32_t frame_index) {
  const auto fail = [&](const std::string& what) -> std::size_t {
    throw InputError(ShownPath(info_.source) + ": has no frame " + NumberText(frame_index) +
                     " (it has " + what + ")");
  };
  const auto index_at = [&](std::size_t place) { return Get(place)->frame().index; };
  if (!Get(0)) return fail("none");
  const std::uint32_t first_index = index_at(0);
  if (frame_index >= first_index) {
    // Indices rise, by more than 1 where a stream lost frames, so that the frame cannot be at a
    // later place.
    std::size_t place = frame_index - first_index;
    if (!Get(place)) {
      SeekEnd();
      place = num_passed_ - 1;
    }
    if (index_at(place) > frame_index) {
      place = *std::ranges::partition_point(
          std::views::iota(std::size_t{0}, place),
          [&](std::size_t earlier) { return index_at(earlier) < frame_index; });
    }
    if (index_at(place) == frame_index) return place;
  }
  SeekEnd();
  return fail(NumberText(first_index) + " to " + NumberText(index_at(num_passed_ - 1)));
}

void RecordedFrames::SeekEnd() {
  while (!is_end_known_) Advance();
}

}  // namespace railcast
