#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace railcast {

/// Names of files or folders.
using NameSet = std::set<std::string, std::less<>>;

/// Names of files of which there may be millions: those of frames, "frames/000012.pcd" and so on,
/// take no memory of their own while their numbers rise by equal steps.
class KnownNames {
 public:
  KnownNames() = default;
  KnownNames(std::initializer_list<std::string> names) { insert(names); }

  void insert(const std::string& name);
  void insert(std::initializer_list<std::string> names) {
    for (const std::string& name : names) insert(name);
  }
  [[nodiscard]] bool contains(std::string_view name) const;

 private:
  /// The numbers from `first` to `last`, `step` apart.
  struct Numbers {
    std::uint32_t first{};
    std::uint32_t last{};
    std::uint32_t step{};  ///< 0 if there is but one.
  };
  static bool Hold(const std::vector<Numbers>& runs, std::uint32_t number);

  NameSet others_;
  /// By what stands before and behind the number; each begins behind the one before it.
  std::map<std::string, std::vector<Numbers>, std::less<>> numbered_;
};

}  // namespace railcast
