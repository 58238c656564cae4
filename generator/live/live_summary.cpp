#include "generator/live/live_summary.h"

#include <iomanip>
#include <sstream>
#include <string_view>

#include "core/base/units.h"

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

}  // namespace

std::string LiveSummary(const std::vector<LiveRecord>& records,
                        const std::vector<UdpSender::Counts>& delivered,
                        bool has_times) {
  std::ostringstream text;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const LiveRecord& record = records[i];
    text << record.name << ": " << record.frames << (record.frames == 1 ? " frame" : " frames")
         << ", " << record.late_frames << " late; " << record.sent.datagrams << " datagrams, "
         << record.sent.bytes << " bytes; to receivers " << delivered[i].sent << " sent, "
         << delivered[i].refused << " refused\n";
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

std::string LiveProgress(std::int64_t stamp_ns, std::uint64_t frames, std::uint64_t late_frames) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << SecondsFromNs(stamp_ns) << " s, " << frames
       << (frames == 1 ? " frame" : " frames") << ", " << late_frames << " late";
  return text.str();
}

}  // namespace railcast
