#include <cstdint>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <string>

#include "core/base/error.h"
#include "core/base/join.h"
#include "core/base/text.h"
#include "core/extras/packets/recording/capture_recording.h"
#include "core/extras/ros/recording/bag_recording.h"
#include "core/io/content_hash.h"
#include "core/io/record/record_text.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/recording/source_choice.h"
#include "core/io/run/survey_record.h"
#include "core/io/verify/findings.h"
#include "core/io/write_file.h"
#include "core/program/progress_line.h"
#include "core/program/version.h"
#include "core/scenario/descriptions.h"
#include "core/scenario/json_writer.h"
#include "generator/commands.h"
#include "generator/extras/empty_folder.h"
#include "generator/extras/recording_commands.h"
#include "generator/extras/survey/survey.h"

namespace railcast {
namespace {

struct SurveyCommandOptions {
  SurveySource source;
  SourceChoice choice;
  SurveyOptions made;
  std::filesystem::path out;
};

std::string WorldText(const AlignmentSpec& axis) {
  AlignmentSpec alignment = axis;
  alignment.attribution = "The way of the surveying vehicle, by railcast-generate survey.";
  const Json world = {
      {"version", 1}, {"alignment", JsonWriter::WriteShort(alignment)}, {"survey", kSurveyFile}};
  return world.dump(2) + "\n";
}

/// What a survey consists of, as counts.
std::string SurveyReport(const Survey& survey, std::size_t num_bytes) {
  const auto line = [](std::size_t count, const std::string& what) {
    return Amount(count, what) + "\n";
  };
  return line(survey.num_points, "points of " + Amount(survey.num_frames, "frames in ") +
                                     Amount(survey.num_voxels, "cubes")) +
         line(survey.num_alone, "cubes without neighbours left out") +
         line(survey.num_moving, "surfels of things that moved left out") +
         line(survey.num_surfels, "surfels in " + Amount(survey.tiles.size(), "tiles: ") +
                                      std::to_string(survey.num_linear) + " along lines, " +
                                      std::to_string(survey.num_scattered) +
                                      " scattered, the others on surfaces") +
         line(survey.num_wires, "wires") + line(num_bytes, "bytes");
}

/// The name of a recording, and a hash over the names and the bytes of all of its files.
SurveyedRecord ContentOf(const std::filesystem::path& source) {
  const auto capture = FindCapture(source);
  const auto bag = FindBag(source);
  const std::filesystem::path recording = capture ? capture->file
                                          : bag   ? bag->bag
                                                  : KittiSourceOf(source).clouds;
  std::map<std::string, FileHash> files;
  if (!is_directory(recording)) {
    files[recording.filename().string()] = HashFile(recording);
  } else {
    ForEachFileBelow(recording, recording, {}, [&](const std::string& name) {
      if (is_regular_file(recording / name)) files[name] = HashFile(recording / name);
    });
  }
  if (capture && !capture->beside.file.empty()) {
    files[capture->beside.file.filename().string()] = HashFile(capture->beside.file);
  }
  std::string text;
  std::uint64_t num_bytes = 0;
  for (const auto& [name, file] : files) {
    text += name + '\n' + file.hash + '\n';
    num_bytes += file.num_bytes;
  }
  return {source.filename().string(), files.size(), num_bytes, ContentHash(text)};
}

SurveyRecord SurveyRecordOf(const SurveyCommandOptions& options, const Survey& survey) {
  const auto& [source, choice, made, out] = options;
  SurveyRecord record{.version = ProgramVersion(),
                      .start_frame = source.first_frame,
                      .stride = source.stride,
                      .num_frames = survey.num_frames,
                      .range_m = source.range_max_m,
                      .voxel_m = made.voxel_m,
                      .max_gap_m = made.surfels.max_gap_m,
                      .surfel_size = made.surfels.size_factor,
                      .keeps_moving = made.keeps_moving,
                      .is_standing = source.is_standing,
                      .is_in_world = source.is_in_world,
                      .white_intensity = source.white_intensity};
  for (const auto& recording : source.recordings) record.made_of.push_back(ContentOf(recording));
  if (!source.poses.empty()) record.poses = ContentOf(source.poses);
  if (!survey.is_way_of_vehicle && !survey.way.world_from_body.empty()) {
    record.sensor_height_m = survey.way.above_rail_m;
  }
  return record;
}

/// Writes the line along the vehicle's way and says where it is; returns the file's text, empty
/// where there is no such line.
std::string WriteWorld(const SurveyCommandOptions& options, const Survey& survey) {
  if (survey.way.world_from_body.empty()) {
    std::cout << "no way of a vehicle is known: name an alignment beside \"survey\"\n";
    return "";
  }
  if (!survey.is_way_of_vehicle) {
    std::cout << "top of rail is taken to be " << ShortText(survey.way.above_rail_m)
              << " m below the sensor\n";
  }
  const auto axis = AxisAlong(survey.way, options.source.range_max_m);
  if (!axis) {
    std::cout << "the way turns back, or the recordings are not named in the order of their way: "
                 "name an alignment beside \"survey\"\n";
    return "";
  }
  const std::filesystem::path file = options.out / kSurveyWorldFile;
  const std::string text = WorldText(*axis);
  WriteFileWhole(file, text);
  std::cout << "the line begins " << ShortText(options.source.range_max_m)
            << " m before the first frame's place and is " << ShortText(Alignment(*axis).length_m())
            << " m long: " << ShownPath(file) << "\n";
  return text;
}

int RunSurvey(SurveyCommandOptions& options) {
  const FolderLock lock = LockEmptyFolder(options.out);
  const auto white = GuessWhite(options.source);
  options.source.guessed_white = white.value_or(1.0);
  SurveyLabels labels;
  const ProgressLine progress;
  std::size_t num_visited = 0;
  const FramesOfSurvey frames = [&](const auto& visit) {
    VisitFrames(options.source, labels, [&](const SurveyFrame& frame) {
      progress.Show("frame " + std::to_string(++num_visited));
      visit(frame);
    });
  };
  const Survey survey = MakeSurvey(frames, labels, options.made);
  progress.End();
  const std::string bytes = EncodeSurvey(survey.labels, survey.tiles);
  WriteFileWhole(options.out / kSurveyFile, bytes);
  std::cout << SurveyReport(survey, bytes.size());
  if (white) {
    std::cout << "white surfaces are taken to have an intensity of "
              << NumberText(options.source.guessed_white)
              << ", by the highest one of all files; --white says it\n";
  }
  SurveyRecord record = SurveyRecordOf(options, survey);
  record.files.emplace_back(kSurveyFile, ContentHash(bytes));
  const std::string world = WriteWorld(options, survey);
  if (!world.empty()) record.files.emplace_back(kSurveyWorldFile, ContentHash(world));
  WriteFileWhole(options.out / kSurveyRecordFile, HashedRecordLine(record));
  return kExitSuccess;
}

void AddSourceOptions(ProgramOptions& command, SurveyCommandOptions& options) {
  SurveySource& source = options.source;
  constexpr std::uint32_t kMostFrames = 1'000'000'000;
  constexpr NumberRule kRange{1.0, 1000.0};  // In m.
  command
      .AddOption("RECORDING", source.recordings, "Recordings or clouds in one frame of reference")
      .Required()
      .Check(NonEmpty());
  command.AddOption("--start-frame", source.first_frame, "First frame of each recording")
      .Check(Whole({0, kMostFrames}))
      .ShowDefault();
  command.AddOption("--frames", source.num_frames, "Number of frames; default: all")
      .Check(Whole({1, kMostFrames}));
  command.AddOption("--stride", source.stride, "Every how many-th frame to take; 1 = all")
      .Check(Whole({1, kMostFrames}))
      .ShowDefault();
  AddSourceChoice(command, options.choice);
  const Option standing =
      command.AddFlag("--standing", source.is_standing,
                      "Frames without a pose were all taken from one place, the world's origin");
  const Option world_axes = command
                                .AddFlag("--world-axes", source.is_in_world,
                                         "Frames without a pose have points in the world's axes")
                                .Excludes(standing);
  command
      .AddOption(
          "--poses", source.poses,
          "Poses of the sensor in the world, one for each frame: lines of KITTI's or TUM's, .csv "
          "as railcast's poses.csv, or .json of OpenLABEL with the sensor \"lidar\"")
      .Excludes(standing)
      .Excludes(world_axes)
      .Check(NonEmpty());
  command.AddOption("--range", source.range_max_m, "Leave out points farther from the sensor, in m")
      .ShowDefault()
      .Check(Number(kRange));
  command
      .AddOption("--white", source.white_intensity,
                 "Recorded intensity of a white surface; default: 1; 255 in foreign clouds with "
                 "intensities above 1; 65535 in LAS with intensities above 255")
      .Check(Number({1e-6, 1e6}));
}

void AddSurvey(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<SurveyCommandOptions>();
  ProgramOptions survey = app.AddCommand("survey", OwnProgramOf("survey").description);
  AddSourceOptions(survey, *options);
  AddCaptureSensor(survey, options->choice.sensor);
  survey.AddOption("--out", options->out, "New or empty folder to write to")
      .Required()
      .Check(NonEmpty());
  survey
      .AddOption("--voxel", options->made.voxel_m,
                 "Edge of the cubes of which each keeps one point, in m")
      .ShowDefault()
      .Check(Number({0.005, 1.0}));
  survey
      .AddOption("--max-gap", options->made.surfels.max_gap_m,
                 "Leave a hole between points farther apart than this, in m")
      .ShowDefault()
      .Check(Number({0.02, 5.0}));
  survey
      .AddOption("--surfel-size", options->made.surfels.size_factor,
                 "Size of surfels as a multiple of half the distance to their neighbours")
      .ShowDefault()
      .Check(Number({0.2, 4.0}));
  survey.AddFlag("--keep-moving", options->made.keeps_moving,
                 "Keep points that other frames' beams have passed through");
  survey
      .AddOption(
          "--sensor-height", options->made.sensor_height_m,
          "Height of the sensor above top of rail, in m; default: that of the mount in "
          "railcast's own recordings, else above the recorded ground below the sensor's path")
      .Check(Number({-100.0, 100.0}));
  survey.WhenParsed([&command, options] {
    command = [options](const std::string& /*all*/) {
      options->source.recordings = WithChoice(options->source.recordings, options->choice);
      return RunSurvey(*options);
    };
  });
}

}  // namespace

void AddSurvey(RecordingCommands& extras) {
  extras.commands["survey"] = AddSurvey;
}

}  // namespace railcast
