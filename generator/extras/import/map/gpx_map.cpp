#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "generator/extras/import/map/map_lines.h"
#include "generator/extras/import/map/xml_file.h"

namespace railcast {
namespace {

/// Reads the tracks and routes of GPX. Waypoints are passed over.
class GpxReader final : public XmlMapReader {
 public:
  explicit GpxReader(XmlFaults& faults) : faults_(faults) {}

  void Begin(const XmlElement& element) override {
    open_.emplace_back(element.name);
    if (element.name == "trk" || element.name == "rte") {
      first_line_ = lines_.size();
      name_.clear();
    }
    // Some tracks have their points without a segment.
    const bool begins_loose = element.name == "trkpt" && parent() == "trk" && !is_loose_;
    if (element.name == "trk" || element.name == "trkseg") is_loose_ = false;
    if (element.name == "trkseg" || element.name == "rte" || begins_loose) {
      is_loose_ = begins_loose;
      MapLine& line = lines_.emplace_back();
      line.place = "line " + std::to_string(element.line) + ", " + std::string(element.name);
    }
    // Garmin's routes have their shape in extensions of their points.
    const bool is_shape = element.name == "rpt" && std::ranges::find(open_, "rte") != open_.end();
    const bool is_point = element.name == "trkpt" || element.name == "rtept" || is_shape;
    if (!is_point && element.name != "wpt") return;
    const auto place_deg = XmlPlace_deg(element, faults_);
    if (!is_point || !place_deg) return;
    const bool is_in_line = element.name == "trkpt"   ? parent() == "trkseg" || parent() == "trk"
                            : element.name == "rtept" ? parent() == "rte"
                                                      : true;
    if (!is_in_line) {
      faults_.Add(element.line, std::string(element.name), "must be in a track or route",
                  "in <" + ShownText(parent()) + ">");
      return;
    }
    has_fix_ = true;
    lines_.back().points_deg.push_back(*place_deg);
    lines_.back().heights_m.emplace_back();
  }

  void End(std::string_view name, std::string_view text, std::uint64_t line) override {
    const std::string_view within = parent();
    if (name == "ele" && (within == "trkpt" || within == "rtept" || within == "wpt")) {
      const std::string_view height = XmlTrimmed(text);
      const auto height_m = XmlNumber(height);
      const bool is_none = height.empty() || height == "NaN" || height == "nan";
      if (!height_m && !is_none)
        faults_.Add(line, "ele", "must be a number of metres", Quoted(text));
      const bool has_point = !lines_.empty() && !lines_.back().heights_m.empty();
      if (within != "wpt" && has_point) lines_.back().heights_m.back() = height_m;
    } else if (name == "fix" && within == "trkpt" && XmlTrimmed(text) == "none") {
      has_fix_ = false;
    } else if (name == "trkpt" && !has_fix_ && !lines_.empty() &&
               !lines_.back().points_deg.empty()) {
      remarks_.push_back(
          {RemarkKind::kPointsWithheld, "line " + std::to_string(line), 1, "<fix> none"});
      lines_.back().points_deg.pop_back();
      lines_.back().heights_m.pop_back();
    } else if (name == "name" && (within == "trk" || within == "rte")) {
      name_ = XmlTrimmed(text);
    } else if ((name == "trk" || name == "rte") && !name_.empty()) {
      for (std::size_t i = first_line_; i < lines_.size(); ++i) lines_[i].tags["name"] = name_;
    }
    open_.pop_back();
  }

  RailMap Make() override { return MapOfLines(std::move(lines_), std::move(remarks_)); }

 private:
  [[nodiscard]] std::string_view parent() const {
    return open_.size() < 2 ? std::string_view() : open_[open_.size() - 2];
  }

  XmlFaults& faults_;
  std::vector<std::string> open_;  ///< Elements, outermost first.
  std::vector<MapLine> lines_;
  std::vector<Remark> remarks_;
  std::size_t first_line_ = 0;  ///< First line of the track or route that is open.
  std::string name_;            ///< Name of the same.
  bool has_fix_ = true;         ///< Whether the receiver had one at the last point.
  bool is_loose_ = false;       ///< Whether the last line's points are without a segment.
};

}  // namespace

std::unique_ptr<XmlMapReader> MakeGpxReader(XmlFaults& faults) {
  return std::make_unique<GpxReader>(faults);
}

}  // namespace railcast
