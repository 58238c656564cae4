#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace railcast {

/// Exit statuses of railcast-analyze; a usage error gives 2.
inline constexpr int kExitSuccess = 0;
inline constexpr int kExitFailure = 1;
inline constexpr int kExitUsage = 2;

/// Options of `railcast-analyze frontier`.
struct FrontierOptions {
  std::filesystem::path scenario;
  std::optional<std::string> sensor;  ///< Of several, which one.
  std::filesystem::path out;
  int num_frames = 4;
  int num_threads = 1;
  std::string rows = "all";
};

/// Charts speed against accuracy on a scenario.
/// @throws InputError on bad input.
[[nodiscard]] int FrontierCommand(const FrontierOptions& options);

}  // namespace railcast
