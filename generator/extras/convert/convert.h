#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/extras/insert/convert_record.h"
#include "generator/extras/insert/insert_plan.h"
#include "generator/run/frame_pipe.h"
#include "railcast/io/recording.h"

namespace railcast {

/// What `convert` is asked for.
struct ConvertChoices {
  std::filesystem::path recording;  ///< As OpenRecording() takes it, or a data set.
  std::filesystem::path directory;
  std::string format = "pcd";
  /// Names of fields, "all" of the recording's or, of bags, a layout of points.
  std::string fields = "all";
  std::uint32_t first_frame = 0;
  std::optional<std::uint32_t> last_frame{};  ///< Absent: the recording's last.
  int num_threads = 0;                        ///< 0 = all cores.
};

/// How far a conversion has got: in frames or, of a data set, in scenarios.
struct ConvertResult : RunResult {
  std::uint32_t num{};
  Losses lost{};  ///< If it is complete: what the format has no place for.
};

/// The formats that recordings are converted to.
[[nodiscard]] std::vector<std::string> ConvertFormats();

/// Writes a recording, or each sequence of a data set, in another format: the frames that the
/// folder does not hold yet, in order. A sequence of railcast becomes the sequence that
/// `railcast-generate sequence` writes in that format; other recordings become clouds in files,
/// with frames.csv, KITTI's layout or a bag. The bytes do not depend on the number of threads.
/// @throws InputError if a file cannot be read or written, the folder holds another run, or the
///   format cannot hold the points at all.
[[nodiscard]] ConvertResult RunConvert(const ConvertChoices& choices, const RunHooks& hooks);

// The parts of RunConvert().

/// Whether a recording is a sequence of railcast that becomes one in the format.
[[nodiscard]] bool BecomesSequence(const ConvertChoices& choices);
[[nodiscard]] ConvertResult ConvertSequence(const ConvertChoices& choices, const RunHooks& hooks);
[[nodiscard]] ConvertResult ConvertDataset(const ConvertChoices& choices, const RunHooks& hooks);

/// The chosen ones of the recording's fields; empty: all.
/// @throws InputError "--fields: ..." if it lacks one, or if x, y or z is not chosen.
[[nodiscard]] std::vector<std::string> ChosenFields(const std::string& fields,
                                                    const std::vector<std::string>& there);

/// What is beside the points of a sequence; nothing of another recording.
[[nodiscard]] Losses LostBesidePoints(const std::filesystem::path& recording,
                                      const InsertRange& range);

/// Whether KITTI's files have a place for a field.
inline bool IsKittiField(std::string_view name) {
  return name == "x" || name == "y" || name == "z" || name == "intensity" || name == "label" ||
         name == "instance";
}

/// Adds what a format has no place for; nothing of which there is none.
inline void AddLoss(const std::string& what, std::uint64_t number, Losses& lost) {
  if (number > 0) lost[what] += number;
}

}  // namespace railcast
