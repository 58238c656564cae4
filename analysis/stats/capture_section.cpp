#include <utility>

#include "analysis/report/words.h"
#include "analysis/stats/statistics.h"
#include "core/base/text.h"
#include "core/io/recording/recording_extras.h"

namespace railcast {

std::optional<Section> CaptureSection(const std::vector<std::filesystem::path>& sources) {
  const auto count = RecordingExtras::Get().count_packets;
  if (count == nullptr) return std::nullopt;
  Table table = TableOf(kStatsWords, "capture_sensors");
  for (const std::filesystem::path& source : sources) {
    for (const SensorPackets& sensor : count(source)) {
      table.rows.push_back({ShownPath(sensor.capture), sensor.name, sensor.address, sensor.ports,
                            sensor.taken, sensor.lost, sensor.doubled, sensor.reordered,
                            sensor.late, sensor.damaged, sensor.refused});
    }
  }
  if (table.rows.empty()) return std::nullopt;
  Section section = SectionOf(kStatsWords, "capture");
  section.tables = {std::move(table)};
  return section;
}

}  // namespace railcast
