#include "core/io/run/survey_record.h"

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/record/read_record.h"
#include "core/io/write_file.h"
#include "core/scenario/archive.h"

namespace railcast {

void Describe(Archive& a, SurveyedRecord& s) {
  a.Required("name", s.name, "");
  a.Required("files", s.num_files, "");
  a.Required("bytes", s.num_bytes, "");
  a.Required("xxh3", s.hash, "Over the names and the bytes of the files.");
}

void Describe(Archive& a, SurveyRecord& s) {
  a.Required("railcast_survey", s.railcast_survey, "Version of the file.");
  a.Required("version", s.version, "Of railcast.");
  a.Required("made_of", s.made_of, "Recordings.");
  a.Required("start_frame", s.start_frame, "The options of the command, and so on.");
  a.Required("stride", s.stride, "");
  a.Required("num_frames", s.num_frames, "That were read.");
  a.Required("range_m", s.range_m, "");
  a.Required("voxel_m", s.voxel_m, "");
  a.Required("max_gap_m", s.max_gap_m, "");
  a.Required("surfel_size", s.surfel_size, "");
  a.Required("keep_moving", s.keeps_moving, "");
  a.Required("standing", s.is_standing, "");
  a.Required("world_axes", s.is_in_world, "");
  a.Optional("poses", s.poses, "");
  a.Optional("white", s.white_intensity, "");
  a.Optional("sensor_height_m", s.sensor_height_m, "Where the way is the sensor's.");
  a.Required("files_xxh3", s.files, "Hashes of the other files.");
}

std::map<std::string, std::string> ReadSurveyHashes(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kSurveyRecordFile;
  const std::string place = ShownPath(file);
  std::string line = ReadFileWhole(file);
  if (line.ends_with('\n')) line.pop_back();
  if (const std::string fault = LineHashFault(line); !fault.empty()) {
    throw InputError(place + ": " + fault);
  }
  const auto record = ReadRecordLine<SurveyRecord>(line, place);
  return {record.files.begin(), record.files.end()};
}

void CheckSurveyFile(const std::filesystem::path& file, const std::string& hash) {
  if (!exists(file.parent_path() / kSurveyRecordFile)) return;
  const auto hashes = ReadSurveyHashes(file.parent_path());
  const auto said = hashes.find(file.filename().string());
  if (said == hashes.end() || said->second == hash) return;
  throw InputError({Fault{ShownPath(file),
                          "must have the hash " + ShownText(said->second) + ", as " +
                              std::string(kSurveyRecordFile) + " says",
                          hash}});
}

}  // namespace railcast
