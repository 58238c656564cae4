#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <map>
#include <string_view>
#include <utility>

#include "analysis/estimate/estimate.h"
#include "analysis/inspect/inspection.h"
#include "analysis/report/cell_text.h"
#include "core/base/median.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/content_hash.h"
#include "core/points/level_areas.h"

namespace railcast {
namespace {

std::uint64_t NumDoubled(const Frame& frame) {
  std::vector<std::array<std::uint32_t, 3>> places;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (std::isnan(frame.x[i])) continue;
    places.push_back({std::bit_cast<std::uint32_t>(frame.x[i]),
                      std::bit_cast<std::uint32_t>(frame.y[i]),
                      std::bit_cast<std::uint32_t>(frame.z[i])});
  }
  std::ranges::sort(places);
  return static_cast<std::uint64_t>(std::ranges::distance(std::ranges::unique(places)));
}

std::uint64_t NumMissing(const RecordedFrame& recorded) {
  return static_cast<std::uint64_t>(std::ranges::count_if(
      recorded.slot_of_entry,
      [&](std::uint32_t slot) { return slot == kNoSlot || std::isnan(recorded.frame.x[slot]); }));
}

std::uint64_t HashOf(const Frame& frame) {
  std::string hashes;
  for (const std::vector<float>* const values : {&frame.x, &frame.y, &frame.z, &frame.intensity}) {
    hashes += ContentHash(std::string_view(reinterpret_cast<const char*>(values->data()),
                                           values->size() * sizeof(float)));
  }
  return ContentHashNumber(hashes);
}

double HeightOf_m(const RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  std::vector<Eigen::Vector3f> points_m;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (!std::isnan(frame.x[i])) points_m.emplace_back(frame.x[i], frame.y[i], frame.z[i]);
  }
  const GroundBelow ground = FindGroundBelow(points_m);
  return ground.is_found ? ground.below_m : std::nan("");
}

/// A figure of frames, as odd values of it are told.
struct FrameFigure {
  std::function<double(const InspectedFrame&)> value;
  std::string what{};  ///< "points".
  /// What differs by less is not odd; 0: less than a tenth, or than chance does.
  double least_off{};
  bool is_length = false;  ///< In m, rather than a number.
};

void JudgeFigure(const FrameFigure& figure, std::vector<InspectedFrame>& frames) {
  constexpr double kMost = 6.0;
  constexpr double kShare = 0.1;
  constexpr double kOfChance = 4.0;
  std::vector<double> values;
  for (const InspectedFrame& frame : frames) {
    if (!std::isnan(figure.value(frame))) values.push_back(figure.value(frame));
  }
  constexpr std::size_t kFewest = 3;
  if (values.size() < kFewest) return;
  const double median = MedianOf(values);
  const double spread = PlainRobustScale(values);
  const double least_off =
      figure.least_off > 0.0
          ? figure.least_off
          : std::max(kShare * median, kOfChance * std::sqrt(std::max(median, 1.0)));
  const double most = std::max(kMost * spread, least_off);
  for (InspectedFrame& frame : frames) {
    const double value = figure.value(frame);
    if (!(std::abs(value - median) > most)) continue;
    const auto text = [&](double of) {
      return figure.is_length ? ShortText(of) + " m"
                              : CountText(static_cast<std::uint64_t>(std::llround(of)));
    };
    frame.odd.push_back("has " + text(value) + " " + figure.what + ", where others have " +
                        text(median));
    frame.has_odd_points = true;
  }
}

void JudgeRings(std::vector<InspectedFrame>& frames) {
  constexpr std::uint64_t kSparse = 20;
  std::vector<double> nums;
  std::vector<std::uint64_t> sparsest;
  for (const InspectedFrame& frame : frames) nums.push_back(static_cast<double>(frame.num_rings));
  const double median = MedianOf(nums);
  for (const InspectedFrame& frame : frames) {
    if (static_cast<double>(frame.num_rings) == median) sparsest.push_back(frame.num_sparsest);
  }
  // Rings that meet hardly anything come and go.
  if (MedianOf(sparsest) < kSparse) return;
  JudgeFigure({.value = [](const InspectedFrame& frame) { return double(frame.num_rings); },
               .what = "rings with points",
               .least_off = 0.5},
              frames);
}

void JudgeGrids(std::vector<InspectedFrame>& frames) {
  const auto num = std::ranges::count(frames, true, &InspectedFrame::is_grid);
  if (2 * static_cast<std::size_t>(num) <= frames.size()) return;
  for (InspectedFrame& frame : frames) {
    if (frame.is_grid) continue;
    frame.odd.emplace_back("is no grid of firings, as others are");
    frame.has_odd_points = true;
  }
}

void JudgeTimes(std::vector<InspectedFrame>& frames) {
  constexpr double kGap = 1.5;
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    steps_s.push_back(SecondsFromNs(frames[i].stamp_ns - frames[i - 1].stamp_ns));
  }
  std::vector<double> sorted_s = steps_s;
  const double median_s = MedianOf(sorted_s);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const double step_s = steps_s[i - 1];
    if (step_s > 0.0 && !(step_s > kGap * median_s)) continue;
    frames[i].odd.push_back("comes " + ShortText(step_s) + " s after the last, where others come " +
                            ShortText(median_s) + " s after theirs");
  }
}

