#include "generator/extras/import/import_files.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "core/scenario/descriptions.h"
#include "core/scenario/json_writer.h"

namespace railcast {
namespace {

/// Whether JSON is, or holds in objects, a list of lists or objects.
bool HasItems(const Json& json) {
  const auto is_in = [&](bool (*holds)(const Json&)) { return std::ranges::any_of(json, holds); };
  if (json.is_array()) return is_in([](const Json& item) { return item.is_structured(); });
  return json.is_object() && is_in(HasItems);
}

std::string IndentedText(const Json& json, const std::string& indent) {
  if (!HasItems(json)) return json.dump();
  std::string text = json.is_array() ? "[" : "{";
  const char* separator = "\n";
  for (const auto& [key, value] : json.items()) {
    text += separator + indent + "  ";
    text += json.is_array() ? value.dump()
                            : Json(key).dump() + ": " + IndentedText(value, indent + "  ");
    separator = ",\n";
  }
  return text + "\n" + indent + (json.is_array() ? "]" : "}");
}

/// JSON as text, with one item of a list of lists or objects to a line.
std::string TextWithItems(const Json& json) {
  return IndentedText(json, "");
}

/// What beside a line is in no run of tracks; steps that follow each other for one reason are one.
std::vector<LeftOut> UnusedStretches(const std::vector<UnusedStep>& steps) {
  std::vector<LeftOut> stretches;
  for (const UnusedStep& step : steps) {
    const std::string what = step.kind + " track";
    const bool goes_on = !stretches.empty() && stretches.back().what == what &&
                         stretches.back().reason == step.reason &&
                         step.s_m.begin_s_m <= stretches.back().end_s_m &&
                         step.s_m.end_s_m >= stretches.back().begin_s_m;
    if (!goes_on) stretches.push_back({what, step.s_m.begin_s_m, step.s_m.end_s_m, step.reason});
    LeftOut& stretch = stretches.back();
    stretch.begin_s_m = std::min(stretch.begin_s_m, step.s_m.begin_s_m);
    stretch.end_s_m = std::max(stretch.end_s_m, step.s_m.end_s_m);
  }
  return stretches;
}

}  // namespace

std::string AlignmentFileText(const ImportedLine& line, const MapProjection& projection) {
  std::ostringstream origin;
  origin << std::fixed << std::setprecision(3) << projection.origin_m.x() << ", "
         << projection.origin_m.y();
  AlignmentSpec alignment = line.alignment;
  alignment.attribution =
      (alignment.attribution.empty() ? "" : alignment.attribution + ". ") +
      "Fitted by railcast-generate import. Coordinates: " + projection.definition + ", minus (" +
      origin.str() + ") m.";
  alignment.map = MapSpecOf(projection);
  Json file = {{"version", 1}, {"attribution", alignment.attribution}};
  file.update(JsonWriter::WriteShort(alignment));
  return TextWithItems(file) + "\n";
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

Json JsonOf(TrackSpec track) {
  Json json = {{"name", track.name}};  // A list reads better with names, also with the usual one.
  json.update(JsonWriter::WriteShort(track));
  return json;
}

Json JsonOf(StructureSpec structure) {
  return JsonWriter::WriteShort(structure);
}

std::string WorldFileText(const ImportedLine& line, const LineWorld& world, bool has_elevation) {
  Json file = {{"version", 1}, {"alignment", line.name + ".alignment.json"}};
  if (has_elevation) file["terrain"]["elevation"]["file"] = line.name + ".elevation.asc";
  for (const StructureSpec& spec : world.structures) file["structures"].push_back(JsonOf(spec));
  for (const WorldTrack& track : world.tracks) file["tracks"].push_back(JsonOf(track.draft.spec));
  for (DiamondCrossingSpec spec : world.crossings) {
    file["diamond_crossings"].push_back(JsonWriter::WriteShort(spec));
  }
  return TextWithItems(file) + "\n";
}

std::string LeftOutCsv(const LeftOutOfMap& left_out,
                       const std::vector<ImportedLine>& lines,
                       const std::vector<LineWorld>& worlds) {
  std::ostringstream csv;
  csv << "line,what,from_s_m,to_s_m,reason\n";
  const auto add = [&](const std::string& line, const LeftOut& thing) {
    csv << line << ',' << thing.what << ',' << RoundedTo(thing.begin_s_m, 100.0) << ','
        << RoundedTo(thing.end_s_m, 100.0) << ',' << QuotedField(thing.reason) << '\n';
  };
  for (const Remark& remark : left_out.remarks) {
    Remark placeless = remark;
    placeless.place.clear();
    csv << ',' << remark.type().name << ",,,"
        << QuotedField(remark.place + (remark.place.empty() ? "" : ": ") + placeless.Text())
        << '\n';
  }
  for (const LeftOutLine& line : left_out.lines)
    add(line.track.name, {"line", 0.0, line.length_m, line.reason});
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const LeftOut& thing : worlds[i].left_out) add(lines[i].name, thing);
    for (const LeftOut& thing : UnusedStretches(worlds[i].beside.unused)) add(lines[i].name, thing);
  }
  return csv.str();
}

std::string MovedCsv(const std::vector<ImportedLine>& lines, const std::vector<LineWorld>& worlds) {
  std::ostringstream csv;
  csv << "line,track,from_s_m,to_s_m,moved_m\n";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const MovedTrack& moved : MovedTracksOf(worlds[i])) {
      csv << lines[i].name << ',' << moved.name << ',' << RoundedTo(moved.begin_s_m, 100.0) << ','
          << RoundedTo(moved.end_s_m, 100.0) << ',' << RoundedTo(moved.most_m, 100.0) << '\n';
    }
  }
  return csv.str();
}

std::string MovedText(const std::vector<LineWorld>& worlds) {
  double length_m = 0.0;
  double most_m = 0.0;
  std::size_t num_stretches = 0;
  for (const LineWorld& world : worlds) {
    for (const MovedTrack& moved : MovedTracksOf(world)) {
      ++num_stretches;
      length_m += moved.end_s_m - moved.begin_s_m;
      most_m = std::max(most_m, moved.most_m);
    }
  }
  if (num_stretches == 0) return "";
  std::ostringstream text;
  text << std::fixed << std::setprecision(2)
       << "more than 0.5 m from where the map has it (moved.csv): " << 1e-3 * length_m << " km in "
       << num_stretches << " stretches, by " << most_m << " m at most\n\n";
  return text.str();
}

}  // namespace railcast
