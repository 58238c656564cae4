#include "generator/live/live_summary.h"

#include <iomanip>
#include <sstream>
#include <string_view>

#include "core/base/units.h"
#include "generator/live/lag_report.h"

namespace railcast {
namespace {

constexpr double kNsPerMs = 1e6;
constexpr int kHeadWidth = 10;
constexpr int kNumberWidth = 10;

void PutQuantiles(std::string_view head, const DurationHistogram& times, std::ostream& text) {
  text << "  " << std::left << std::setw(kHeadWidth) << head << std::right << std::fixed
       << std::setprecision(3);
  for (const double fraction : {0.5, 0.95, 0.99}) {
    text << std::setw(kNumberWidth) << static_cast<double>(times.QuantileNs(fraction)) / kNsPerMs;
  }
  text << std::setw(kNumberWidth) << static_cast<double>(times.max_ns()) / kNsPerMs << " ms\n";
}

// Empty where no frame was dropped.
std::string DroppedText(std::uint64_t num_dropped) {
  return num_dropped > 0 ? ", " + std::to_string(num_dropped) + " dropped" : "";
}

}  // namespace

std::string LiveSummary(const std::vector<LiveRecord>& records,
                        const std::vector<UdpSender::Counts>& delivered,
                        bool has_times) {
  std::ostringstream text;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const LiveRecord& record = records[i];
    text << record.name << ": " << record.frames << (record.frames == 1 ? " frame" : " frames")
         << ", " << record.late_frames << " late" << DroppedText(record.dropped_frames) << "; "
         << record.sent.datagrams << " datagrams, " << record.sent.bytes << " bytes; to receivers "
         << delivered[i].sent << " sent, " << delivered[i].refused << " refused\n";
    if (!has_times) continue;
    text << "  " << std::left << std::setw(kHeadWidth) << "" << std::right;
    for (const std::string_view head : {"p50", "p95", "p99", "max"}) {
      text << std::setw(kNumberWidth) << head;
    }
    text << "\n";
    PutQuantiles("compute", record.compute, text);
    PutQuantiles("send", record.sent.send, text);
    PutQuantiles("lateness", record.sent.lateness, text);
  }
  return text.str();
}

std::string LiveProgress(const RunState& state) {
  std::uint64_t num_late = 0;
  std::uint64_t num_dropped = 0;
  for (const LiveRecord& record : state.records) {
    num_late += record.late_frames;
    num_dropped += record.dropped_frames;
  }
  const std::uint64_t frames = state.records.front().frames;
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << SecondsFromNs(state.stamp_ns) << " s, " << frames
       << (frames == 1 ? " frame" : " frames") << ", " << num_late << " late"
       << DroppedText(num_dropped);
  if (state.behind_ns >= LagReport::kLag_ns) {
    text << ", " << SecondsFromNs(state.behind_ns) << " s behind";
  }
  return text.str();
}

}  // namespace railcast
