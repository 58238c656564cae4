#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/io/run/dataset_files.h"
#include "core/recipe/recipe.h"
#include "core/recipe/split_quota.h"
#include "core/scenario/json_text.h"
#include "generator/dataset/indexed_scenario.h"

namespace railcast {

/// Counts what the scenarios of a data set are, which is known before any frame is made.
class ScenarioReport {
 public:
  /// @param record What scenarios.jsonl says of a scenario (DrawnScenario).
  void Add(const Json& record);

  /// The members `weathers` and `drawn` of report.json.
  [[nodiscard]] Json Weathers() const { return weathers_; }
  [[nodiscard]] Json Drawn() const { return drawn_; }
  /// report.json of scenarios without frames: parts, bases, weathers, words drawn, objects placed.
  [[nodiscard]] Json Write(const SplitSpec& split) const;
  /// The same for readers.
  [[nodiscard]] std::string Text(const SplitSpec& split) const;

 private:
  using Counts = std::map<std::string, std::uint64_t>;

  PerPart<std::uint32_t> parts_{};
  Counts bases_;
  Counts weathers_;
  Counts placed_;                        ///< Objects, by their names in the recipe.
  std::map<std::string, Counts> drawn_;  ///< Words, by draw.
};

/// A line for each part: "train   17 scenarios, 70.8 % (asked for: 70.0 %)".
[[nodiscard]] std::string PartsText(const PerPart<std::uint32_t>& parts, const SplitSpec& split);

/// Counts what a data set holds: balance of the classes, objects by distance and occlusion,
/// weathers, frames that are the same or hold nothing.
class DatasetReport {
 public:
  void Add(const IndexedScenario& scenario);

  /// report.json.
  [[nodiscard]] Json Write();

 private:
  struct PerSplit {
    std::uint64_t scenarios{};
    std::uint64_t frames{};
    std::uint64_t points{};
  };
  /// Of one type of object.
  struct PerType {
    std::uint64_t objects{};
    std::uint64_t in_frames{};  ///< Objects, counted in each frame.
    std::uint64_t with_points{};
    std::uint64_t points{};
    std::array<std::uint64_t, kNumDistanceBins> by_distance{};
    std::array<std::uint64_t, kNumDistanceBins> points_by_distance{};
    std::array<std::uint64_t, kNumOcclusionBins> by_occlusion{};  ///< Last: not visible even alone.
  };
  void AddFrame(const IndexedFrame& frame, PerSplit& split);
  void AddObject(const IndexedObject& object);
  [[nodiscard]] std::uint64_t NumDuplicates();

  std::map<std::string, PerSplit> splits_;
  std::map<std::string, std::uint64_t> frames_by_base_;
  std::map<std::string, std::uint64_t> frames_by_sensor_;
  ScenarioReport scenarios_;
  FrameCounts counts_;
  std::map<std::string, std::uint64_t> frames_with_label_;
  std::map<std::string, PerType> types_;
  /// One for each frame that has files, of the hashes of its files: of 10 million frames, two that
  /// differ have the same with a probability of 3e-6.
  std::vector<std::uint64_t> frame_hashes_;
  std::uint64_t num_frames_ = 0;
  std::uint64_t frames_without_points_ = 0;
  std::uint64_t frames_without_objects_ = 0;
};

}  // namespace railcast
