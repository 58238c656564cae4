#pragma once

// What seed_mutants.py puts into sources asks here whether its fault is on.

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <string>
#include <type_traits>

namespace railcast_mutants {

inline bool IsChosen(int mutant) {
  constexpr int kMostMutants = 1000;
  static const char* const chosen = std::getenv("RAILCAST_MUTANT");
  static const int chosen_mutant = chosen != nullptr ? std::atoi(chosen) : -1;
  static const char* const folder = std::getenv("RAILCAST_MUTANTS_REACHED");
  static std::array<std::atomic<bool>, kMostMutants> reached{};
  if (folder != nullptr && !reached[static_cast<std::size_t>(mutant)].exchange(true)) {
    const std::string path = std::string(folder) + "/" + std::to_string(mutant);
    const int file = open(path.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0644);
    if (file >= 0) close(file);
  }
  return mutant == chosen_mutant;
}

constexpr bool Is(int mutant) {
  if (std::is_constant_evaluated()) return false;
  return IsChosen(mutant);
}

}  // namespace railcast_mutants
