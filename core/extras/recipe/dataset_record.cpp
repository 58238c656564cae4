#include "core/extras/recipe/dataset_record.h"

#include "core/extras/recipe/shard.h"
#include "core/scenario/archive.h"

namespace railcast {

void Describe(Archive& a, DatasetRecord& s) {
  a.Required("version", s.version, "Of railcast.");
  a.Required("embree", s.embree, "Its version.");
  a.Required("isa", s.isa, "Instruction set of the tracing.");
  a.Required("recipe_xxh3", s.recipe_hash, "Hash of recipe.json.");
  a.Required("bases_xxh3", s.base_hashes, "Hashes of the resolved bases.");
  a.Required("num_scenarios", s.num_scenarios, "Of all shards.");
  a.Required("format", s.format, "");
  a.Required("fields", s.fields, "");
  a.Required("merged", s.is_merged, "Whether clouds of several sensors are merged, too.");
  a.Optional("files_xxh3", s.files_hash, "Hash of the files that the recipe names.");
  a.Optional("shard", s.shard, "Number and count: 2/7.");
  a.Ensure({"shard"}, s.shard.empty() || ParseShard(s.shard), "must be a shard");
  a.Optional("certify", s.certify, "Share of the time that certificates may take.");
  a.Optional("converted", s.is_converted, "Whether insertions have become sequences.");
}

void Describe(Archive& a, SequenceRecord& s) {
  a.Required("sensor", s.sensor, "");
  a.Required("folder", s.folder, "Relative to the data set.", NonEmptyString());
  a.Required("num_frames", s.num_frames, "");
  a.Required("points", s.points, "Of all frames.");
  a.Required("scenario_xxh3", s.scenario_hash, "Hash of scenario.resolved.json.");
  a.Required("data_xxh3", s.data_hash, "As in its manifest.json.");
  a.Required("manifest_xxh3", s.manifest_hash, "Hash of that file.");
  a.Required("vehicle_s_m", s.vehicle_s_m, "Chainage at each frame's stamp.");
  a.Required("vehicle_speed_mps", s.vehicle_speed_mps, "As above.");
  a.Ensure({"vehicle_s_m"}, s.vehicle_s_m.size() == s.num_frames, "must have a value a frame");
  a.Ensure({"vehicle_speed_mps"}, s.vehicle_speed_mps.size() == s.num_frames,
           "must have a value a frame");
  a.Optional("files_xxh3", s.files, "Of an insertion: hashes of all files.");
  a.Optional("bag", s.bag, "As in its run.json.");
  a.Optional("trace", s.trace, "As in its run.json.");
}

void Describe(Archive& a, ScenarioRecord& s) {
  a.Required("scenario", s.scenario, "Its number.");
  a.Required("base", s.base, "Name of its file.");
  a.Required("split", s.split, "", OneOf({"train", "val", "test"}));
  a.Required("line", s.line, "Hash of the railway line.");
  a.Required("seen_s_m", s.seen_s_m, "The stretch that the sensors see.");
  a.Required("seed", s.seed, "");
  a.Required("world_seed", s.world_seed, "");
  a.Required("start_s_m", s.start_s_m, "Where the vehicle starts.");
  a.Required("drawn", s.drawn, "Values by their names in the recipe.");
  a.Required("placed", s.placed, "What was drawn of each placed object.");
  a.Required("weather", s.weather, "As in the scenario.");
  a.Optional("first_frame", s.first_frame, "Of a plan, in its recording.");
  a.Optional("sensors_xxh3", s.sensors_hash, "Of several sensors: hash of sensors.json.");
  a.Required("sequences", s.sequences, "One for each sensor.", NonEmptyList());
}

void Describe(Archive& a, IndexObjectRecord& s) {
  a.Required("name", s.name, "As in objects.jsonl, and so on.");
  a.Required("type", s.type, "");
  a.Required("label", s.label, "");
  a.Required("instance", s.instance, "");
  a.Required("distance_m", s.distance_m, "Of its box's centre.");
  a.Required("points", s.points, "");
  a.Required("firings_visible", s.firings_visible, "");
  a.Required("firings_alone", s.firings_alone, "");
  a.Nullable("occlusion", s.occlusion, "");
}

void Describe(Archive& a, IndexRecord& s) {
  a.Required("scenario", s.scenario, "");
  a.Required("sensor", s.sensor, "");
  a.Required("frame", s.frame, "");
  a.Required("split", s.split, "");
  a.Required("folder", s.folder, "Of the sequence, relative to the data set.");
  a.Required("files", s.files, "Of the frame, relative to the folder.");
  a.Required("stamp_ns", s.stamp_ns, "");
  a.Required("base", s.base, "");
  a.Required("line", s.line, "");
  a.Required("vehicle_s_m", s.vehicle_s_m, "");
  a.Required("vehicle_speed_mps", s.vehicle_speed_mps, "");
  a.Optional("bag", s.bag, "");
  a.Optional("trace", s.trace, "");
  DescribeKnown(a, s.counts);
  a.Required("objects", s.objects, "");
  a.Required("drawn", s.drawn, "");
  a.Required("weather", s.weather, "");
}

void Describe(Archive& a, DatasetManifestRecord& s) {
  a.Required("version", s.version, "");
  a.Optional("shard", s.shard, "Of a shard.");
  a.Required("num_scenarios", s.num_scenarios, "");
  a.Optional("num_frames", s.num_frames, "");
  a.Optional("points", s.points, "");
  a.Optional("format", s.format, "");
  a.Required("files_xxh3", s.files, "Hashes of the files about all scenarios.");
  a.Optional("data_xxh3", s.data_hash, "Hash of these and of the sequences' hashes.");
}

}  // namespace railcast
