#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "generator/extras/import/map/map_formats.h"
#include "generator/extras/import/map/map_lines.h"
#include "generator/extras/import/map/xml_file.h"

namespace railcast {
namespace {

/// The parts of a text between any of some separators; empty parts count unless `joins_empty`.
std::vector<std::string_view> Parts(std::string_view text,
                                    std::string_view separators,
                                    bool joins_empty) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = std::min(text.find_first_of(separators), text.size());
    if (end > 0 || !joins_empty) parts.push_back(text.substr(0, end));
    if (end == text.size()) return parts;
    text.remove_prefix(end + 1);
  }
}

/// Elements of which each is a line with points of its own.
bool IsKmlGeometry(std::string_view name) {
  return name == "LineString" || name == "LinearRing" || name == "Point" || name == "Track";
}

/// Reads the lines of KML, with the names and data of their placemarks.
class KmlReader final : public XmlMapReader {
 public:
  explicit KmlReader(XmlFaults& faults) : faults_(faults) {}

  void Begin(const XmlElement& element) override {
    open_.emplace_back(element.name);
    if (element.name == "Placemark") {
      first_line_ = lines_.size();
      tags_.clear();
    } else if (IsKmlGeometry(element.name)) {
      altitude_mode_.clear();
      altitude_offset_m_ = 0.0;
      MapLine& line = lines_.emplace_back();
      line.place = "line " + std::to_string(element.line) + ", " + std::string(element.name);
      line.is_area = parent() == "outerBoundaryIs";
      line.is_point = element.name == "Point";
    } else if (element.name == "Data" || element.name == "SimpleData") {
      const char* key = element.ValueOf("name");
      key_ = key == nullptr ? "" : key;
    }
    coordinates_line_ = element.line;
  }

  void End(std::string_view name, std::string_view text, std::uint64_t line) override {
    if (name == "coordinates") {
      AddTuples(text);
    } else if (name == "coord") {
      const std::vector<std::string_view> parts = Parts(text, " \t\r\n", true);
      if (!parts.empty()) {
        AddTuple(XmlTrimmed(text), parts, line, "coord");
      } else {
        // A time without a place.
        remarks_.push_back(
            {RemarkKind::kFieldsLeftOut, "line " + std::to_string(line), 1, "<coord> is empty"});
      }
    } else if (IsKmlGeometry(name)) {
      EndGeometry(name);
    } else if (name == "Placemark") {
      EndPlacemark();
    } else {
      EndText(name, XmlTrimmed(text));
    }
    open_.pop_back();
  }

  RailMap Make() override {
    const bool has_links = std::ranges::any_of(
        remarks_, [](const Remark& remark) { return remark.kind == RemarkKind::kFilesLeftOut; });
    if (lines_.empty() && has_links) {
      throw InputError("must hold its lines itself (got links to other files, the first " +
                       remarks_.front().detail + ")");
    }
    return MapOfLines(std::move(lines_), std::move(remarks_));
  }

 private:
  [[nodiscard]] std::string_view parent() const {
    return open_.size() < 2 ? std::string_view() : open_[open_.size() - 2];
  }
  /// @param parts Of the tuple.
  void AddTuple(std::string_view tuple,
                const std::vector<std::string_view>& parts,
                std::uint64_t line,
                const char* what) {
    constexpr std::array kMost = {kMostLongitude_deg, kMostLatitude_deg};
    std::vector<double> numbers;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::optional<double> value = XmlNumber(parts[i]);
      if (value && (i >= kMost.size() || std::abs(*value) <= kMost[i])) numbers.push_back(*value);
    }
    if (numbers.size() != parts.size() || parts.size() < 2 || parts.size() > 3) {
      faults_.Add(line, what, "must be longitude, latitude in degrees and, if known, height in m",
                  Quoted(tuple));
      return;
    }
    if (lines_.empty() || !IsKmlGeometry(parent())) return;
    lines_.back().points_deg.emplace_back(numbers[0], numbers[1]);
    lines_.back().heights_m.push_back(numbers.size() > 2 ? std::optional(numbers[2])
                                                         : std::nullopt);
  }

  void AddTuples(std::string_view text) {
    std::uint64_t line = coordinates_line_;
    for (const std::string_view row : Parts(text, "\n", false)) {
      for (const std::string_view tuple : Parts(row, " \t\r", true)) {
        AddTuple(tuple, Parts(tuple, ",", false), line, "coordinates");
      }
      ++line;
    }
  }

  /// Only heights that are absolute count from the sea; without a mode they are not to be used.
  void EndGeometry(std::string_view name) {
    MapLine& line = lines_.back();
    if (parent() == "innerBoundaryIs") {
      lines_.pop_back();
      return;
    }
    if (altitude_mode_ == "absolute") {
      for (auto& height_m : line.heights_m) {
        if (height_m) *height_m += altitude_offset_m_;
      }
      return;
    }
    const bool has_any = std::ranges::any_of(line.heights_m, [](const auto& height_m) {
      return height_m.has_value() && *height_m != 0.0;
    });
    line.heights_m.clear();
    if (!has_any || name == "Point" || line.is_area) return;
    remarks_.push_back({RemarkKind::kHeightsUnused, line.place, 1,
                        "altitudeMode is " + (altitude_mode_.empty() ? "clampToGround, the default"
                                                                     : ShownText(altitude_mode_))});
  }

  void EndPlacemark() {
    for (std::size_t i = first_line_; i < lines_.size(); ++i) lines_[i].tags = tags_;
  }

  void EndText(std::string_view name, std::string_view text) {
    const bool is_value = (name == "value" && parent() == "Data") || name == "SimpleData";
    if (is_value && !key_.empty()) tags_[key_] = text;
    if (name == "name" && parent() == "Placemark") tags_["name"] = text;
    if (name == "altitudeMode") altitude_mode_ = text;
    if (name == "altitudeOffset") {
      const std::optional<double> offset_m = XmlNumber(text);
      altitude_offset_m_ = offset_m.value_or(0.0);
      if (!offset_m) faults_.Add(coordinates_line_, "altitudeOffset", "must be m", Quoted(text));
    }
    if (name == "href" && (parent() == "Link" || parent() == "Url")) {
      remarks_.push_back({RemarkKind::kFilesLeftOut, "NetworkLink", 1, Quoted(text)});
    }
  }

  XmlFaults& faults_;
  std::vector<std::string> open_;  ///< Elements, outermost first.
  std::vector<MapLine> lines_;
  std::vector<Remark> remarks_;
  std::size_t first_line_ = 0;  ///< First line of the placemark that is open.
  MapTags tags_;                ///< Tags of the same.
  std::string key_;             ///< Key of the data that are open.
  std::string altitude_mode_;   ///< Mode of the geometry that is open.
  double altitude_offset_m_ = 0.0;
  std::uint64_t coordinates_line_{};
};

}  // namespace

std::unique_ptr<XmlMapReader> MakeKmlReader(XmlFaults& faults) {
  return std::make_unique<KmlReader>(faults);
}

}  // namespace railcast
