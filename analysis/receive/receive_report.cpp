#include "analysis/receive/receive_report.h"

#include <algorithm>
#include <iomanip>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

namespace railcast {
namespace {

using Json = nlohmann::ordered_json;

std::uint64_t PointsEach(const ReceivedTotals& totals) {
  return totals.frames == 0 ? 0 : totals.points / totals.frames;
}

std::string RateText(const ReceivedTotals& totals) {
  if (totals.frames < 2) return "no rate yet";
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << totals.rate_hz() << " Hz";
  return text.str();
}

}  // namespace

double ReceivedTotals::rate_hz() const {
  if (frames < 2) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(frames - 1) / (last_s - first_s);
}

std::string ReceiveProgress(const ReceivedTotals& totals, const StreamReceiver::Counts& counts) {
  std::ostringstream text;
  text << totals.frames << " frames, " << PointsEach(totals) << " points each, " << RateText(totals)
       << ", " << counts.stream.lost_packets << " packets lost";
  return text.str();
}

std::optional<double> ReceivedShare(const ReceivedTotals& totals,
                                    double elapsed_s,
                                    const ReceiveLimits& limits) {
  if (!limits.num_frames && !limits.duration_s) return std::nullopt;
  double share = 0.0;
  if (limits.num_frames) {
    share = static_cast<double>(totals.frames) / static_cast<double>(*limits.num_frames);
  }
  if (limits.duration_s) share = std::max(share, elapsed_s / *limits.duration_s);
  return std::min(1.0, share);
}

std::string ReceiveSummary(const ReceivedTotals& totals, const StreamReceiver::Counts& counts) {
  const StreamCounts& stream = counts.stream;
  std::ostringstream text;
  text << "frames: " << stream.complete_frames << " complete, " << stream.incomplete_frames
       << " incomplete, " << stream.missing_frames << " missing, " << counts.dropped_frames
       << " dropped here; " << RateText(totals) << "\n";
  text << "packets: " << stream.received_packets << " received, " << stream.lost_packets
       << " lost, " << stream.duplicate_packets << " duplicate, " << stream.reordered_packets
       << " reordered, " << stream.late_packets << " late, " << stream.stray_packets << " stray, "
       << stream.num_refused() << " refused\n";
  text << "points: " << totals.points << ", " << PointsEach(totals) << " a frame\n";
  if (stream.other_sender) {
    text << "packets of other senders: " << stream.other_sender_packets
         << ", dropped; the last from " << EndpointText(*stream.other_sender) << "\n";
  }
  if (stream.restarts > 0) text << "restarts of the sender: " << stream.restarts << "\n";
  if (stream.num_refused() == 0) return text.str();
  text << "refused for:";
  for (std::size_t i = 0; i < stream.refused.size(); ++i) {
    if (stream.refused[i] > 0) text << " " << kStreamFaultNames[i] << " " << stream.refused[i];
  }
  text << "\n";
  return text.str();
}

std::string ReceiveSummaryJson(const ReceivedTotals& totals, const StreamReceiver::Counts& counts) {
  const StreamCounts& stream = counts.stream;
  Json refused = Json::object();
  for (std::size_t i = 0; i < stream.refused.size(); ++i) {
    if (stream.refused[i] > 0) refused[std::string(kStreamFaultNames[i])] = stream.refused[i];
  }
  const Json summary = {{"command", "receive"},
                        {"frames",
                         {{"complete", stream.complete_frames},
                          {"incomplete", stream.incomplete_frames},
                          {"missing", stream.missing_frames},
                          {"dropped_here", counts.dropped_frames}}},
                        {"rate_hz", totals.rate_hz()},  // NaN is written as null.
                        {"packets",
                         {{"received", stream.received_packets},
                          {"lost", stream.lost_packets},
                          {"duplicate", stream.duplicate_packets},
                          {"reordered", stream.reordered_packets},
                          {"late", stream.late_packets},
                          {"stray", stream.stray_packets},
                          {"of_other_senders", stream.other_sender_packets},
                          {"refused", stream.num_refused()}}},
                        {"refused_for", refused},
                        {"points", totals.points},
                        {"restarts_of_the_sender", stream.restarts}};
  return summary.dump() + "\n";
}

}  // namespace railcast
