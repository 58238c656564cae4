#include "generator/sequence_spec.h"

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/io/content_hash.h"

namespace railcast {
namespace {

using Json = nlohmann::ordered_json;

Json RunObject(const SequenceSpec& spec) {
  // The order in which a difference is looked for: a different seed also makes the scenario differ.
  Json run = {{"version", spec.version},
              {"seed", spec.seed},
              {"scenario_xxh3", ContentHash(spec.scenario_json)},
              {"format", FrameFormatName(spec.files.format)}};
  if (spec.files.format != FrameFormat::kKitti) run["fields"] = spec.files.fields.Text();
  run["start_frame"] = spec.start_frame;
  run["num_frames"] = spec.num_frames;
  return run;
}

std::string Text(const Json& value) {
  if (value.is_null()) return "nothing";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace

std::string RunJson(const SequenceSpec& spec) {
  return RunObject(spec).dump(2) + "\n";
}

void CheckSameRun(const SequenceSpec& spec, const std::string& run_json) {
  const Json found = Json::parse(run_json, nullptr, false);
  const std::string place = spec.directory.string() + ": ";
  if (!found.is_object()) throw InputError(place + "holds a run.json that is not railcast's");
  const Json ours = RunObject(spec);
  for (const auto& [key, value] : ours.items()) {
    const Json other = found.value(key, Json());
    if (other == value) continue;
    if (key == "scenario_xxh3") {
      throw InputError(place + "holds a run of another scenario; choose another --out");
    }
    std::string line = place;
    line += "holds another run: its " + key + " is " + Text(other);
    line += " (got " + Text(value) + "); choose another --out";
    throw InputError(line);
  }
}

std::string LabelsJson(const LabelTable& labels) {
  Json list = Json::array();
  for (const Label& label : labels.labels()) {
    list.push_back({{"id", label.id},
                    {"name", label.name},
                    {"rgb", label.rgb},
                    {"whu_railway3d", label.whu_railway3d},
                    {"osdar23", label.osdar23},
                    {"semantic_kitti", label.semantic_kitti},
                    {"semantic_kitti_nearest", label.semantic_kitti_nearest}});
  }
  return Json{{"version", 1}, {"labels", list}}.dump(2) + "\n";
}

}  // namespace railcast