void JudgeCopies(std::vector<InspectedFrame>& frames) {
  std::map<std::uint64_t, std::size_t> first;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].num_points == 0) continue;
    const auto [found, is_new] = first.emplace(frames[i].hash, i);
    if (is_new) continue;
    frames[i].same_as = found->second;
    frames[i].odd.push_back("has the same points as frame " + NumberText(found->second));
  }
}

std::vector<Cell> FrameRow(bool has_stamps,
                           const std::vector<InspectedFrame>& frames,
                           std::size_t i) {
  const InspectedFrame& frame = frames[i];
  std::string odd;
  for (const std::string& each : frame.odd) odd += (odd.empty() ? "" : "; ") + each;
  const double step_s =
      !has_stamps || i == 0 ? std::nan("") : SecondsFromNs(frame.stamp_ns - frames[i - 1].stamp_ns);
  return {NumberText(i),
          odd,
          frame.num_points,
          std::uint64_t{frame.num_rings},
          frame.num_missing,
          frame.num_doubled,
          step_s,
          frame.same_as ? NumberText(*frame.same_as) : std::string(),
          frame.height_m,
          frame.name};
}

}  // namespace

InspectedFrame InspectFrame(const RecordedFrame& recorded, std::vector<std::uint64_t> ring_points) {
  const Frame& frame = recorded.frame;
  InspectedFrame inspected;
  inspected.name = recorded.name;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    inspected.num_points += std::isnan(frame.x[i]) ? 0 : 1;
  }
  inspected.num_doubled = NumDoubled(frame);
  inspected.num_missing = NumMissing(recorded);
  inspected.is_grid = recorded.is_grid;
  inspected.stamp_ns = frame.stamp_ns;
  inspected.hash = HashOf(frame);
  if (recorded.why_no_ranges.empty()) inspected.height_m = HeightOf_m(recorded);
  std::erase(ring_points, 0U);
  if (ring_points.empty()) return inspected;
  constexpr double kLeast = 0.01;
  const double least = kLeast * static_cast<double>(MedianOf(ring_points));
  std::erase_if(ring_points, [&](std::uint64_t num) { return static_cast<double>(num) < least; });
  inspected.num_rings = ring_points.size();
  inspected.num_sparsest = *std::ranges::min_element(ring_points);
  return inspected;
}

void JudgeFrames(bool has_stamps, std::vector<InspectedFrame>& frames) {
  const auto count = [](std::uint64_t InspectedFrame::*member) {
    return [member](const InspectedFrame& frame) { return static_cast<double>(frame.*member); };
  };
  JudgeFigure({.value = count(&InspectedFrame::num_points), .what = "points"}, frames);
  JudgeRings(frames);
  JudgeGrids(frames);
  JudgeFigure({.value = count(&InspectedFrame::num_missing), .what = "points without a position"},
              frames);
  JudgeFigure({.value = count(&InspectedFrame::num_doubled), .what = "doubled points"}, frames);
  constexpr double kLeastOff_m = 0.15;
  JudgeFigure({.value = [](const InspectedFrame& frame) { return frame.height_m; },
               .what = "between sensor and ground",
               .least_off = kLeastOff_m,
               .is_length = true},
              frames);
  if (has_stamps) JudgeTimes(frames);
  JudgeCopies(frames);
}

Section FramesSection(bool has_stamps, const std::vector<InspectedFrame>& frames) {
  constexpr std::size_t kMost = 200;
  Table table{.key = "by_frame", .title = "Frame by frame"};
  table.columns = ColumnsOf(
      "frame: Frame; odd: What is unlike the others; points: Points; rings: Rings with points; "
      "missing: Points without a position; doubled: Doubled points; step_s: Time from the last; "
      "same_as: Same points as frame; height_m: Sensor above ground; name: Name");
  table.is_open = true;
  for (const bool is_odd : {true, false}) {
    for (std::size_t i = 0; i < frames.size() && table.rows.size() < kMost; ++i) {
      if (frames[i].odd.empty() != is_odd) table.rows.push_back(FrameRow(has_stamps, frames, i));
    }
  }
  const auto num_odd = static_cast<std::size_t>(std::ranges::count_if(
      frames, [](const InspectedFrame& frame) { return !frame.odd.empty(); }));
  std::string text = num_odd == 0 ? "No frame is unlike the others."
                                  : CountText(num_odd) + " of " + CountText(frames.size()) +
                                        " frames are unlike the others: they come first.";
  if (num_odd == 1) text = "1 of " + CountText(frames.size()) + " frames is unlike the others.";
  if (frames.size() > kMost) text += " Of all frames, the table has " + CountText(kMost) + ".";
  return {.key = "frames", .title = "Frames", .paragraphs = {text}, .tables = {std::move(table)}};
}

}  // namespace railcast
