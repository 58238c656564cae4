#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/io/run_program.h"

namespace railcast {

/// Options of `railcast-generate sequence`.
struct SequenceOptions {
  std::filesystem::path scenario;
  std::filesystem::path out;
  std::uint32_t num_frames = 10;
  std::uint32_t start_frame = 0;
  std::string format = "pcd";
  std::string fields = "all";
  std::optional<std::uint64_t> seed;              ///< Overrides the scenario's.
  std::optional<std::string> fidelity;            ///< Overrides the scenario's.
  std::optional<std::string> sensor;              ///< Of several, which one.
  std::optional<std::filesystem::path> commands;  ///< A live run's log, to be replayed.
  std::string isa;                                ///< Of the trace; empty = the machine's best.
  int num_threads = 0;                            ///< 0 = all cores.
  bool is_verbose = false;
};

/// Makes a sequence directory, or finishes an interrupted one.
/// @throws InputError on bad input.
[[nodiscard]] int SequenceCommand(const SequenceOptions& options);

/// Options of `railcast-generate stream`.
struct StreamOptions {
  std::filesystem::path scenario;
  std::optional<std::string> sensor;    ///< Absent = all.
  std::vector<std::string> to;          ///< HOST:PORT, instead of the scenario's.
  std::optional<std::string> protocol;  ///< Instead of the scenario's.
  std::optional<std::string> fields;    ///< Of protocol railcast, instead of its default.
  bool has_all_slots = false;           ///< Likewise.
  std::string pacing = "spread";
  bool drops_late = false;
  bool sends_singly = false;  ///< Without UDP segmentation offload.
  std::optional<std::filesystem::path> pcap;
  std::optional<std::filesystem::path> calibration;  ///< Of protocol hdl64e.
  bool lockstep = false;
  std::optional<std::uint16_t> commands_port;
  std::optional<std::string> commands_from;  ///< HOST or HOST:PORT; absent = this machine.
  std::optional<std::filesystem::path> commands_log;
  std::optional<double> duration_s;     ///< Of simulation time; absent = until stopped.
  std::optional<std::uint64_t> seed;    ///< Overrides the scenario's.
  std::optional<std::string> fidelity;  ///< Overrides the scenario's.
  std::string isa;                      ///< As above.
  int num_threads = 0;                  ///< 0 = all cores.
};

/// Sends frames live, as they would come from real sensors, until stopped.
/// @throws InputError on bad input.
[[nodiscard]] int StreamCommand(const StreamOptions& options);

/// Options of `railcast-generate check`.
struct CheckOptions {
  std::filesystem::path scenario;
  std::optional<std::string> resolved;  ///< File for the resolved scenario; "-" = stdout.
  bool is_verbose = false;
};

/// Prints what follows from a scenario and what its scene holds; or, to stdout, the resolved
/// scenario alone.
/// @throws InputError with every fault of the scenario.
[[nodiscard]] int CheckCommand(const CheckOptions& options);

/// Options of `railcast-generate world`.
struct WorldOptions {
  std::filesystem::path scenario;
  std::filesystem::path out;       ///< *.ply or *.obj.
  std::optional<double> from_s_m;  ///< Chainage; both or none.
  std::optional<double> to_s_m;
  bool is_verbose = false;
};

/// Writes the scene as triangles: the given stretch of the line, or the window of frame 0.
/// @throws InputError on bad input.
[[nodiscard]] int WorldCommand(const WorldOptions& options);

/// Options of `railcast-generate trace`.
struct TraceOptions {
  std::filesystem::path scenario;
  std::optional<std::string> sensor;  ///< Of several, which one.
  std::uint32_t frame = 0;
  std::uint32_t firing = 0;
  std::string isa;  ///< Of the trace; empty = the machine's best.
};

/// Replays one firing and prints what each effect made of it.
/// @throws InputError on bad input.
[[nodiscard]] int TraceCommand(const TraceOptions& options);

}  // namespace railcast
