#include "viewer/composition/status_text.h"

#include <array>
#include <cstdio>

#include "core/base/text.h"
#include "core/io/recording/firing_truth.h"

namespace railcast {
namespace {

/// Number of a frame's firings by what became of them.
struct FiringCounts {
  std::uint64_t on_surfaces{};  ///< Firings whose surface is known.
  /// Firings on surfaces without a point, by cause.
  std::array<std::uint64_t, kOutcomeNames.size()> lost{};
  std::uint64_t clutter{};
};

FiringCounts CountFirings(const Frame& frame) {
  FiringCounts counts;
  for (std::size_t slot = 0; slot < frame.num_slots(); slot += frame.returns) {
    const Outcome outcome = frame.outcome[slot];
    counts.clutter += outcome == Outcome::kClutter;
    if (!KnowsSurface(frame, slot)) continue;
    ++counts.on_surfaces;
    if (outcome != Outcome::kReturned) ++counts.lost[static_cast<std::size_t>(outcome)];
  }
  return counts;
}

std::string Format(const char* format, double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

}  // namespace

std::string GroupedDigits(std::uint64_t number) {
  const std::string digits = NumberText(number);
  std::string grouped;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) grouped += ',';
    grouped += digits[i];
  }
  return grouped;
}

std::string FrameText(const ShownFrame& shown) {
  std::string text = "frame ";
  text += NumberText(shown.frame().index);
  if (shown.frame().stamp_ns != 0 || shown.recorded->has_pose) {
    text += Format("   %.3f s", 1e-9 * static_cast<double>(shown.frame().stamp_ns));
  }
  text += "   ";
  text += GroupedDigits(shown.num_points());
  return text + " points";
}

std::string AccumulatedText(const Composition& composition) {
  if (composition.clouds.size() < 2) return {};
  std::uint64_t num_points = 0;
  for (const PlacedCloud& cloud : composition.clouds) num_points += cloud.shown->num_points();
  std::string text = "with ";
  text += NumberText(composition.clouds.size() - 1);
  text += " frames before it   ";
  text += GroupedDigits(num_points);
  return text + " points";
}

std::string DropoutText(const RecordedFrame& recorded) {
  if (!HasOutcomes(recorded) || !recorded.Has("true_range_m")) return {};
  const FiringCounts counts = CountFirings(recorded.frame);
  std::uint64_t num_lost = 0;
  std::string causes;
  const auto percent = [&](std::uint64_t count) {
    return 100.0 * static_cast<double>(count) / static_cast<double>(counts.on_surfaces);
  };
  for (std::size_t i = 0; i < counts.lost.size(); ++i) {
    if (counts.lost[i] == 0) continue;
    num_lost += counts.lost[i];
    causes += causes.empty() ? " (" : ", ";
    causes += kOutcomeNames[i];
    causes += Format(" %.1f", percent(counts.lost[i]));
  }
  if (!causes.empty()) causes += ")";
  std::string text = counts.on_surfaces == 0 ? std::string("no firing met a surface")
                                             : Format("dropout %.1f %%", percent(num_lost));
  text += causes;
  if (counts.clutter > 0) {
    text += "   clutter ";
    text += GroupedDigits(counts.clutter);
  }
  return text;
}

std::string SelectionText(const ShownFrame& shown,
                          const std::set<std::uint32_t>& labels,
                          const LabelTable& table) {
  if (labels.empty()) return {};
  std::string text = "selected ";
  for (const std::uint32_t id : labels) {
    const Label* const label = table.Find(id);
    if (id != *labels.begin()) text += ", ";
    text += label != nullptr ? label->name : "label " + NumberText(id);
  }
  std::uint64_t num_points = 0;
  for (const std::uint32_t slot : shown.slots) {
    num_points += labels.contains(shown.frame().label[slot]);
  }
  text += ": ";
  text += GroupedDigits(num_points);
  return text + " points";
}

}  // namespace railcast
