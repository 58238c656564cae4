#pragma once

#include <cstdint>
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

/// Options of `railcast-analyze receive`.
struct ReceiveOptions {
  std::string at = "127.0.0.1:27400";
  std::optional<double> duration_s;
  std::optional<std::uint64_t> num_frames;
  std::filesystem::path out;  ///< Empty: nothing is kept.
};

/// Counts a live stream in the railcast protocol, and keeps it if asked to, until a signal ends it.
/// @throws InputError on bad input.
[[nodiscard]] int ReceiveCommand(const ReceiveOptions& options);

}  // namespace railcast
