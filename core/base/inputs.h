#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace railcast {

/// The bytes of a file, shared by all that read it.
using InputBytes = std::shared_ptr<const std::string>;

/// Opens each file that a scenario names once, for a program that runs one command: as long as an
/// Inputs lives, ReadInput() returns the bytes of the file's first reading, to any thread. So what
/// is hashed, what is used and what is copied are the same bytes, however many sensors there are
/// and whatever becomes of the file meanwhile. Without one, as in a library or a window that is to
/// see edits, every call reads anew. There is at most one at a time.
///
///     const Inputs inputs;
///     return RunSequenceCommand(options);
class Inputs {
 public:
  Inputs();
  ~Inputs();
  Inputs(const Inputs&) = delete;
  Inputs& operator=(const Inputs&) = delete;

  /// Frees the bytes that nobody else holds, for commands that run for hours. What is read after it
  /// is read anew.
  static void Release();
};

/// Returns the bytes of a whole file that a command only reads.
/// @throws InputError as ReadFileWhole() does.
[[nodiscard]] InputBytes ReadInput(const std::filesystem::path& file);

/// Counts a file that is read by other means among InputFiles().
void NoteInput(const std::filesystem::path& file);

/// The files that were read since the Inputs began, in the order of their absolute paths; none
/// without one. Nothing must be written over them.
[[nodiscard]] std::vector<std::filesystem::path> InputFiles();

}  // namespace railcast
