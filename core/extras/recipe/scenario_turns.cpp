#include "core/extras/recipe/scenario_turns.h"

#include <tbb/info.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <map>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/out_of_memory.h"

namespace railcast {
namespace {

/// Threads that are waited for.
struct Crew {
  std::vector<std::thread> threads;

  Crew() = default;
  ~Crew() {
    for (std::thread& thread : threads) thread.join();
  }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;
};

class Turns {
 public:
  Turns(std::uint32_t num, int num_threads, std::uint32_t num_at_once, const ScenarioWork& work)
      : num_(num),
        num_threads_(num_threads),
        num_at_once_(std::min({num, num_at_once, static_cast<std::uint32_t>(num_threads)})),
        work_(work) {}

  void Run() {
    {
      Crew crew;
      try {
        // The calling thread is one of them.
        for (std::uint32_t i = 1; i < num_at_once_; ++i) {
          crew.threads.push_back(StartThread("making scenarios", [this] { TakeTurns(); }));
        }
      } catch (...) {
        Fail(0, std::current_exception());
      }
      TakeTurns();
    }
    if (fault_) std::rethrow_exception(fault_);
  }

 private:
  void TakeTurns() {
    while (const std::optional<std::uint32_t> index = Begin()) {
      try {
        Keep(*index, work_.make(TurnOf(*index)));
      } catch (...) {
        Fail(*index, std::current_exception());
      }
    }
  }

  // Begins the next scenario; nothing if none is left or the run is over.
  std::optional<std::uint32_t> Begin() {
    std::unique_lock lock(mutex_);
    // What waits to be kept, and what a run that is stopped has made in vain, is bounded.
    constexpr std::uint32_t kMostAhead = 4;
    changed_.wait(lock, [&] {
      return next_ == num_ || IsOver() || next_ < num_kept_ + kMostAhead * num_at_once_;
    });
    if (next_ == num_ || IsOver()) return std::nullopt;
    try {
      ShowProgress();
      if (work_.is_stopped()) {
        is_stopped_ = true;
        changed_.notify_all();
        return std::nullopt;
      }
    } catch (...) {
      NoteFault(next_, std::current_exception());
      return std::nullopt;
    }
    return next_++;
  }

  [[nodiscard]] bool IsOver() const { return is_stopped_ || first_fault_ < num_; }

  ScenarioTurn TurnOf(std::uint32_t index) {
    ScenarioTurn turn;
    turn.index = index;
    turn.num_threads = num_threads_ / static_cast<int>(num_at_once_);
    turn.num_threads_of_run = num_threads_;
    turn.is_alone = num_at_once_ == 1;
    turn.on_progress = [this, index](double done) {
      const std::lock_guard lock(mutex_);
      shares_[index] = done;
      ShowProgress();
    };
    turn.is_stopped = [this, index] { return index > first_fault_ || work_.is_stopped(); };
    turn.await_memory = [this] { return std::unique_lock(memory_); };
    return turn;
  }

  void Keep(std::uint32_t index, std::optional<std::string> line) {
    const std::lock_guard lock(mutex_);
    if (!line) {
      is_stopped_ = true;
    } else {
      shares_[index] = 1.0;
      lines_.emplace(index, std::move(*line));
    }
    try {
      while (num_kept_ < first_fault_ && lines_.contains(num_kept_)) {
        work_.keep(lines_.extract(num_kept_).mapped());
        shares_.erase(num_kept_++);
      }
    } catch (...) {
      NoteFault(num_kept_, std::current_exception());
    }
    changed_.notify_all();
  }

  void Fail(std::uint32_t index, const std::exception_ptr& fault) {
    const std::lock_guard lock(mutex_);
    NoteFault(index, fault);
  }

  // The fault of the first scenario counts, whichever is seen first.
  void NoteFault(std::uint32_t index, const std::exception_ptr& fault) {
    if (index < first_fault_) {
      first_fault_ = index;
      fault_ = fault;
    }
    changed_.notify_all();
  }

  void ShowProgress() const {
    double num_beyond = 0.0;
    for (const auto& [index, share] : shares_) num_beyond += share;
    work_.on_progress(num_beyond);
  }

  std::uint32_t num_;
  int num_threads_;
  std::uint32_t num_at_once_;
  const ScenarioWork& work_;
  std::mutex memory_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::uint32_t next_ = 0;
  std::uint32_t num_kept_ = 0;
  std::map<std::uint32_t, double> shares_;      ///< Shares of the scenarios that are not kept.
  std::map<std::uint32_t, std::string> lines_;  ///< Lines that wait for those before them.
  bool is_stopped_ = false;
  std::atomic<std::uint32_t> first_fault_ = num_;  ///< `num_` = none.
  std::exception_ptr fault_;
};

}  // namespace

void TakeTurns(std::uint32_t num,
               int num_threads,
               std::uint32_t num_at_once,
               const ScenarioWork& work) {
  if (num_threads == 0) num_threads = tbb::info::default_concurrency();
  Turns(num, num_threads, num_at_once, work).Run();
}

}  // namespace railcast
