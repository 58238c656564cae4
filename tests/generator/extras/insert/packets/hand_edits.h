#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <vector>

#include "generator/extras/insert/inserted_frame.h"
#include "generator/extras/insert/packets/packet_outputs.h"
#include "generator/extras/insert/recorded_firings.h"
#include "railcast/io/recording.h"

namespace railcast {

/// What becomes of a recorded frame.
using EditFrame = std::function<InsertedFrame(const RecordedFrame&)>;

[[nodiscard]] inline InsertedFrame WithoutEdits(const RecordedFrame& recorded) {
  return {.recorded = recorded, .edits = {}, .objects = {}};
}

/// Copies a recording into a folder with edits of its frames and returns these.
inline std::vector<InsertedFrame> CopyWithEdits(const std::filesystem::path& source,
                                                const std::filesystem::path& folder,
                                                const EditFrame& edit) {
  std::filesystem::create_directories(folder);
  const auto recording = OpenRecording(source);
  const auto output = MakeCopyOutput(source, folder);
  std::vector<InsertedFrame> frames;
  while (const auto read = recording->Next()) {
    RecordedFirings firings;
    firings.recorded = (*read)();
    frames.push_back(edit(firings.recorded));
    output->Write(firings, frames.back());
  }
  output->Finish();
  return frames;
}

/// A firing's returns while they are edited by hand.
class HandEdit {
 public:
  explicit HandEdit(const RecordedFrame& recorded) : inserted_(WithoutEdits(recorded)) {}

  /// Takes the return of a slot away.
  void Remove(std::uint32_t slot) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    Put(slot, kNaN, kNaN);
    inserted_.edits.push_back(
        {.slot = slot, .from_slot = {}, .had_point = true, .has_point = false});
  }
  void Weaken(std::uint32_t slot, float intensity) {
    Put(slot, frame().range_m[slot], intensity);
    inserted_.edits.push_back(
        {.slot = slot, .from_slot = slot, .is_weaker = true, .had_point = true, .has_point = true});
  }
  void Add(std::uint32_t slot, float range_m, float intensity) {
    const bool had_point = !std::isnan(frame().range_m[slot]);
    Put(slot, range_m, intensity);
    inserted_.edits.push_back({.slot = slot,
                               .from_slot = {},
                               .had_point = had_point,
                               .has_point = true,
                               .is_added = true});
  }
  /// Moves the return of a slot into another one, from which a new one takes its place.
  void MoveBehind(std::uint32_t slot, float range_m, float intensity) {
    const float other_range_m = frame().range_m[slot];
    const float other_intensity = frame().intensity[slot];
    Add(slot, range_m, intensity);
    Put(slot + 1, other_range_m, other_intensity);
    inserted_.edits.push_back(
        {.slot = slot + 1, .from_slot = slot, .had_point = false, .has_point = true});
  }

  [[nodiscard]] InsertedFrame Take() { return std::move(inserted_); }
  [[nodiscard]] const Frame& frame() const { return inserted_.recorded.frame; }

 private:
  void Put(std::uint32_t slot, float range_m, float intensity) {
    inserted_.recorded.frame.range_m[slot] = range_m;
    inserted_.recorded.frame.intensity[slot] = intensity;
  }

  InsertedFrame inserted_;
};

/// Edits of all kinds in every 11th firing of a frame. In frames with two returns, the first one is
/// farther if both are there.
[[nodiscard]] inline InsertedFrame EditedByHand(const RecordedFrame& recorded) {
  HandEdit edit(recorded);
  const Frame& frame = edit.frame();
  for (std::uint32_t cell = 0; cell < frame.num_slots() / frame.returns; cell += 11) {
    const std::uint32_t slot = cell * frame.returns;
    const bool has_first = !std::isnan(frame.range_m[slot]);
    const bool has_second = frame.returns == 2 && !std::isnan(frame.range_m[slot + 1]);
    if (!has_first) {
      if (!has_second) edit.Add(slot, 21.5F, 0.37F);
    } else if (has_second) {
      // The lone return left is the recorded first, weaker or as it was.
      if (cell % 2 == 0) edit.Weaken(slot, 0.02F);
      edit.Remove(slot + 1);
    } else if (frame.returns == 2 && cell % 3 == 0 && frame.range_m[slot] < 90.0F) {
      edit.MoveBehind(slot, 100.0F, 0.61F);
    } else if (cell % 3 == 1) {
      edit.Remove(slot);
    } else {
      edit.Weaken(slot, 0.02F);
    }
  }
  return edit.Take();
}

}  // namespace railcast
