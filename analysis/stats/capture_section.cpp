#include <utility>

#include "analysis/stats/statistics.h"
#include "core/base/text.h"
#include "core/io/recording/recording_extras.h"

namespace railcast {

std::optional<Section> CaptureSection(const std::vector<std::filesystem::path>& sources) {
  const auto count = RecordingExtras::Get().count_packets;
  if (count == nullptr) return std::nullopt;
  Table table{.key = "capture_sensors",
              .title = "Sensors of the capture",
              .note =
                  "Packets are those that can be read; doubled and late ones are left out, and "
                  "those out of order were put in order.",
              .columns = ColumnsOf("capture: Capture; sensor: Sensor; address: Address; "
                                   "ports: To ports; packets: Packets; lost: Lost; "
                                   "doubled: Doubled; out_of_order: Out of order; late: Late; "
                                   "damaged: Damaged; refused: Refused")};
  for (const std::filesystem::path& source : sources) {
    for (const SensorPackets& sensor : count(source)) {
      table.rows.push_back({ShownPath(sensor.capture), sensor.name, sensor.address, sensor.ports,
                            sensor.taken, sensor.lost, sensor.doubled, sensor.reordered,
                            sensor.late, sensor.damaged, sensor.refused});
    }
  }
  if (table.rows.empty()) return std::nullopt;
  return Section{.key = "capture", .title = "Packets of the capture", .tables = {std::move(table)}};
}

}  // namespace railcast
