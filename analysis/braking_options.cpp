#include "analysis/braking_options.h"

#include "core/program/command_line.h"

namespace railcast {

void AddBrakingOptions(CLI::App& command, BrakingSpec& braking) {
  command
      .add_option("--reaction-s", braking.reaction_s, "Seconds from the detection to full braking")
      ->check(Number({0.0, 60.0}))
      ->capture_default_str();
  command
      .add_option(
          "--deceleration-mps2", braking.deceleration_mps2,
          "Braking deceleration on the level: 0.3 slow freight, 0.5 shunting, 1.0 multiple unit")
      ->check(Number({0.01, 10.0}))
      ->capture_default_str();
  command.add_option("--margin-m", braking.margin_m, "Metres to be left before the object")
      ->check(Number({0.0, 1000.0}))
      ->capture_default_str();
}

}  // namespace railcast
