#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "generator/extras/insert/insert_plan.h"
#include "generator/extras/insert/plan/plan_check.h"
#include "generator/run/frame_pipe.h"

namespace railcast {

/// What `insert` is asked for.
struct InsertChoices {
  std::filesystem::path recording;
  std::string recording_name{};  ///< As run.json names it; empty: as `recording` is given.
  std::string recording_hash{};  ///< ContentHash() of RecordingTraits(); empty: not known yet.
  std::filesystem::path plan;
  std::filesystem::path directory;
  std::string format = "same";
  std::uint32_t first_frame = 0;
  std::optional<std::uint32_t> last_frame{};  ///< Absent: the recording's last.
  bool may_use_points_alone = false;
  std::string certify = "off";  ///< As CertifiedShareOf() takes it.
  int num_threads = 0;          ///< 0 = all cores.
  bool is_known = false;  ///< Whether the folder is known to be of this run, whatever it says.
};

struct InsertResult : RunResult {
  std::uint32_t num_frames{};
  std::string text{};  ///< The report of a complete run.
};

/// Reads --frames: the first and the last frame, "12..30", or the only one, "12".
/// @throws InputError if it is neither.
[[nodiscard]] std::pair<std::uint32_t, std::uint32_t> FramesNamed(const std::string& text);

/// The frames that are wanted, of as many as a recording has.
/// @throws InputError if the recording has not all of them.
[[nodiscard]] InsertRange RangeOf(std::uint32_t first_frame,
                                  std::optional<std::uint32_t> last_frame,
                                  std::uint32_t num);
/// The overload for frames that the plan has found.
[[nodiscard]] InsertRange RangeOf(const InsertChoices& choices, const InsertPlan& plan);

/// @throws InputError if what is written would be read as a part of the recording.
void CheckIsApart(const InsertChoices& choices);

/// What the objects of a plan meet in a recording (CheckPlan()).
/// @throws InputError as RunInsert() does for recording, plan and format, without writing anything;
///   of a recording with more than 200 frames not all are looked at.
[[nodiscard]] PlanCheck CheckInsert(const InsertChoices& choices, const InsertPlan& plan);

/// Puts a plan into a recording, frame by frame in order, while further frames are read. Makes the
/// frames that the folder does not hold yet; its bytes do not depend on the number of threads.
/// @throws InputError if a file cannot be read or written, or the folder holds another run.
[[nodiscard]] InsertResult RunInsert(const InsertChoices& choices,
                                     const InsertPlan& plan,
                                     const RunHooks& hooks);

}  // namespace railcast
