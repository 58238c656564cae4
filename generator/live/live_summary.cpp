#include "generator/live/live_summary.h"

#include <nlohmann/json.hpp>

#include <iomanip>
#include <sstream>
#include <string_view>

#include "core/base/units.h"
#include "core/io/record/record_text.h"

namespace railcast {
namespace {

using Json = nlohmann::ordered_json;

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

Json Times(const DurationHistogram& times) {
  return {{"p50", static_cast<double>(times.QuantileNs(0.5)) / kNsPerMs},
          {"p95", static_cast<double>(times.QuantileNs(0.95)) / kNsPerMs},
          {"p99", static_cast<double>(times.QuantileNs(0.99)) / kNsPerMs},
          {"max", static_cast<double>(times.max_ns()) / kNsPerMs}};
}

void PutTimes(const LiveRecord& record, std::ostream& text) {
  text << "  " << std::left << std::setw(kHeadWidth) << "" << std::right;
  for (const std::string_view head : {"p50", "p95", "p99", "max"}) {
    text << std::setw(kNumberWidth) << head;
  }
  text << "\n";
  PutQuantiles("compute", record.compute, text);
  PutQuantiles("send", record.sent.send, text);
  PutQuantiles("lateness", record.sent.lateness, text);
  if (record.uncertified_frames) PutQuantiles("certify", record.certify, text);
}

struct FrameTotals {
  std::uint64_t num_made{};
  std::uint64_t num_late{};
  std::uint64_t num_dropped{};
};

FrameTotals FramesOfAll(const std::vector<LiveRecord>& records) {
  FrameTotals counts;
  for (const LiveRecord& record : records) {
    counts.num_made += record.frames;
    counts.num_late += record.late_frames;
    counts.num_dropped += record.dropped_frames;
  }
  return counts;
}

// Empty where no frame was dropped.
std::string DroppedText(std::uint64_t num_dropped) {
  return num_dropped > 0 ? ", " + std::to_string(num_dropped) + " dropped" : "";
}

}  // namespace

std::optional<std::string> LagReport::After(const RunState& state) {
  const auto [num_made, num_late, num_dropped] = FramesOfAll(state.records);
  const bool keeps_up = drops_late_ ? num_dropped == num_dropped_ : state.behind_ns < kLag_ns;
  if (keeps_up) return std::nullopt;
  if (said_ns_ && state.now_ns - *said_ns_ < kPause_ns) return std::nullopt;
  said_ns_ = state.now_ns;
  num_dropped_ = num_dropped;
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << "cannot keep up: ";
  if (drops_late_) {
    text << num_dropped << " of " << num_made + num_dropped << " frames dropped after "
         << SecondsFromNs(state.stamp_ns) << " s";
  } else {
    text << SecondsFromNs(state.behind_ns) << " s behind after " << SecondsFromNs(state.stamp_ns)
         << " s, " << num_late << " of " << num_made
         << " frames late; --drop-late drops frames instead";
  }
  return text.str();
}

std::string LiveSummary(const std::vector<LiveRecord>& records,
                        const std::vector<UdpSender::Counts>& delivered,
                        bool has_times) {
  std::ostringstream text;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const LiveRecord& record = records[i];
    if (!record.name.empty()) text << record.name << ": ";
    text << record.frames << (record.frames == 1 ? " frame" : " frames") << ", "
         << record.late_frames << " late" << DroppedText(record.dropped_frames) << "; "
         << record.sent.datagrams << " " << record.sends << ", " << record.sent.bytes
         << " bytes; to receivers " << delivered[i].sent << " sent, " << delivered[i].refused
         << " refused\n";
    if (has_times) PutTimes(record, text);
    if (record.certificate) text << CertificateText(*record.certificate);
    if (!record.uncertified_frames) continue;
    text << "  " << *record.uncertified_frames << " of " << record.frames
         << " frames were not certified for want of time\n";
  }
  return text.str();
}

std::string LiveSummaryJson(std::string_view command,
                            const LiveResult& result,
                            const std::vector<UdpSender::Counts>& delivered,
                            const std::vector<std::string>& capture_faults,
                            bool has_times) {
  Json sensors = Json::array();
  for (std::size_t i = 0; i < result.records.size(); ++i) {
    const LiveRecord& record = result.records[i];
    const auto times = [&](const DurationHistogram& of) { return has_times ? Times(of) : Json(); };
    sensors.push_back({{"name", record.name},
                       {"frames", record.frames},
                       {"late_frames", record.late_frames},
                       {"dropped_frames", record.dropped_frames},
                       {std::string(record.sends), record.sent.datagrams},
                       {"bytes", record.sent.bytes},
                       {"sent_to_receivers", delivered[i].sent},
                       {"refused", delivered[i].refused},
                       {"compute_ms", times(record.compute)},
                       {"send_ms", times(record.sent.send)},
                       {"lateness_ms", times(record.sent.lateness)}});
    if (!record.uncertified_frames) continue;
    sensors.back()["certify_ms"] = times(record.certify);
    sensors.back()["uncertified_frames"] = *record.uncertified_frames;
    if (record.certificate) {
      sensors.back()["certificate"] = Json::parse(RecordText(*record.certificate));
    }
  }
  const auto json = [](const auto& fault) { return fault ? Json(*fault) : Json(); };
  const Json summary = {{"command", command},
                        {"sensors", sensors},
                        {"capture_faults", capture_faults},
                        {"log_fault", json(result.log_fault)},
                        {"fault", json(result.fault)}};
  return summary.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string LateText(const std::vector<LiveRecord>& records) {
  const auto [num_frames, num_late, num_dropped] = FramesOfAll(records);
  if (num_late + num_dropped == 0) return "";
  return std::to_string(num_late) + " of " + std::to_string(num_frames) + " frames late" +
         DroppedText(num_dropped);
}

std::string LiveProgress(const RunState& state) {
  const auto [num_made, num_late, num_dropped] = FramesOfAll(state.records);
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
