#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/report/report.h"
#include "core/io/verify/verification.h"
#include "core/program/program.h"

namespace railcast {

/// A source that `stats` was given, and what it consists of.
struct MeasuredSource {
  std::filesystem::path source;
  std::vector<std::filesystem::path> recordings;  ///< In their order; the source itself if one.
  /// What reports call a source whose recordings they do not list, such as "shard 1/3 of a data
  /// set"; else empty.
  std::string kind{};
  std::string data_hash{};  ///< Hash of the data; empty for a shard.
  /// Makes the section of a data set that is no shard; else empty.
  /// @param suffix Follows the keys of section, charts and tables.
  std::function<Section(const std::string& suffix)> section{};
};

/// What extras add to railcast-analyze. What this build lacks is null.
struct AnalysisExtras {
  ExtraCommands commands;

  /// Looks what the folder of a data set consists of.
  /// @throws InputError with one line if it is unfinished or damaged.
  MeasuredSource (*open_dataset)(const std::filesystem::path& directory) = nullptr;

  /// Compares the files of a study with its manifest.json, and looks for others.
  /// @throws InputError if its study.json cannot be read.
  Verification (*verify_study)(const std::filesystem::path& directory,
                               const std::function<void(double)>& on_progress) = nullptr;

  /// All that this build has.
  [[nodiscard]] static const AnalysisExtras& Get();
};

}  // namespace railcast
