#include "core/io/velodyne/calibration_xml.h"

#include <expat.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <type_traits>

#include "core/base/error.h"
#include "core/base/number_text.h"
#include "core/base/out_of_memory.h"
#include "core/io/text_cursor.h"

namespace railcast {
namespace {

constexpr std::size_t kNumLasers = 64;
constexpr double kMetresPerCm = 0.01;
constexpr double kDistanceUnit_cm = 0.2;

/// A laser's element; what is not there is NaN.
struct LaserElement {
  double id = std::numeric_limits<double>::quiet_NaN();
  double rotation_deg = std::numeric_limits<double>::quiet_NaN();
  double elevation_deg = std::numeric_limits<double>::quiet_NaN();
  double range_offset_cm = 0.0;
  double vertical_offset_cm = 0.0;
  double horizontal_offset_cm = 0.0;
};

double* FigureOf(LaserElement& laser, std::string_view name) {
  if (name == "id_") return &laser.id;
  if (name == "rotCorrection_") return &laser.rotation_deg;
  if (name == "vertCorrection_") return &laser.elevation_deg;
  if (name == "distCorrection_") return &laser.range_offset_cm;
  if (name == "vertOffsetCorrection_") return &laser.vertical_offset_cm;
  if (name == "horizOffsetCorrection_") return &laser.horizontal_offset_cm;
  return nullptr;
}

/// Collects the lasers while expat reads.
class Collector {
 public:
  explicit Collector(XML_Parser parser) : parser_(parser) {}

  void Start(std::string_view name) {
    path_ += '/';
    path_ += name;
    text_.clear();
    if (path_ == kLaserPath) laser_ = {};
  }
  void Add(std::string_view text) {
    // Longer is no figure; a hostile file must not fill the memory.
    constexpr std::size_t kMaxFigureLength = 64;
    if (text_.size() < kMaxFigureLength) text_ += text;
  }
  void End(std::string_view name) {
    if (path_ == kUnitPath) {
      double unit_cm = 0.0;
      Read(name, unit_cm);
      if (unit_cm != kDistanceUnit_cm) Fail("distLSB_ must be 0.2", text_);
    } else if (path_ == kLaserPath) {
      AddLaser();
    } else if (path_.size() == kLaserPath.size() + 1 + name.size() &&
               path_.starts_with(kLaserPath)) {
      if (double* const figure = FigureOf(laser_, name)) Read(name, *figure);
    }
    path_.erase(path_.size() - name.size() - 1);
    text_.clear();
  }

  [[nodiscard]] const std::string& fault() const { return fault_; }
  [[nodiscard]] const std::array<std::optional<LaserCalibration>, kNumLasers>& lasers() const {
    return lasers_;
  }

 private:
  static constexpr std::string_view kUnitPath = "/boost_serialization/DB/distLSB_";
  static constexpr std::string_view kLaserPath = "/boost_serialization/DB/points_/item/px";

  void Fail(std::string_view rule, std::string_view got) {
    if (!fault_.empty()) return;
    fault_.append("line ").append(NumberText(XML_GetCurrentLineNumber(parser_))).append(": ");
    fault_.append(rule).append(" (got \"").append(got).append("\")");
    XML_StopParser(parser_, XML_FALSE);
  }

  void Read(std::string_view name, double& figure) {
    const std::vector<std::string_view> words = Words(text_);
    const auto number = words.size() == 1 ? ParseNumber<double>(words[0]) : std::optional<double>{};
    if (!number || !std::isfinite(*number)) {
      Fail(std::string(name) + " must be a number", text_);
      return;
    }
    figure = *number;
  }

  void AddLaser() {
    if (!(laser_.id >= 0.0 && laser_.id < kNumLasers && laser_.id == std::floor(laser_.id))) {
      Fail("id_ must be 0 to 63", NumberText(laser_.id));
      return;
    }
    if (!(std::abs(laser_.elevation_deg) <= 90.0)) {
      Fail("vertCorrection_ must be >= -90 and <= 90", NumberText(laser_.elevation_deg));
      return;
    }
    if (!(std::abs(laser_.rotation_deg) <= 360.0)) {
      Fail("rotCorrection_ must be >= -360 and <= 360", NumberText(laser_.rotation_deg));
      return;
    }
    for (const double offset_cm :
         {laser_.range_offset_cm, laser_.vertical_offset_cm, laser_.horizontal_offset_cm}) {
      constexpr double kMaxOffset_cm = 1000.0;
      if (std::abs(offset_cm) <= kMaxOffset_cm) continue;
      Fail("corrections of distance and place must be >= -1000 and <= 1000", NumberText(offset_cm));
      return;
    }
    auto& laser = lasers_[static_cast<std::size_t>(laser_.id)];
    if (laser) Fail("every id_ must be there once", NumberText(laser_.id));
    laser = {.elevation_deg = laser_.elevation_deg,
             .azimuth_deg = 0.0 - laser_.rotation_deg,  // 0 - 0 is no -0.
             .range_offset_m = laser_.range_offset_cm * kMetresPerCm,
             .vertical_offset_m = laser_.vertical_offset_cm * kMetresPerCm,
             .horizontal_offset_m = laser_.horizontal_offset_cm * kMetresPerCm};
  }

  XML_Parser parser_;
  std::string path_;
  std::string text_;
  std::string fault_;
  LaserElement laser_;
  std::array<std::optional<LaserCalibration>, kNumLasers> lasers_;
};

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

std::vector<LaserCalibration> ReadCalibrationXml(std::string_view xml, const std::string& name) {
  const std::unique_ptr<std::remove_pointer_t<XML_Parser>, decltype(&XML_ParserFree)> parser(
      XML_ParserCreate(nullptr), &XML_ParserFree);
  if (parser == nullptr) throw OutOfMemory("reading " + name);
  Collector collector(parser.get());
  XML_SetUserData(parser.get(), &collector);
  XML_SetElementHandler(
      parser.get(),
      [](void* user, const XML_Char* element, const XML_Char**) {
        static_cast<Collector*>(user)->Start(element);
      },
      [](void* user, const XML_Char* element) { static_cast<Collector*>(user)->End(element); });
  XML_SetCharacterDataHandler(parser.get(), [](void* user, const XML_Char* text, int length) {
    static_cast<Collector*>(user)->Add({text, static_cast<std::size_t>(length)});
  });
  constexpr std::size_t kMaxSize = std::size_t{1} << 20U;
  if (xml.size() > kMaxSize) {
    throw InputError(name + ": must have at most 1048576 bytes (got " + NumberText(xml.size()) +
                     ")");
  }
  const bool is_read =
      XML_Parse(parser.get(), xml.data(), static_cast<int>(xml.size()), XML_TRUE) == XML_STATUS_OK;
  if (!collector.fault().empty()) throw InputError(name + ": " + collector.fault());
  if (!is_read) {
    throw InputError(name + ": line " + NumberText(XML_GetCurrentLineNumber(parser.get())) +
                     ": must be XML (" + XML_ErrorString(XML_GetErrorCode(parser.get())) + ")");
  }
  std::vector<LaserCalibration> calibration;
  for (std::size_t i = 0; i < kNumLasers; ++i) {
    const auto& laser = collector.lasers()[i];
    if (!laser) throw InputError(name + ": must have a <px> with id_ " + NumberText(i));
    calibration.push_back(*laser);
  }
  return calibration;
}

}  // namespace railcast
