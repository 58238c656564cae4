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
  a.Required("name", s.name, "Name of the file or folder.");
  a.Required("files", s.num_files, "Number of its files.");
  a.Required("bytes", s.num_bytes, "Size of these files together.");
  a.Required("xxh3", s.hash, "Hash of the names and bytes of the files.");
}

void Describe(Archive& a, SurveyRecord& s) {
  a.Required("railcast_survey", s.railcast_survey, "Version of the file's format.");
  a.Required("version", s.version, "Version of railcast.");
  a.Required("made_of", s.made_of, "The recordings of which the survey is made.");
  a.Required("start_frame", s.start_frame,
             "Number of each recording's first frame, `--start-frame`.");
  a.Required("stride", s.stride, "Step from one frame that was read to the next, `--stride`.");
  a.Required("num_frames", s.num_frames, "Number of frames that were read.");
  a.Required("range_m", s.range_m, "Greatest range of the points, `--range`.");
  a.Required("voxel_m", s.voxel_m, "Edge of the cubes that keep one point each, `--voxel`.");
  a.Required("max_gap_m", s.max_gap_m,
             "Points farther apart have a hole between them, `--max-gap`.");
  a.Required("surfel_size", s.surfel_size, "Size of the surfels, `--surfel-size`.");
  a.Required("keep_moving", s.keeps_moving, "Whether `--keep-moving` was given.");
  a.Required("standing", s.is_standing, "Whether `--standing` was given.");
  a.Required("world_axes", s.is_in_world, "Whether `--world-axes` was given.");
  a.Optional("poses", s.poses, "The file of poses that `--poses` named.");
  a.Optional("white", s.white_intensity, "Recorded intensity of a white surface, `--white`.");
  a.Optional("sensor_height_m", s.sensor_height_m,
             "Height of the sensor, where the way is the sensor's.");
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
