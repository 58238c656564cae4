#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/extras/osi/trace_file.h"
#include "core/extras/ros/bag/bag.h"
#include "core/io/run/run_folder.h"

namespace railcast {

/// The OSI trace of a sequence, to which a message is appended for each frame. An .osi file has its
/// name from its begin, an MCAP file is named as those of bags are. What is appended is whole in
/// the file, however the program ends.
class RunTrace {
 public:
  /// What there is of a trace: nothing, the unfinished file or the finished one.
  [[nodiscard]] static osi::TraceContent Find(const std::filesystem::path& file);

  /// Begins the trace, or goes on with it after the first `num_messages` of what Find() found.
  /// @param topic Of the MCAP file's only channel.
  /// @throws InputError if the system refuses, or as bag::ContinueMcap() does.
  RunTrace(const std::filesystem::path& file,
           const std::string& topic,
           const osi::TraceContent& found,
           std::size_t num_messages);

  /// Which is less than was asked for where the end of the last one is missing.
  [[nodiscard]] std::size_t num_messages() const { return num_messages_; }

  /// @throws InputError if the system refuses; the trace can be gone on with nevertheless.
  void Append(std::int64_t time_ns, const std::string& message);
  /// Completes the file.
  void Close();

 private:
  std::size_t num_messages_{};
  std::optional<LineFile> single_channel_;
  std::unique_ptr<bag::BagWriter> mcap_;
  std::size_t topic_{};
};

}  // namespace railcast
