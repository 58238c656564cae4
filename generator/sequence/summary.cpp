#include "generator/sequence/summary.h"

#include <algorithm>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/program/progress_line.h"

namespace railcast {
namespace {

using Json = nlohmann::ordered_json;
using Row = std::pair<std::string, std::uint64_t>;

void PutTable(const std::string& title, std::vector<Row> rows, std::ostringstream& text) {
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row& a, const Row& b) { return a.second > b.second; });
  std::uint64_t total = 0;
  for (const Row& row : rows) total += row.second;
  text << title << " (" << total << ")\n";
  for (const auto& [name, count] : rows) {
    if (count == 0) continue;
    const double share = 100.0 * static_cast<double>(count) / static_cast<double>(total);
    text << "  " << std::left << std::setw(16) << name << std::right << std::setw(12) << count
         << std::setw(7) << std::fixed << std::setprecision(1) << share << " %\n";
  }
}

}  // namespace

std::string Summary(const SequenceSpec& spec, const SequenceResult& result) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1);
  const std::uint32_t num_made = result.num_done - result.num_resumed;
  if (result.was_complete) {
    text << "already complete: nothing to do\n";
  } else {
    text << "made " << num_made << (num_made == 1 ? " frame" : " frames") << " in "
         << result.elapsed_s << " s";
    if (num_made > 0) text << " (" << num_made / result.elapsed_s << " frames/s)";
    if (result.num_resumed > 0) text << "; " << result.num_resumed << " were already there";
    text << "\n";
  }
  std::vector<Row> labels(result.counts.points_per_label.begin(),
                          result.counts.points_per_label.end());
  PutTable("points by label", std::move(labels), text);
  std::vector<Row> outcomes;
  for (std::size_t i = 0; i < kOutcomeNames.size(); ++i) {
    outcomes.emplace_back(kOutcomeNames[i], result.counts.outcomes[i]);
  }
  PutTable("firings by outcome", std::move(outcomes), text);
  if (result.certificate) text << CertificateText(*result.certificate);
  text << result.num_done << " of " << spec.num_frames << " frames in " << ShownPath(spec.directory)
       << "\n";
  return text.str();
}

std::string SummaryJson(const std::vector<SummarizedRun>& runs) {
  Json sensors = Json::array();
  for (const SummarizedRun& run : runs) {
    const FrameCounts& counts = run.result.counts;
    Json outcomes = Json::object();
    for (std::size_t i = 0; i < kOutcomeNames.size(); ++i) {
      if (counts.outcomes[i] > 0) outcomes[std::string(kOutcomeNames[i])] = counts.outcomes[i];
    }
    sensors.push_back({{"name", run.sensor},
                       {"directory", run.spec.directory.string()},
                       {"frames", run.spec.num_frames},
                       {"frames_done", run.result.num_done},
                       {"frames_made", run.result.num_done - run.result.num_resumed},
                       {"is_complete", run.result.is_complete},
                       {"elapsed_s", run.result.elapsed_s},
                       {"points", counts.points},
                       {"outcomes", std::move(outcomes)},
                       {"points_per_label", counts.points_per_label}});
  }
  const Json summary = {{"command", "sequence"}, {"sensors", sensors}};
  return summary.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string SequenceProgressText(std::uint32_t num_done,
                                 std::uint32_t num_frames,
                                 std::uint32_t num_resumed,
                                 double elapsed_s) {
  std::ostringstream text;
  text << "frame " << num_done << " of " << num_frames;
  const std::uint32_t num_made = num_done - num_resumed;
  if (num_made == 0 || elapsed_s <= 0.0) return text.str();
  const double rate_hz = num_made / elapsed_s;
  text << ", " << std::fixed << std::setprecision(1) << rate_hz << " frames/s, "
       << DurationText((num_frames - num_done) / rate_hz) << " left";
  return text.str();
}

void FrameProgress::Show(std::uint32_t num_done, std::uint32_t num_frames) {
  if (!num_resumed_) {
    num_resumed_ = num_done;
    begin_ = std::chrono::steady_clock::now();
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
  line_.Show(SequenceProgressText(num_done, num_frames, *num_resumed_, elapsed.count()));
  is_open_ = true;
  if (num_done == num_frames) End();
}

void FrameProgress::End() {
  if (std::exchange(is_open_, false)) line_.End();
}

}  // namespace railcast
