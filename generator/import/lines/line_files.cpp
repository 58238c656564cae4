#include "generator/import/lines/line_files.h"

#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base/text.h"
#include "generator/import/lines/line_gauge.h"

namespace railcast {
namespace {

using LineJson = nlohmann::ordered_json;

/// A list with one item to a line of text.
template <typename Values, typename Write>
std::string ListText(const Values& values, const std::string& indent, const Write& write) {
  std::string text = "[";
  const char* separator = "\n";
  for (const auto& value : values) {
    text += separator + indent + "  " + write(value).dump();
    separator = ",\n";
  }
  return text + "\n" + indent + "]";
}

LineJson ElementJson(const AlignmentElement& element) {
  LineJson json = {{"type", NameOf(element.type)}, {"length_m", element.length_m}};
  if (element.radius_m) json["radius_m"] = *element.radius_m;
  return json;
}

/// With one coefficient to a line of text.
std::string MapText(const MapProjection& projection) {
  const MapSpec map = MapSpecOf(projection);
  const LineJson json = {{"origin_m", map.origin_m},
                         {"longitude_deg", map.longitude_deg},
                         {"latitude_deg", map.latitude_deg}};
  std::string text = json.dump();
  if (map.coefficients_m.empty()) return text;
  text.pop_back();
  return text + ",\n    \"coefficients_m\": " +
         ListText(map.coefficients_m, "    ",
                  [](const std::array<double, 2>& pair) { return LineJson(pair); }) +
         "}";
}

}  // namespace

std::string AlignmentFileText(const ImportedLine& line, const MapProjection& projection) {
  const AlignmentSpec& alignment = line.alignment;
  std::ostringstream origin;
  origin << std::fixed << std::setprecision(3) << projection.origin_m.x() << ", "
         << projection.origin_m.y();
  const std::string attribution =
      (alignment.attribution.empty() ? "" : alignment.attribution + ". ") +
      "Fitted by railcast-generate import. Coordinates: " + projection.definition + ", minus (" +
      origin.str() + ") m.";
  const auto value_json = [](const ChainageValue& step) {
    return LineJson{{"s_m", step.s_m}, {"value", step.value}};
  };
  const auto& elements = std::get<AlignmentElementsSpec>(alignment.course).elements;
  std::string text = "{\n  \"version\": 1,\n";
  text += "  \"attribution\": " + LineJson(attribution).dump() + ",\n";
  text += "  \"map\": " + MapText(projection) + ",\n";
  text += "  \"origin_m\": " +
          LineJson({alignment.origin_m[0], alignment.origin_m[1], alignment.origin_m[2]}).dump() +
          ",\n";
  text += "  \"heading_deg\": " + LineJson(alignment.heading_deg).dump() + ",\n";
  text +=
      "  \"speed_limits_kmph\": " + ListText(alignment.speed_limits_kmph, "  ", value_json) + ",\n";
  if (alignment.gauge_mm != kStandardGauge_mm) {
    text += "  \"gauge_mm\": " + LineJson(alignment.gauge_mm).dump() + ",\n";
  }
  if (!alignment.cants_mm.empty()) {
    text += "  \"cants_mm\": " + ListText(alignment.cants_mm, "  ", value_json) + ",\n";
  }
  if (!alignment.gradients_permil.empty()) {
    text += "  \"gradients_permil\": " + ListText(alignment.gradients_permil, "  ", value_json) +
            ",\n  \"gradient_smoothing_m\": " + LineJson(alignment.gradient_smoothing_m).dump() +
            ",\n";
  }
  text += "  \"course\": {\n    \"type\": \"elements\",\n    \"elements\": " +
          ListText(elements, "    ", ElementJson) + "\n  }\n}\n";
  return text;
}

std::string QualityCsv(const std::vector<ImportedLine>& lines) {
  std::ostringstream csv;
  csv << "line,length_m,points,elements,median_m,p99_m,largest_m,tightest_radius_before_m,"
         "tightest_radius_m,needed_radius_m,sign_changes_before_per_km,sign_changes_per_km,"
         "contradictions\n";
  for (const ImportedLine& line : lines) {
    const LineQuality& q = line.quality;
    csv << line.name << ',' << q.length_m << ',' << q.num_points << ',' << q.num_elements << ','
        << q.median_m << ',' << q.p99_m << ',' << q.largest_m << ',' << q.tightest_radius_before_m
        << ',' << q.tightest_radius_m << ',' << q.needed_radius_m << ','
        << q.sign_changes_before_per_km << ',' << q.sign_changes_per_km << ','
        << line.contradictions.size() << '\n';
  }
  return csv.str();
}

std::string QualityTable(const std::vector<ImportedLine>& lines) {
  std::ostringstream table;
  table << std::fixed
        << "| line | km | points off: median, 99 %, largest m | elements/km | tightest radius "
           "before, now, needed m | sign changes/km before, now |\n"
        << "|---|---|---|---|---|---|\n";
  for (const ImportedLine& line : lines) {
    const LineQuality& q = line.quality;
    table << "| " << line.name << " | " << std::setprecision(2) << 1e-3 * q.length_m << " | "
          << q.median_m << ", " << q.p99_m << ", " << q.largest_m << " | " << std::setprecision(1)
          << 1e3 * static_cast<double>(q.num_elements) / q.length_m << " | " << std::setprecision(0)
          << q.tightest_radius_before_m << ", " << q.tightest_radius_m << ", " << q.needed_radius_m
          << " | " << std::setprecision(1) << q.sign_changes_before_per_km << ", "
          << q.sign_changes_per_km << " |\n";
  }
  return table.str();
}

std::string HeightsCsv(const std::vector<ImportedLine>& lines) {
  std::ostringstream csv;
  csv << "line,points,median_m,p99_m,gradients,steepest_permil,gradient_smoothing_m,"
         "least_roundness\n";
  for (const ImportedLine& line : lines) {
    if (!line.height_quality) continue;
    const HeightQuality& q = *line.height_quality;
    csv << line.name << ',' << q.num_points << ',' << q.median_m << ',' << q.p99_m << ','
        << q.num_gradients << ',' << q.steepest_permil << ',' << line.alignment.gradient_smoothing_m
        << ',' << q.least_roundness << '\n';
  }
  return csv.str();
}

std::string ContradictionsCsv(const std::vector<ImportedLine>& lines) {
  std::ostringstream csv;
  csv << std::setprecision(10) << "line,s_m,offset_m,longitude_deg,latitude_deg\n";
  for (const ImportedLine& line : lines) {
    for (const Contradiction& point : line.contradictions) {
      csv << line.name << ',' << point.s_m << ',' << point.offset_m << ','
          << point.geographic_deg.x() << ',' << point.geographic_deg.y() << '\n';
    }
  }
  return csv.str();
}

}  // namespace railcast
