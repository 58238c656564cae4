#include "analysis/receive/receive_report.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string_view>
#include <system_error>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/cloud/pcd_encoder.h"
#include "core/io/run/run_folder.h"
#include "core/io/stream/stream_clouds.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

constexpr char kIndexName[] = "frames.csv";

void PutPose(const Transform& pose, std::ostream& line) {
  const Vector3 position_m = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  for (const double value :
       {position_m.x(), position_m.y(), position_m.z(), q.x(), q.y(), q.z(), q.w()}) {
    line << ',' << value;
  }
}

using Json = nlohmann::ordered_json;

std::uint64_t PointsEach(const ReceivedTotals& totals) {
  return totals.frames == 0 ? 0 : totals.points / totals.frames;
}

constexpr double kNsPerMs = 1e6;

double QuantileMs(const DurationHistogram& times, double fraction) {
  return static_cast<double>(times.QuantileNs(fraction)) / kNsPerMs;
}

void PutTimes(std::string_view head, const DurationHistogram& times, std::ostream& text) {
  if (times.count() == 0) return;
  text << head << ": p50 " << std::fixed << std::setprecision(3) << QuantileMs(times, 0.5)
       << " ms, p99 " << QuantileMs(times, 0.99) << " ms, most " << QuantileMs(times, 1.0)
       << " ms\n";
}

Json TimesJson(const DurationHistogram& times) {
  if (times.count() == 0) return {};
  return {{"p50", QuantileMs(times, 0.5)},
          {"p99", QuantileMs(times, 0.99)},
          {"max", QuantileMs(times, 1.0)}};
}

std::string RateText(const ReceivedTotals& totals) {
  if (totals.frames < 2) return "no rate yet";
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << totals.rate_hz() << " Hz";
  return text.str();
}

}  // namespace

ReceivedFiles::ReceivedFiles(const std::filesystem::path& directory) : directory_(directory) {
  RefuseLinks(directory_, {"frames", kIndexName});
  std::error_code error;
  std::filesystem::create_directories(directory_ / "frames", error);
  if (error) throw FileError(directory_, error.value());
  const std::filesystem::path index = directory_ / kIndexName;
  if (std::filesystem::exists(index)) {
    throw InputError(ShownPath(index) + ": must not exist: a recording is there already");
  }
  if (!std::filesystem::is_empty(directory_ / "frames", error)) {
    throw InputError(ShownPath(directory_ / "frames") +
                     ": must be empty: frames are there already");
  }
  lines_.open(index);
  lines_.precision(std::numeric_limits<double>::max_digits10);
  lines_ << "file,run,frame,stamp_ns,x,y,z,qx,qy,qz,qw,points,lost_points,end_time_ns,end_x,end_y,"
            "end_z,end_qx,end_qy,end_qz,end_qw,first_arrival_ns,last_arrival_ns,latency_ns\n"
         << std::flush;
  if (!lines_) throw FileError(index, errno);
}

void ReceivedFiles::Write(const ReceivedFrame& frame) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "frames/%06u.pcd", num_files_++);
  WriteFileWhole(directory_ / name.data(), EncodePcd(MakeCloud(frame), false));
  const StreamHeader& header = frame.header;
  lines_ << name.data() << ',' << header.run << ',' << header.frame << ',' << header.stamp_ns;
  PutPose(header.world_from_sensor, lines_);
  lines_ << ',' << frame.num_points() << ',' << header.num_points - frame.num_points();
  // In other axes, points have no motion of the sensor to be undone.
  if (header.axes == StreamAxes::kSensor && !header.is_left_handed) {
    lines_ << ',' << header.duration_ns;
    PutPose(header.world_from_sensor_end, lines_);
  } else {
    lines_ << ",,,,,,,,";
  }
  lines_ << ',' << frame.first_arrival_ns << ',' << frame.last_arrival_ns << ',';
  if (const auto latency_ns = LatencyOf(frame)) lines_ << *latency_ns;
  lines_ << '\n' << std::flush;
  if (!lines_) throw FileError(directory_ / kIndexName, errno);
}

std::optional<std::int64_t> LatencyOf(const ReceivedFrame& frame) {
  constexpr std::int64_t kHour_ns = 3600 * kNsPerS;
  std::int64_t since_stamp_ns = 0;
  // The stamp is what the sender claims.
  if (__builtin_sub_overflow(frame.last_arrival_ns, frame.header.stamp_ns, &since_stamp_ns) ||
      since_stamp_ns < -kHour_ns || since_stamp_ns > kHour_ns) {
    return std::nullopt;
  }
  return since_stamp_ns - std::int64_t{frame.header.duration_ns};
}

void ReceivedTotals::Add(const ReceivedFrame& frame) {
  ++frames;
  points += frame.num_points();
  if (last_arrival_ns) between.Add(frame.last_arrival_ns - *last_arrival_ns);
  last_arrival_ns = frame.last_arrival_ns;
  const auto latency_ns = LatencyOf(frame);
  if (latency_ns) latency.Add(*latency_ns);
  if (latency_ns.value_or(0) < 0) ++frames_ahead;
}

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
  PutTimes("from frame to frame", totals.between, text);
  PutTimes("latency since the last firing", totals.latency, text);
  if (totals.frames > 0 && totals.latency.count() == 0) {
    text
        << "latency: unknown, stamps are not of this machine's clock, as --clock utc of the sender "
           "states it\n";
  }
  if (totals.frames_ahead > 0) {
    text << "frames before their last firing: " << totals.frames_ahead
         << ", whose latency counts as 0; the sender's clock is ahead\n";
  }
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
                        {"from_frame_to_frame_ms", TimesJson(totals.between)},
                        {"latency_ms", TimesJson(totals.latency)},
                        {"frames_ahead", totals.frames_ahead},
                        {"restarts_of_the_sender", stream.restarts}};
  return summary.dump() + "\n";
}

}  // namespace railcast
