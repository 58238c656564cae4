#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/program/progress_line.h"
#include "generator/commands.h"
#include "generator/dataset/merge_shards.h"

namespace railcast {
namespace {

struct MergeOptions {
  std::vector<std::filesystem::path> shards;
  std::filesystem::path out;
};

int RunMerge(const MergeOptions& options) {
  std::optional<ProgressLine> line;
  const std::uint32_t num_scenarios =
      MergeShards(options.shards, options.out, [&](std::uint32_t num_done, std::uint32_t num_all) {
        const double done = static_cast<double>(num_done) / num_all;
        if (!line) line.emplace(done);
        line->Show("scenario " + std::to_string(num_done + 1) + " of " + std::to_string(num_all),
                   done);
      });
  if (line) line->End();
  std::cout << num_scenarios << " scenarios of " << options.shards.size() << " shards in "
            << ShownPath(options.out) << "\n";
  return kExitSuccess;
}

}  // namespace

void AddMerge(CLI::App& app, ProgramCommand& command) {
  const auto options = std::make_shared<MergeOptions>();
  CLI::App* merge = app.add_subcommand(
      "merge",
      "Make one data set of the folders of all its shards, with the bytes of a run "
      "without shards");
  merge->add_option("SHARD", options->shards, "Folders that dataset --shard made, all of them")
      ->required()
      ->check(NonEmpty());
  merge->add_option("--out", options->out, "Folder of the data set")->required()->check(NonEmpty());
  merge->callback([&command, options] {
    command = [options](const std::string&) { return RunMerge(*options); };
  });
}

}  // namespace railcast
