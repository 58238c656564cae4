#include "analysis/braking_options.h"

#include "core/program/command_line.h"

namespace railcast {

void AddBrakingOptions(ProgramOptions& command, BrakingSpec& braking) {
  command
      .AddOption("--reaction-s", braking.reaction_s, "Seconds from the detection to full braking")
      .Check(Number({0.0, 60.0}))
      .ShowDefault();
  command
      .AddOption(
          "--deceleration-mps2", braking.deceleration_mps2,
          "Braking deceleration on the level: 0.3 slow freight, 0.5 shunting, 1.0 multiple unit")
      .Check(Number({0.01, 10.0}))
      .ShowDefault();
  command.AddOption("--margin-m", braking.margin_m, "Metres to be left before the object")
      .Check(Number({0.0, 1000.0}))
      .ShowDefault();
}

}  // namespace railcast
