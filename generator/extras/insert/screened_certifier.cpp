#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

#include "core/certify/rungs_beside.h"
#include "core/fidelity/effect_search.h"
#include "generator/extras/insert/screened_scan.h"

namespace railcast {
namespace {

constexpr float kNoRange_m = std::numeric_limits<float>::quiet_NaN();

// What reading, editing and writing a firing takes: counted by callgrind on frames of a VLP-16 in
// PCD into which persons and a box are put, at 10 and 20 turns a second, less what is traced.
constexpr double kInstructionsOfEditing = 2'400.0;

std::uint32_t CellOf(const ScanPattern& pattern, std::size_t firing) {
  return pattern.row[firing] * pattern.columns + pattern.column[firing];
}

/// Puts what a firing returns now into a frame that has a column for each drawn firing.
class DrawnFrame {
 public:
  DrawnFrame(Frame& frame, std::uint32_t num_firings, std::uint32_t returns) : frame_(frame) {
    frame_.Resize(1, num_firings, returns);
    std::ranges::fill(frame_.outcome, Outcome::kNoSurface);
  }
  void PutRecorded(std::size_t column, const RecordedScan& recorded, std::uint32_t firing) {
    std::size_t slot = column * frame_.returns;
    for (std::uint32_t k = recorded.first[firing]; k < recorded.first[firing + 1]; ++k) {
      PutScreen(slot++, recorded.returns[k]);
    }
  }
  void PutChanged(std::size_t column, const RecordedScan& recorded, const ChangedFiring& changed) {
    std::size_t slot = column * frame_.returns;
    for (const ReturnNow& now : changed.returns) {
      if (!now.is_added) {
        PutScreen(slot++, recorded.returns[now.screen]);
        continue;
      }
      frame_.outcome[slot] = now.outcome;
      frame_.range_m[slot] = now.range_m;
      frame_.true_range_m[slot] = now.true_range_m;
      frame_.power_ratio[slot] = now.power_ratio;
      // For one echo with a recorded return, neither is known.
      frame_.label[slot] = now.screen == kNoScreen ? now.label : 0;
      frame_.instance[slot] = now.screen == kNoScreen ? now.instance : 0;
      ++slot;
    }
  }

 private:
  void PutScreen(std::size_t slot, const Screen& screen) {
    frame_.outcome[slot] = Outcome::kReturned;
    frame_.range_m[slot] = screen.range_m;
    frame_.true_range_m[slot] = screen.range_m;
    frame_.power_ratio[slot] = kNoRange_m;
  }

  Frame& frame_;
};

/// Fills a frame for each variant with what its firings return.
/// @param firings Of its columns.
void FillFrames(const RecordedScan& recorded,
                const std::vector<std::uint32_t>& firings,
                const std::vector<std::vector<ChangedFiring>>& changed,
                std::span<Frame> frames) {
  std::vector<bool> is_changed(recorded.pattern.num_firings());
  std::size_t most = 1;
  for (const std::vector<ChangedFiring>& of_variant : changed) {
    for (const ChangedFiring& firing : of_variant) {
      is_changed[firing.firing] = true;
      most = std::max(most, firing.returns.size());
    }
  }
  for (const std::uint32_t i : firings) {
    most = std::max(most, std::size_t{recorded.first[i + 1]} - recorded.first[i]);
  }
  for (std::size_t v = 0; v < frames.size(); ++v) {
    DrawnFrame drawn(frames[v], static_cast<std::uint32_t>(firings.size()),
                     static_cast<std::uint32_t>(most));
    for (std::size_t column = 0; column < firings.size(); ++column) {
      const std::uint32_t i = firings[column];
      const auto now = std::ranges::lower_bound(changed[v], i, {}, &ChangedFiring::firing);
      if (now != changed[v].end() && now->firing == i) {
        drawn.PutChanged(column, recorded, *now);
      } else if (is_changed[i]) {
        drawn.PutRecorded(column, recorded, i);
      }
    }
  }
}

}  // namespace

ScreenedCertifier::ScreenedCertifier(const ScenarioSpec& scenario,
                                     double cost_share,
                                     const DetectorSpec& own,
                                     const World& world)
    : certifier_(scenario, cost_share, own, 1, world),
      cost_of_others_(kInstructionsOfEditing /
                      InstructionsPerFiring(own.effects, scenario.lidar.beam)) {}

void ScreenedCertifier::FillGrid(const RecordedScan& recorded,
                                 const ScreenedFrame& made,
                                 std::span<const std::uint32_t> near) {
  const ScanPattern& pattern = recorded.pattern;
  grid_.index = recorded.index;
  // Only the cells that the last frame filled are emptied: they are few of many.
  if (grid_.rows != pattern.rows || grid_.columns != pattern.columns) {
    grid_.Resize(pattern.rows, pattern.columns, 1);
    filled_.resize(grid_.num_slots());
    std::iota(filled_.begin(), filled_.end(), 0U);
  }
  for (const std::uint32_t cell : filled_) {
    grid_.label[cell] = 0;
    grid_.instance[cell] = 0;
    grid_.true_range_m[cell] = kNoRange_m;
    grid_.mixed_share[cell] = 0.0F;
    grid_.outcome[cell] = Outcome::kNoSurface;
  }
  filled_.clear();
  for (const std::uint32_t i : near) {
    if (recorded.first[i] == recorded.first[i + 1]) continue;
    filled_.push_back(CellOf(pattern, i));
    grid_.outcome[filled_.back()] = Outcome::kReturned;
  }
  for (const ChangedFiring& firing : made.firings) {
    const std::uint32_t cell = filled_.emplace_back(CellOf(pattern, firing.firing));
    grid_.mixed_share[cell] = firing.mixed_share;
    grid_.outcome[cell] = firing.returns.empty() ? firing.outcome : Outcome::kReturned;
    const auto of_object = std::ranges::find_if(
        firing.returns, [](const ReturnNow& now) { return now.is_added && now.instance != 0; });
    if (of_object == firing.returns.end()) continue;
    grid_.label[cell] = of_object->label;
    grid_.instance[cell] = of_object->instance;
    grid_.true_range_m[cell] = of_object->true_range_m;
  }
}

FrameCertificate ScreenedCertifier::Certify(const RecordedScan& recorded,
                                            const ScreenedFrame& made,
                                            std::span<const std::uint32_t> near,
                                            const ScreenedScan::MakeAnew& make) {
  if (near.empty()) return {};
  FillGrid(recorded, made, near);
  const ScanPattern& pattern = recorded.pattern;
  CertifiedRegion region;
  std::map<std::uint32_t, std::uint32_t> firing_of;
  for (const std::uint32_t i : near) firing_of[CellOf(pattern, i)] = i;
  for (const auto& [cell, firing] : firing_of) region.cells.push_back(cell);
  region.num_wanted =
      certifier_.num_expected() * (static_cast<double>(near.size()) +
                                   cost_of_others_ * static_cast<double>(pattern.num_firings()));
  const auto scan = [&](std::span<const std::uint32_t> cells, std::span<Frame> frames) {
    std::vector<std::uint32_t> firings;
    for (const std::uint32_t cell : cells) firings.push_back(firing_of.at(cell));
    FillFrames(recorded, firings, make(firings), frames);
  };
  return certifier_.Certify(grid_, &region, scan);
}

}  // namespace railcast
