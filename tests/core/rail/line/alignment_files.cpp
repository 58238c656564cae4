#include "tests/core/rail/line/alignment_files.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

namespace railcast {
namespace {

using nlohmann::json;

std::optional<double> Radius(const json& section, const char* key) {
  if (!section.contains(key)) return std::nullopt;
  return section[key].get<double>();
}

std::optional<double> TtobenchRadius(const json& radius) {
  if (radius.is_string()) return std::nullopt;
  return -radius.get<double>();
}

}  // namespace

AlignmentSpec ReadStGallenWil() {
  std::ifstream stream(RAILCAST_SOURCE_DIR "/scenarios/alignments/st_gallen_wil.json");
  const json file = json::parse(stream);
  AlignmentSectionsSpec course;
  course.length_m = file["course"]["length_m"];
  for (const json& section : file["course"]["sections"]) {
    course.sections.push_back(
        {section["s_m"], Radius(section, "radius_start_m"), Radius(section, "radius_end_m")});
  }
  AlignmentSpec spec;
  spec.course = std::move(course);
  spec.origin_m = file["origin_m"];
  spec.heading_deg = file["heading_deg"];
  for (const json& step : file["gradients_permil"]) {
    spec.gradients_permil.push_back({step["s_m"], step["value"]});
  }
  for (const json& step : file["speed_limits_kmph"]) {
    spec.speed_limits_kmph.push_back({step["s_m"], step["value"]});
  }
  return spec;
}

AlignmentSpec ReadTtobench(const std::filesystem::path& path) {
  std::ifstream stream(path);
  const json file = json::parse(stream);
  AlignmentSectionsSpec course;
  course.length_m = file["stops"]["values"].back();
  for (const json& row : file["curvatures"]["values"]) {
    course.sections.push_back({row[0], TtobenchRadius(row[1]), TtobenchRadius(row[2])});
  }
  AlignmentSpec spec;
  spec.course = std::move(course);
  spec.origin_m = {0.0, 0.0, file["altitude"]["value"]};
  for (const json& row : file["gradients"]["values"]) {
    spec.gradients_permil.push_back({row[0], row[1]});
  }
  for (const json& row : file["speed limits"]["values"]) {
    spec.speed_limits_kmph.push_back({row[0], row[1]});
  }
  return spec;
}

}  // namespace railcast
