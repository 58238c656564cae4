#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "railcast/io/recording.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// Explains what each effect did to a recorded firing, by simulating it again: exactly what
/// `railcast-generate trace SCENARIO --frame F --firing N` prints.
///
/// The simulation is built for the first answer and kept. Building takes a while, above all where
/// fidelity auto has to choose its effects, so a window calls Ask() and then polls Take() while it
/// goes on drawing.
///
/// An answer is "error: ..." with the reason if there is no scenario, if its files can no longer be
/// read, or if commands changed the run, because the scenario does not describe them.
class EffectTrace {
 public:
  /// @param info The recording whose frames are asked about.
  explicit EffectTrace(const RecordingInfo& info);
  /// Waits for the answer under way, but not for fidelity auto to finish its choice.
  ~EffectTrace();
  EffectTrace(const EffectTrace&) = delete;
  EffectTrace& operator=(const EffectTrace&) = delete;

  /// Returns the trace of a slot's firing.
  /// @pre `slot` is a slot of the frame, of any return of its firing.
  [[nodiscard]] std::string Of(const RecordedFrame& recorded, std::uint32_t slot);

  /// Asks for Of() and returns at once. Only the last of several questions is answered.
  void Ask(std::shared_ptr<const RecordedFrame> recorded, std::uint32_t slot);
  /// Returns the answer to the last question, once, as soon as it is ready.
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
  std::unique_ptr<Simulator> simulator_;  ///< Made for the first answer.
  std::atomic<bool> is_ending_{};
  std::optional<Question> pending_;  ///< Asked while another answer was under way.
  /// The last member: its destructor waits for the thread before the members that it uses are
  /// destroyed.
  std::future<std::string> under_way_;
};

/// The effect trace of the point that was picked last, of any source.
class Tracing {
 public:
  explicit Tracing(std::size_t num_sources) : traces_(num_sources) {}

  /// Asks what each effect did to a slot's firing.
  /// @param info Recording of that source.
  void Ask(std::size_t source,
           const RecordingInfo& info,
           std::shared_ptr<const RecordedFrame> recorded,
           std::uint32_t slot);
  /// Drops the question, because another point or none is picked now.
  void Forget() { asked_.reset(); }
  /// Returns the answer, once, as soon as it is ready.
  [[nodiscard]] std::optional<std::string> Take();

 private:
  /// By source; each is made for its first question.
  std::vector<std::unique_ptr<EffectTrace>> traces_;
  std::optional<std::size_t> asked_;  ///< Source of the pending answer.
};

}  // namespace railcast
