#include "core/extras/recipe/dataset_record.h"

#include "core/extras/recipe/shard.h"
#include "core/scenario/archive.h"

namespace railcast {

void Describe(Archive& a, DatasetRecord& s) {
  a.Required("version", s.version, "Version of railcast.");
  a.Required("embree", s.embree, "Version of Embree.");
  a.Required("isa", s.isa, "Instruction set of the tracing.");
  a.Required("recipe_xxh3", s.recipe_hash, "Hash of recipe.json.");
  a.Required("bases_xxh3", s.base_hashes, "Hashes of the resolved bases.");
  a.Required("num_scenarios", s.num_scenarios, "Number of scenarios in all shards together.");
  a.Required("format", s.format, "Format of the clouds, as `--format` names it.");
  a.Required("fields", s.fields, "Fields of the points, as `--fields` names them.");
  a.Required("merged", s.is_merged, "Whether clouds of several sensors are merged, too.");
  a.Optional("files_xxh3", s.files_hash, "Hash of the files that the recipe names.");
  a.Optional("shard", s.shard, "Number and count of the shard, as in 2/7.");
  a.Ensure({"shard"}, s.shard.empty() || ParseShard(s.shard), "must be a shard");
  a.Optional("certify", s.certify, "Share of the time that certificates may take.");
  a.Optional("converted", s.is_converted, "Whether insertions have become sequences.");
}

void Describe(Archive& a, SequenceRecord& s) {
  a.Required("sensor", s.sensor, "Name of the sensor.");
  a.Required("folder", s.folder, "The sequence's folder, relative to the data set.",
             NonEmptyString());
  a.Required("num_frames", s.num_frames, "Number of frames in the sequence.");
  a.Required("points", s.points, "Number of points in all its frames.");
  a.Required("scenario_xxh3", s.scenario_hash, "Hash of scenario.resolved.json.");
  a.Required("data_xxh3", s.data_hash, "The same hash as in its manifest.json.");
  a.Required("manifest_xxh3", s.manifest_hash, "Hash of its manifest.json.");
  a.Required("vehicle_s_m", s.vehicle_s_m, "Chainage of the vehicle at each frame's stamp.");
  a.Required("vehicle_speed_mps", s.vehicle_speed_mps,
             "Speed of the vehicle at each frame's stamp.");
  a.Ensure({"vehicle_s_m"}, s.vehicle_s_m.size() == s.num_frames, "must have a value a frame");
  a.Ensure({"vehicle_speed_mps"}, s.vehicle_speed_mps.size() == s.num_frames,
           "must have a value a frame");
  a.Optional("files_xxh3", s.files, "Hashes of all files, if the sequence is an insertion.");
  a.Optional("bag", s.bag, "The bag that holds the clouds, as in the sequence's run.json.");
  a.Optional("trace", s.trace, "Name of the OSI trace, as in the sequence's run.json.");
}

void Describe(Archive& a, ScenarioRecord& s) {
  a.Required("scenario", s.scenario, "Number of the scenario.");
  a.Required("base", s.base, "Name of the base scenario's file.");
  a.Required("split", s.split, "Part of the data set: train, val or test.",
             OneOf({"train", "val", "test"}));
  a.Required("line", s.line, "Hash of the railway line.");
  a.Required("seen_s_m", s.seen_s_m, "The stretch that the sensors see.");
  a.Required("seed", s.seed, "Seed of the scenario.");
  a.Required("world_seed", s.world_seed, "Seed of the scenario's world.");
  a.Required("start_s_m", s.start_s_m, "Where the vehicle starts.");
  a.Required("drawn", s.drawn, "The drawn values, by their names in the recipe.");
  a.Required("placed", s.placed, "What was drawn of each placed object.");
  a.Required("weather", s.weather, "The weather, as in the scenario.");
  a.Optional("first_frame", s.first_frame,
             "Number of the recording's first frame that is used, if the base is a plan.");
  a.Optional("sensors_xxh3", s.sensors_hash, "Hash of sensors.json, if there are several sensors.");
  a.Required("sequences", s.sequences, "The sequences, one for each sensor.", NonEmptyList());
}

void Describe(Archive& a, IndexObjectRecord& s) {
  a.Required("name", s.name, "Name of the object, as in objects.jsonl.");
  a.Required("type", s.type, "Type of the object.");
  a.Required("label", s.label, "Name of the object's class.");
  a.Required("instance", s.instance, "The object's number in the clouds.");
  a.Required("distance_m", s.distance_m,
             "Distance from the sensor to the centre of the object's box.");
  a.Required("points", s.points, "Number of slots with a point on it.");
  a.Required("firings_visible", s.firings_visible,
             "Firings whose beam meets it first with any of its rays, detected or not.");
  a.Required("firings_alone", s.firings_alone,
             "Firings whose beam would meet it if nothing else stood there.");
  a.Nullable("occlusion", s.occlusion, "Share of its firings that something hides.");
}

void Describe(Archive& a, IndexRecord& s) {
  a.Required("scenario", s.scenario, "Number of the scenario.");
  a.Required("sensor", s.sensor, "Name of the sensor.");
  a.Required("frame", s.frame, "Number of the frame in its sequence.");
  a.Required("split", s.split, "Part of the data set: train, val or test.");
  a.Required("folder", s.folder, "The sequence's folder, relative to the data set.");
  a.Required("files", s.files, "The frame's files, relative to the folder.");
  a.Required("stamp_ns", s.stamp_ns, "Simulation time of the frame.");
  a.Required("base", s.base, "Name of the base scenario's file.");
  a.Required("line", s.line, "Hash of the railway line.");
  a.Required("vehicle_s_m", s.vehicle_s_m, "Chainage of the vehicle at the stamp.");
  a.Required("vehicle_speed_mps", s.vehicle_speed_mps, "Speed of the vehicle at the stamp.");
  a.Optional("bag", s.bag, "The bag that holds the cloud.");
  a.Optional("trace", s.trace, "Name of the OSI trace that holds the cloud.");
  DescribeKnown(a, s.counts);
  a.Required("objects", s.objects, "The objects within the sensor's range.");
  a.Required("drawn", s.drawn, "The scenario's drawn values, by their names in the recipe.");
  a.Required("weather", s.weather, "The scenario's weather.");
}

void Describe(Archive& a, DatasetManifestRecord& s) {
  a.Required("version", s.version, "Version of railcast.");
  a.Optional("shard", s.shard, "Number and count of the shard, if this is one.");
  a.Required("num_scenarios", s.num_scenarios, "Number of scenarios.");
  a.Optional("num_frames", s.num_frames, "Number of frames; left out by a shard.");
  a.Optional("points", s.points, "Number of points; left out by a shard.");
  a.Optional("format", s.format, "Format of the clouds; left out by a shard.");
  a.Required("files_xxh3", s.files, "Hashes of the files about all scenarios.");
  a.Optional("data_xxh3", s.data_hash, "Hash of these hashes and of the sequences' hashes.");
}

}  // namespace railcast
