#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "core/io/recording/recording.h"
#include "core/scenario/scenario_spec.h"
#include "core/simulate/simulator.h"

namespace railcast {

/// Says of a recorded firing what each effect made of it, by simulating it again: exactly what
/// `railcast-generate trace SCENARIO --frame F --firing N` prints.
///
/// The simulation is built for the first answer and kept. That takes a while, above all where
/// fidelity auto has to choose its effects: a window asks and takes, and goes on meanwhile.
///
/// An answer is "error: ..." with the reason if there is no scenario, if its files cannot be read
/// any more, or if commands changed the run, of which the scenario does not know.
class EffectTrace {
 public:
  /// @param info Of the recording whose frames are asked about.
  explicit EffectTrace(const RecordingInfo& info);
  /// Waits for the answer under way, but not for fidelity auto's choice.
  ~EffectTrace();
  EffectTrace(const EffectTrace&) = delete;
  EffectTrace& operator=(const EffectTrace&) = delete;

  /// @pre `slot` is of the frame. It may be of any return of its firing.
  [[nodiscard]] std::string Of(const RecordedFrame& recorded, std::uint32_t slot);

  /// Asks for Of() and returns at once. Of several questions the last one counts.
  void Ask(std::shared_ptr<const RecordedFrame> recorded, std::uint32_t slot);
  /// The answer to the last question, once, as soon as it is there.
  [[nodiscard]] std::optional<std::string> Take();

 private:
  struct Question {
    std::shared_ptr<const RecordedFrame> recorded;
    std::uint32_t slot{};
  };

  void Begin(Question question);
  [[nodiscard]] std::string Answer(const RecordedFrame& recorded, std::uint32_t slot);
  [[nodiscard]] std::unique_ptr<Simulator> BuildSimulator() const;

  std::filesystem::path source_;
  std::optional<ScenarioSpec> scenario_;
  std::unique_ptr<Simulator> simulator_;  ///< From the first answer on.
  std::atomic<bool> is_ending_{};
  std::optional<Question> pending_;  ///< Asked after the one under way.
  /// The last member: it is waited for before what it works with goes.
  std::future<std::string> under_way_;
};

}  // namespace railcast
