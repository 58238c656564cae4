#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/cloud/cloud.h"
#include "core/io/content_hash.h"
#include "core/io/run/frame_record.h"
#include "core/io/unfinished_file.h"
#include "core/io/verify/known_names.h"
#include "core/io/verify/verification.h"
#include "core/io/write_file.h"
#include "railcast/io/cloud_files.h"

namespace railcast {

/// Reads a file and compares its hash. Returns what it has, even if that is another one; nothing if
/// it cannot be read.
/// @param said_in The file that states the hash.
inline std::optional<FileHash> CompareHash(const std::filesystem::path& file,
                                           const std::string& hash,
                                           const std::string& said_in,
                                           ErrorList& faults) {
  auto got = Attempt("", faults, [&] { return HashFile(file); });
  if (got && got->hash != hash) {
    faults.Add({ShownPath(file),
                "must have the hash " + ShownText(hash) + ", as " + said_in + " says", got->hash});
  }
  return got;
}

/// Calls `visit` with the name, relative to `root`, of each file below a folder but not in those
/// that `known_folders` names. A symbolic link counts as a file of its own name, whatever it points
/// to.
/// @throws InputError if a folder cannot be read.
template <typename Visit>
void ForEachFileBelow(const std::filesystem::path& folder,
                      const std::filesystem::path& root,
                      const NameSet& known_folders,
                      const Visit& visit) {
  std::error_code error;
  std::filesystem::recursive_directory_iterator entry(folder, error);
  for (const std::filesystem::recursive_directory_iterator end; !error && entry != end;
       entry.increment(error)) {
    const std::filesystem::path name = entry->path().lexically_relative(root);
    if (entry->symlink_status(error).type() != std::filesystem::file_type::directory) {
      visit(name.generic_string());
    } else if (known_folders.contains(name.generic_string())) {
      entry.disable_recursion_pending();
    }
  }
  if (error) throw FileError(folder, error.value());
}

/// Where counts are, and what they are compared with, in messages.
struct CountsPlace {
  std::string place;      ///< "manifest.json".
  std::string compared;   ///< "the sum over frames.jsonl".
  std::string is_absent;  ///< "is in no frame".
};

/// Adds a fault for each count that differs from what was counted: "place: /points: must be 7, the
/// sum over frames.jsonl (got 8)".
void CompareCounts(const FrameCounts& counted,
                   const FrameCounts& got,
                   const CountsPlace& place,
                   ErrorList& faults);

/// A frame's cloud and what its numbers mean.
struct CountedCloud {
  const Cloud& cloud;
  const FrameFormat& format;
  const LabelTable& labels;
  std::filesystem::path file;  ///< Its name.
};

/// Counts a cloud's points, by label and by outcome where it has these fields, and adds a fault for
/// each count of the frame's line that differs: "frames.jsonl:3: /points: must be 7, as counted in
/// frames/000012.pcd (got 8)".
/// @param place Names the line of frames.jsonl.
void CompareWithCloud(const CountedCloud& counted,
                      const FrameCounts& line,
                      const std::string& place,
                      ErrorList& faults);

/// What a verifier has found so far, and the work that all verifiers do.
class Findings {
 protected:
  /// Does a part of the work, and keeps its faults. Returns whether it has none.
  template <typename Work>
  bool Try(const Work& work) {
    return Attempt("", faults_, [&] { return work(), true; }).has_value();
  }

  /// As CompareHash(), and counts the file. Returns whether it is that one.
  bool CheckHash(const std::filesystem::path& file,
                 const std::string& hash,
                 const std::string& said_in) {
    const auto got = CompareHash(file, hash, said_in, faults_);
    if (!got) return false;
    ++result_.num_files;
    result_.num_bytes += got->num_bytes;
    return got->hash == hash;
  }

  /// Checks that the files that a record names have the hashes that it states.
  /// @param files Pairs of names and hashes.
  /// @param said_in The record's name in the folder.
  template <typename Files>
  void CheckHashes(const std::filesystem::path& folder,
                   const Files& files,
                   std::string_view said_in) {
    for (const auto& [name, hash] : files) {
      known_.insert(name);
      CheckHash(folder / name, hash, std::string(said_in));
    }
  }

  /// Adds a file that does not belong to a folder.
  void AddOther(const std::filesystem::path& folder,
                const std::string& name,
                const std::string& rule) {
    const auto finished = FinishedName(name);
    const bool is_unfinished = finished && known_.contains(*finished);
    ErrorList line;
    line.Add({ShownPath(folder / name), rule, ""});
    result_.others.push_back({folder / name, line.lines().front(), is_unfinished});
    faults_.AddLine(line.lines().front());
  }

  /// Adds the files of a folder, or of one below it, that are not known.
  /// @param known_folders What is below these has been looked at.
  void FindOthers(const std::filesystem::path& folder,
                  const std::string& rule,
                  const NameSet& known_folders = {},
                  const std::string& below = "") {
    Try([&] {
      ForEachFileBelow(folder / below, folder, known_folders, [&](const std::string& name) {
        if (!known_.contains(name)) AddOther(folder, name, rule);
      });
    });
  }

  void Add(const Verification& found) {
    for (const std::string& fault : found.faults) faults_.AddLine(fault);
    result_.others.insert(result_.others.end(), found.others.begin(), found.others.end());
    result_.unchecked.insert(result_.unchecked.end(), found.unchecked.begin(),
                             found.unchecked.end());
    result_.num_frames += found.num_frames;
    result_.num_files += found.num_files;
    result_.num_bytes += found.num_bytes;
  }

  Verification Take() {
    result_.faults = faults_.lines();
    return std::move(result_);
  }

  ErrorList faults_;
  Verification result_;
  KnownNames known_;  ///< Files that belong to the folder.
};

}  // namespace railcast
