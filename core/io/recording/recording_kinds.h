#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "railcast/io/recording.h"

namespace railcast {

/// Stands between the path of a bag and the name of one of its topics.
inline constexpr std::string_view kTopicMark = ":/";
/// Stands between the name of a topic and the frame_id of one of its sensors.
inline constexpr char kSeriesMark = '#';

/// Whether a file's extension is that of a cloud: .pcd, .ply, .bin (KITTI's), .las or those of
/// IsTextCloud(), in any case.
[[nodiscard]] bool IsCloudFile(const std::filesystem::path& file);

/// Whether it is one of KITTI's layout.
[[nodiscard]] bool IsKittiFile(const std::filesystem::path& file);

/// The cloud files of a directory that are the frames of one recording, in their order.
struct CloudSeries {
  std::vector<std::filesystem::path> files;
  std::vector<std::filesystem::path> others;  ///< Copies, and what is of no series: no frames.
};

/// Sorts files of one directory into a series: their names differ in a running number or time,
/// which are compared by value, whether decimal, signed or of ISO 8601. Where most names have none,
/// all files are taken in natural order. Series one after the other, as of several drives, are one.
/// @param label The series that is wanted, as "front_#"; empty: the only one.
/// @throws InputError with the list if there are several, as of several sensors.
[[nodiscard]] CloudSeries SeriesOfClouds(std::vector<std::filesystem::path> files,
                                         const std::string& label);

/// Sorts paths of one folder by the natural order of their names, so that 9.pcd comes before
/// 10.pcd.
void SortNaturally(std::vector<std::filesystem::path>& paths);

/// Returns the cloud files in a directory, but for those whose names begin with a point, as
/// SeriesOfClouds() sorts them, and but for IsTextTable(). A directory that does not exist, as
/// "drive/front_#", may stand for a series of the one that it is in.
[[nodiscard]] CloudSeries CloudFilesIn(const std::filesystem::path& directory);

/// Returns the sequences in a directory of KITTI's layout, `sequences/00`, `01`, ..., that hold
/// clouds in `velodyne`, in natural order. None if it has another layout.
[[nodiscard]] std::vector<std::filesystem::path> KittiSequencesIn(
    const std::filesystem::path& directory);

/// Returns the clouds of a directory that is none of railcast's: those side by side in it, in its
/// folder `frames` or `velodyne`, or those of all sequences of KITTI's layout.
[[nodiscard]] CloudSeries CloudsOfDirectory(const std::filesystem::path& directory);

/// The stamps that files have by their names, where all of these hold a date and time, are decimal
/// numbers of seconds, as 1700000000.05.pcd, or hold a time of this century in seconds, ms, us or
/// ns since 1970; else none.
[[nodiscard]] std::vector<std::int64_t> StampsOfNames(
    const std::vector<std::filesystem::path>& files);

/// Clouds of KITTI's layout and the numbers of their points, or clouds in text and their columns.
struct KittiSource {
  std::filesystem::path clouds;  ///< A file or a directory.
  std::string columns;  ///< As IsKittiColumns() or IsTextColumns(); empty: none are chosen.
};

/// Splits "drive:nuscenes" and "a.xyz:x,y,z"; other sources are as they are, and have no columns.
[[nodiscard]] KittiSource KittiSourceOf(const std::filesystem::path& source);
/// The columns that KittiSourceOf() would find if nothing had the whole name.
[[nodiscard]] std::string ColumnsBehind(const std::filesystem::path& source);

/// Opens clouds without poses, in this order, with the columns of KittiSourceOf(). The names of
/// KITTI's labels are those of the configuration beside the first (FindSemanticKittiYaml).
/// @param kind The kind of recording as shown to users.
/// @throws InputError if that cannot be read.
[[nodiscard]] std::unique_ptr<Recording> OpenClouds(const std::filesystem::path& source,
                                                    const std::string& kind,
                                                    std::vector<std::filesystem::path> files);

/// The file of a received stream that names its clouds with their poses.
inline constexpr std::string_view kReceivedFile = "frames.csv";

/// Opens the clouds of a directory: those that `railcast-analyze receive --out` wrote with the
/// poses of frames.csv, whose points are assumed to be in the sensor's axes, the default of a
/// stream; else CloudsOfDirectory(). Null if there are none. The columns of KITTI's points may
/// stand behind it (KittiSourceOf()).
/// @throws InputError if frames.csv cannot be read.
[[nodiscard]] std::unique_ptr<Recording> OpenCloudsIn(const std::filesystem::path& source);

// The kinds of recordings that OpenRecording opens.

/// Opens a directory that `railcast-generate sequence` made, finished or not: the frames whose
/// lines in frames.jsonl are whole. Every file and line is checked against the hash recorded when
/// it was written; those of a frame are checked when the frame is read.
/// @throws InputError with one line if a file cannot be read or has changed since it was written.
[[nodiscard]] std::unique_ptr<Recording> OpenSequence(const std::filesystem::path& directory);

/// What OpenMerged() calls its recordings.
inline constexpr std::string_view kMergedKind = "merged clouds";

/// Opens the folder of the merged clouds of a run with several sensors (docs/files.md), checked
/// against their hashes. Points, poses and boxes are in the axes of the vehicle, which stands for
/// the sensor. What the folder of the first sensor holds beside it adds the scenario, names,
/// objects and the motion during each frame. Objects have the number of their points in the merged
/// cloud; how many firings met them is known of single sensors only, and 0 here.
/// @throws InputError as OpenSequence() does.
[[nodiscard]] std::unique_ptr<Recording> OpenMerged(const std::filesystem::path& directory);

/// Whether a scenario made all of its frames, as it did not those into which only some was put.
[[nodiscard]] inline bool IsSimulated(const RecordingInfo& info) {
  return info.scenario && (info.origin || info.kind == kMergedKind);
}

}  // namespace railcast
