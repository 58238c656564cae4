#include "generator/run/run_options.h"

#include <algorithm>
#include <string>
#include <vector>

#include "core/program/command_line.h"
#include "generator/run/run_extras.h"
#include "railcast/error.h"
#include "railcast/io/cloud_files.h"

namespace railcast {

void AddRunChoices(ProgramOptions& command, RunChoices& choices) {
  std::vector<std::string> formats;
  for (const FrameFormat& format : FrameFormats()) formats.emplace_back(format.name);
  command.AddOption("--format", choices.format, "File format of the frames")
      .Check(Named(formats))
      .ShowDefault();
  command
      .AddOption("--fields", choices.fields,
                 "Fields to write, separated by commas, or all, which leaves out those of the "
                 "track, such as in_gauge; for mcap and rosbag2 also a layout of points: "
                 "railcast, velodyne, ouster, hesai, livox, aeva or autoware")
      .ShowDefault();
  command.AddFlag("--merged", choices.is_merged,
                  "Also write the clouds of all sensors together, in the vehicle's axes, with "
                  "the field sensor_index");
  AddCertify(command, choices.certify);
  AddThreads(command, choices.num_threads);
  AddIsa(command, choices.isa);
}

Option AddCertify(ProgramOptions& command, std::string& certify) {
  return command
      .AddOption("--certify", certify,
                 "Share of the frames' time, such as 1%, in which some firings are simulated "
                 "again on rung reference to estimate the run's numerical error; or off")
      .ShowDefault();
}

void CheckFields(const std::string& fields) {
  const std::vector<std::string>& layouts = RunExtras::Get().layouts;
  if (std::ranges::find(layouts, fields) != layouts.end()) return;
  try {
    static_cast<void>(FieldSelection(fields, true, true));
  } catch (const InputError& error) {
    FailUsage(error.what());
  }
}

}  // namespace railcast
