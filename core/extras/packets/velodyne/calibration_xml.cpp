#include <cstddef>

#include "core/base/text.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"

namespace railcast {
namespace {

void AppendFigure(std::string_view tag, double value, std::string& xml) {
  xml.append("        <").append(tag).append(">").append(NumberText(value));
  xml.append("</").append(tag).append(">\n");
}

}  // namespace

std::string CalibrationXml(const SpinningSpec& pattern) {
  std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\" ?>\n"
      "<!DOCTYPE boost_serialization>\n"
      "<boost_serialization signature=\"serialization::archive\" version=\"4\">\n"
      "<DB>\n  <distLSB_>0.2</distLSB_>\n  <points_>\n    <count>" +
      NumberText(pattern.channels.size()) + "</count>\n";
  for (std::size_t i = 0; i < pattern.channels.size(); ++i) {
    const ChannelSpec& channel = pattern.channels[i];
    xml += "    <item>\n      <px>\n";
    AppendFigure("id_", static_cast<double>(i), xml);
    AppendFigure("rotCorrection_", 0.0 - channel.azimuth_deg, xml);
    AppendFigure("vertCorrection_", channel.elevation_deg, xml);
    for (const char* offset :
         {"distCorrection_", "distCorrectionX_", "distCorrectionY_", "vertOffsetCorrection_",
          "horizOffsetCorrection_", "focalDistance_", "focalSlope_"}) {
      AppendFigure(offset, 0.0, xml);
    }
    xml += "      </px>\n    </item>\n";
  }
  return xml + "  </points_>\n</DB>\n</boost_serialization>\n";
}

}  // namespace railcast
