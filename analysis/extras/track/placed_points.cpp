#include <array>
#include <cmath>
#include <limits>

#include "analysis/extras/track/track_report.h"
#include "analysis/report/words.h"
#include "core/base/text.h"
#include "core/io/run/camera_files.h"
#include "core/io/run/sequence_files.h"
#include "core/io/write_file.h"
#include "core/track/track_points.h"

namespace railcast {
namespace {

constexpr const char* kPointType =
    "[('ahead_m', '<f4'), ('track_lateral_m', '<f4'), ('track_height_m', '<f4'), "
    "('in_gauge', '|u1'), ('in_clear_space', '|u1')]";

std::string NpyOf(const std::vector<PointByTrack>& places) {
  std::string bytes = NpyHeader(kPointType, "(" + NumberText(places.size()) + ",)");
  for (const PointByTrack& place : places) {
    const std::array<float, 3> figures = {place.ahead_m, place.lateral_m, place.height_m};
    bytes.append(reinterpret_cast<const char*>(figures.data()), sizeof figures);
    bytes += place.is_in_gauge ? '\1' : '\0';
    bytes += place.is_in_clear_space ? '\1' : '\0';
  }
  return bytes;
}

/// The places of a file's points in its own order; those of a capture by slots.
std::vector<PointByTrack> InOrderOfFile(const std::vector<PointByTrack>& places,
                                        const std::vector<std::uint32_t>& slot_of_entry) {
  if (slot_of_entry.empty()) return places;
  std::vector<PointByTrack> ordered;
  for (const std::uint32_t slot : slot_of_entry)
    ordered.push_back(slot == kNoSlot ? PointByTrack{} : places[slot]);
  return ordered;
}

/// What is in the way in a frame. Noise puts points of the heads above them, so that lower ones do
/// not count.
struct InTheWay {
  std::uint64_t num_in_clear_space{}, num_in_gauge{};
  double nearest_m = std::numeric_limits<double>::quiet_NaN();

  explicit InTheWay(const std::vector<PointByTrack>& places) {
    constexpr float kLeastHeight_m = 0.1F;
    for (const PointByTrack& place : places) {
      if (!(place.height_m >= kLeastHeight_m)) continue;
      num_in_clear_space += place.is_in_clear_space ? 1U : 0U;
      if (!place.is_in_gauge) continue;
      ++num_in_gauge;
      const double ahead_m = place.ahead_m;
      if (!(std::abs(ahead_m) >= std::abs(nearest_m))) nearest_m = ahead_m;
    }
  }
};

std::filesystem::path FileOf(const std::filesystem::path& folder, std::size_t frame) {
  return folder / (FrameDigits(static_cast<std::uint32_t>(frame)) + ".npy");
}

}  // namespace

void RemovePlacedPoints(const std::filesystem::path& folder, std::size_t first) {
  for (std::size_t i = first; remove(FileOf(folder, i)); ++i) {
  }
}

Section PlaceRecordedPoints(const TrackSurvey& survey,
                            Recording& recording,
                            const std::filesystem::path& folder,
                            const std::function<void(std::size_t)>& on_progress) {
  create_directories(folder);
  Table table = TableOf(kTrackWords, "in_the_way");
  for (std::size_t i = 0; i < survey.frames.size(); ++i) {
    const auto reader = recording.Next();
    if (!reader) break;  // Files were taken away meanwhile.
    const RecordedFrame recorded = (*reader)();
    const TracksOfFrame& of = survey.frames[i];
    const FoundTrack* const track = of.track();
    std::vector<PointByTrack> places(recorded.frame.num_slots());
    if (track != nullptr) {
      places = PlacePoints(recorded, *track, of.cant_m);
      const InTheWay way(places);
      table.rows.push_back({std::uint64_t{i}, track->KnownFor_m(kMostTrackMargin_m),
                            way.num_in_clear_space, way.num_in_gauge, way.nearest_m});
    }
    WriteFileWhole(FileOf(folder, i), NpyOf(InOrderOfFile(places, recorded.slot_of_entry)));
    on_progress(i + 1);
  }
  Section section = SectionOf(kTrackWords, "points", {{"margin_m", ShortText(kMostTrackMargin_m)}});
  section.tables = {std::move(table)};
  return section;
}

}  // namespace railcast
