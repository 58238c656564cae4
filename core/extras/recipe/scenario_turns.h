#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

namespace railcast {

/// What the maker of a scenario is told.
struct ScenarioTurn {
  std::uint32_t index{};  ///< Index of the scenario: 0, 1, ...
  int num_threads = 1;    ///< Threads that it may use.
  bool is_alone{};        ///< Whether no other scenarios are made at the same time.
  /// Told the share that is done, in [0, 1], by one thread of the scenario at a time.
  std::function<void(double done)> on_progress;
  /// Whether the scenario must end. Thread-safe.
  std::function<bool()> is_stopped;
  /// Waits until no other scenario is made that takes much memory; then this one may use all
  /// `num_threads_of_run` while it holds the lock.
  std::function<std::unique_lock<std::mutex>()> await_memory;
  int num_threads_of_run = 1;
};

/// What is done in turns.
struct ScenarioWork {
  /// Makes a scenario. Called by several threads at once.
  /// @return Its record as text (RecordText()); nothing if it was stopped.
  std::function<std::optional<std::string>(const ScenarioTurn& turn)> make;
  /// Takes the lines of the scenarios, in order; by one thread at a time, as are the next two.
  std::function<void(const std::string& line)> keep;
  /// Told how many scenarios are made beyond those whose lines were kept: before each scenario, and
  /// as often as the scenarios say how far they are.
  std::function<void(double num_beyond)> on_progress;
  /// Asked before each scenario, and by the threads of scenarios that are being made, several at
  /// once.
  std::function<bool()> is_stopped;
};

/// Makes `num` scenarios, in their order, one on each of the run's threads, and keeps their lines
/// in that order. If there are fewer scenarios than threads, each gets as many of them. If making
/// one throws, those after it are stopped, those before it are kept, and the exception is passed
/// on: what a run leaves and says does not depend on the number of threads.
/// @param num_threads 0 = all cores.
/// @param num_at_once The most scenarios that are made at once.
void TakeTurns(std::uint32_t num,
               int num_threads,
               std::uint32_t num_at_once,
               const ScenarioWork& work);

}  // namespace railcast
