#include <filesystem>
#include <iostream>
#include <set>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/write_file.h"
#include "generator/commands.h"
#include "generator/empty_folder.h"
#include "generator/randomize/random_weather.h"
#include "railcast/material.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxScenarios = 1'000'000;

struct RandomizeOptions {
  fs::path scenario;
  fs::path out;
  std::uint32_t count = 10;
  std::uint64_t seed = 1;
  std::vector<std::string> families = NamesOf<WeatherFamily>();
};

std::vector<WeatherFamily> FamiliesOf(const std::vector<std::string>& names) {
  const std::set<std::string> chosen(names.begin(), names.end());
  std::vector<WeatherFamily> families;
  for (const EnumName<WeatherFamily>& family : kEnumNames<WeatherFamily>) {
    if (chosen.contains(std::string(family.name))) families.push_back(family.value);
  }
  return families;
}

// "000042_foggy.json". A number keeps its place in lists of names up to the largest count.
std::string NameOfFile(std::uint32_t index, WeatherFamily family) {
  const std::string digits = std::to_string(index);
  const std::size_t num_zeros = digits.size() < 6 ? 6 - digits.size() : 0;
  return std::string(num_zeros, '0') + digits + "_" + std::string(NameOf(family)) + ".json";
}

// The scenario's path as its variants in `folder` name it.
std::string PathInJson(const fs::path& scenario, const fs::path& folder) {
  const std::string path =
      fs::weakly_canonical(scenario).lexically_proximate(fs::weakly_canonical(folder));
  try {
    static_cast<void>(Json(path).dump());
  } catch (const Json::exception&) {
    throw InputError(ShownPath(scenario) + ": the path must be UTF-8, to stand in JSON");
  }
  return path;
}

int RunRandomize(const RandomizeOptions& options) {
  const ScenarioSpec base = ReadScenario(options.scenario);
  const std::vector<WeatherFamily> families = FamiliesOf(options.families);
  // Snow lies on surfaces as a material, which the scenario's library must have.
  if (families.back() == WeatherFamily::kSnowy) {
    static_cast<void>(MaterialLibrary(base.materials).Index("snow"));
  }
  const std::string base_file = PathInJson(options.scenario, options.out);
  MakeEmptyFolder(options.out);
  for (std::uint32_t i = 0; i < options.count; ++i) {
    const RandomWeather weather = DrawWeather(options.seed, i, families);
    const Json scenario = {{"version", 1}, {"file", base_file}, {"weather", weather.section}};
    const fs::path file = options.out / NameOfFile(i, weather.family);
    WriteFileWhole(file, scenario.dump(2) + "\n");
    std::cout << ShownPath(file) << '\n';
  }
  return kExitSuccess;
}

}  // namespace

void AddRandomize(CLI::App& app, ProgramCommand& command) {
  const auto options = std::make_shared<RandomizeOptions>();
  CLI::App* randomize =
      app.add_subcommand("randomize", "Write scenarios that differ from one in random weather");
  randomize->add_option("SCENARIO", options->scenario, "Scenario file")
      ->required()
      ->check(NonEmpty());
  randomize
      ->add_option("--out", options->out,
                   "New or empty folder for the scenarios, which name SCENARIO as their base")
      ->required()
      ->check(NonEmpty());
  randomize->add_option("--count", options->count, "Number of scenarios")
      ->transform(Whole({1, kMaxScenarios}))
      ->capture_default_str();
  randomize->add_option("--seed", options->seed, "Seed of the weathers; the scenario keeps its own")
      ->transform(Whole({}))
      ->capture_default_str();
  randomize
      ->add_option("--weather", options->families,
                   "Families of weather to draw from, separated by commas; default: all")
      ->check(CLI::IsMember(NamesOf<WeatherFamily>()))
      ->delimiter(',')
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false);
  randomize->callback([&command, options] {
    command = [options](const std::string&) { return RunRandomize(*options); };
  });
}

}  // namespace railcast
