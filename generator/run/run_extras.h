#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "railcast/transform.h"

namespace railcast {

struct EncodedFrame;
class FrameMaker;
struct MadeFrame;
struct RunChoices;
struct RunPlan;
struct SensorPlan;

/// What gets the frames of all sensors of a run, in the order in which these begin: its bag. One
/// that was interrupted is whole up to its last frame, and a resumed one has the bytes of one that
/// was never interrupted.
class RunOutput {
 public:
  virtual ~RunOutput() = default;

  /// How many of the run's frames it holds; all of them if it is complete.
  [[nodiscard]] virtual std::uint64_t num_frames() const = 0;
  [[nodiscard]] virtual bool is_complete() const = 0;
  [[nodiscard]] virtual const std::filesystem::path& path() const = 0;

  /// Whether a complete one is as it was written. One that lacks the hashes of its files, as after
  /// a power cut just before they were written, is not.
  [[nodiscard]] virtual bool IsUnchanged() const = 0;
  /// Has a complete one made anew: it and what is said of it are removed.
  virtual void Discard() = 0;

  /// Begins it, or goes on with it after its first `num_frames` frames. One that holds others than
  /// were written is begun anew.
  /// @return num_frames(), which is less where the end of the last frame is missing.
  /// @pre It is not complete, and num_frames <= num_frames().
  virtual std::uint64_t Open(std::uint64_t num_frames) = 0;

  /// Adds what it gets of a frame, and the hash of its clouds, to what is written of it.
  /// Thread-safe.
  virtual void Encode(std::size_t sensor, const MadeFrame& made, EncodedFrame& encoded) const = 0;
  /// Writes and commits that.
  virtual void Write(const EncodedFrame& encoded) = 0;

  /// Adds where the vehicle is at the end of the last frame, attaches the sensors' manifests, and
  /// completes it.
  /// @pre All frames and manifests are written.
  virtual void Finish(const RunPlan& plan,
                      std::int64_t end_ns,
                      const Transform& world_from_vehicle) = 0;
};

/// A file beside a sequence to which a message is appended for each frame. What is appended is
/// whole in the file, however the program ends.
class SequenceTrace {
 public:
  virtual ~SequenceTrace() = default;

  /// Looks for the unfinished or finished file; NextHash() begins with its first message.
  virtual void Find() = 0;
  /// The hash (ContentHash()) of the file's next message; nothing if it has no more.
  [[nodiscard]] virtual std::optional<std::string> NextHash() = 0;
  /// Begins the file, or goes on with it after its first `num_messages`, which NextHash() found.
  /// @return How many it has: less where the end of the last one is missing.
  /// @throws InputError if the system refuses.
  virtual std::size_t Open(std::size_t num_messages) = 0;

  /// The message of a frame. Thread-safe.
  [[nodiscard]] virtual std::string Encode(const MadeFrame& made) const = 0;
  /// @throws InputError if the system refuses; the file can be gone on with nevertheless.
  virtual void Append(std::int64_t time_ns, const std::string& message) = 0;
  /// Completes the file.
  virtual void Close() = 0;
};

/// What extras add to runs. Where this build lacks an extra, its functions are null.
struct RunExtras {
  /// Names that `--fields` takes with formats that are bags, beside lists of fields.
  std::vector<std::string> layouts;
  /// Chooses what a bag holds of a sensor's points, and names the topics of its clouds.
  /// @throws InputError if the fields do not fit.
  void (*plan_bag)(const std::string& fields, SensorPlan& sensor) = nullptr;
  /// Looks what there is of a run's bag; writes nothing.
  /// @pre The run's directory is locked (FolderLock).
  std::unique_ptr<RunOutput> (*find_bag)(const FrameMaker& maker, const RunPlan& plan) = nullptr;

  /// Checks that this program writes traces, and that the choices are right for them.
  /// @throws InputError that names the option.
  void (*check_trace)(const RunChoices& choices) = nullptr;
  /// Names the trace of a sensor, of which the number of frames is known, and says what makes it.
  /// @param index Of the sensor in `maker`, which must outlive the trace.
  void (*plan_trace)(const FrameMaker& maker, std::size_t index, SensorPlan& sensor) = nullptr;

  /// All that this build has.
  [[nodiscard]] static const RunExtras& Get();
};

}  // namespace railcast
