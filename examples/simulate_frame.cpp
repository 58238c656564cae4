// simulate_frame.cpp: counts what became of the firings of a scenario's first frames.
#include <railcast/railcast.h>

#include <cstdint>
#include <iostream>
#include <map>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    const railcast::ScenarioSpec scenario = railcast::ReadScenario(argv[1]);
    const auto simulator = railcast::MakeSimulator(scenario, /*num_threads=*/0);
    railcast::Frame frame;
    for (std::uint32_t index = 0; index < 3; ++index) {
      simulator->Scan(index, frame);
      std::map<railcast::Outcome, int> counts;
      for (const railcast::Outcome outcome : frame.outcome) ++counts[outcome];
      for (const auto& [outcome, count] : counts) {
        std::cout << index << ' ' << railcast::OutcomeName(outcome) << ' ' << count << '\n';
      }
    }
  } catch (const railcast::InputError& error) {
    std::cerr << error.what() << '\n';  // One line per fault: "file: /pointer: rule (got value)".
    return 1;
  }
}
