#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/io/run/dataset_files.h"
#include "core/scenario/json_text.h"
#include "generator/dataset/indexed_scenario.h"
#include "generator/dataset/scenario_report.h"

namespace railcast {

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
