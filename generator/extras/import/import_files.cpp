#include "generator/extras/import/import_files.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "core/io/write_file.h"
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

void WriteLine(const std::filesystem::path& out,
               const ImportedLine& line,
               const MapProjection& projection,
               const LineWorld& world,
               bool has_elevation) {
  WriteFileWhole(out / (line.name + ".alignment.json"), AlignmentFileText(line, projection));
  WriteFileWhole(out / (line.name + ".world.json"), WorldFileText(line, world, has_elevation));
}

}  // namespace railcast
