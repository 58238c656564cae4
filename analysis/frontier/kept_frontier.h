#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "railcast/frame.h"

namespace railcast {

/// The times of one row on one frame.
struct RowTimes {
  std::vector<double> times_ms;
  std::vector<double> ratios;
  std::vector<double> processor_ms{};  ///< What the processor spent on each, on all threads.
};

/// What a run of `frontier` has measured so far, so that one that was stopped goes on: the frames
/// of the reference, which take most of the time, and the times of all rows. What is left is
/// computed anew. Without a folder nothing is kept.
class KeptFrontier {
 public:
  KeptFrontier() = default;
  /// @param identity A line that tells the run from all others.
  /// @throws InputError if the folder holds what another run has measured, or cannot be made.
  KeptFrontier(std::filesystem::path folder, const std::string& identity);

  /// Returns the frame that was kept or, if there is none, makes and keeps it.
  /// @throws InputError if a kept file is damaged, or the system refuses to write.
  [[nodiscard]] Frame FrameOf(std::uint32_t index, const std::function<Frame()>& make) const;
  /// The same for values of its firings.
  [[nodiscard]] std::vector<float> StepsOf(std::uint32_t index,
                                           const std::function<std::vector<float>()>& make) const;
  /// The same for the times of the rows on a frame.
  [[nodiscard]] std::vector<RowTimes> TimesOf(
      std::uint32_t index, const std::function<std::vector<RowTimes>()>& make) const;

  [[nodiscard]] bool HasFrame(std::uint32_t index) const;
  [[nodiscard]] bool HasTimes(std::uint32_t index) const;

  /// Removes the folder and all in it.
  void Remove() const;

 private:
  [[nodiscard]] std::filesystem::path FileOf(const char* what, std::uint32_t index) const;

  std::filesystem::path folder_;  ///< Empty: nothing is kept.
};

}  // namespace railcast
