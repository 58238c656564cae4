#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace railcast {

/// Where a scenario's values were written: which file, and where in it.
///
/// Two pointers take part: the one in the resolved scenario (`/lidar/scan/rate_hz`) and, where a
/// section came from a file of its own, the one in that file (`sensors/vlp16.json: /scan/rate_hz`).
class ScenarioSources {
 public:
  /// From `resolved_pointer` downwards, values stand in `file` from `pointer` downwards.
  void Add(std::string resolved_pointer, std::string file, std::string pointer);
  /// Some file is shown to the user as `shown`: relative if the user gave relative names.
  void AddFile(std::string absolute, std::string shown);

  /// What stood at and below `from` in the resolved scenario stands at `to` now.
  void Rename(std::string_view from, const std::string& to);

  /// "file: /pointer" of a value; the bare pointer where no file is known.
  [[nodiscard]] std::string Place(std::string_view resolved_pointer) const;

  /// A builder's line as the user should see it. Builders name a place by a pointer relative to
  /// their spec, which stands at `resolved_pointer`, or by the absolute name of a file.
  [[nodiscard]] std::string Locate(std::string_view line, std::string_view resolved_pointer) const;

  /// Where a scenario was written is no part of what it says: all sources are equal.
  bool operator==(const ScenarioSources&) const { return true; }

 private:
  struct Entry {
    std::string resolved_pointer;
    std::string file;
    std::string pointer;
  };
  struct File {
    std::string absolute;
    std::string shown;
  };
  std::vector<Entry> entries_;
  std::vector<File> files_;
};

}  // namespace railcast
