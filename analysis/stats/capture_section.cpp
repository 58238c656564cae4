#include <cstdint>
#include <utility>

#include "analysis/stats/statistics.h"
#include "core/base/text.h"
#include "core/extras/packets/recording/capture_recording.h"
#include "core/extras/packets/recording/packet_order.h"
#include "core/extras/packets/recording/turn_reader.h"

namespace railcast {

std::optional<Section> CaptureSection(const std::vector<std::filesystem::path>& sources) {
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
    const auto capture = FindCapture(source);
    if (!capture) continue;
    for (const TurnReader& reader : CountPackets(*capture)) {
      const PacketOrder& order = reader.order();
      table.rows.push_back(
          {ShownPath(capture->file), reader.sensor().name, reader.sensor().address,
           PortsText(reader.sensor()), std::uint64_t{reader.num_taken()},
           std::uint64_t{reader.lost().number}, std::uint64_t{order.doubled().number},
           std::uint64_t{order.reordered().number}, std::uint64_t{order.late().number},
           std::uint64_t{reader.damaged().number}, std::uint64_t{reader.refused().number}});
    }
  }
  if (table.rows.empty()) return std::nullopt;
  return Section{.key = "capture", .title = "Packets of the capture", .tables = {std::move(table)}};
}

}  // namespace railcast
