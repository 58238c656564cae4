#include "generator/dataset/scenario_report.h"

#include <iomanip>
#include <numeric>
#include <sstream>
#include <utility>

namespace railcast {
namespace {

// The weather in words: "dry", "rain", "rain, fog", ...
std::string WeatherInWords(const Json& weather) {
  const auto is_positive = [&](const char* key) {
    const Json value = weather.value(key, Json());
    return value.is_number() && value.get<double>() > 0.0;
  };
  std::string words;
  const auto add = [&](bool applies, const char* word) {
    if (applies) words += (words.empty() ? "" : ", ") + std::string(word);
  };
  constexpr double kFoggy_m = 1000.0;  // International definition of fog.
  const Json visibility_m = weather.value("visibility_m", Json());
  const Json density = weather.value("fog_density_per_m", Json());
  constexpr double kFoggy_per_m = 3.0 / kFoggy_m;
  add(is_positive("rain_rate_mmph"), "rain");
  add(is_positive("snow_rate_mmph"), "snow");
  add((visibility_m.is_number() && visibility_m.get<double>() <= kFoggy_m) ||
          (density.is_number() && density.get<double>() >= kFoggy_per_m),
      "fog");
  return words.empty() ? "dry" : words;
}

// "  weather: dry 14, rain 6\n".
template <class Counts>
std::string CountsLine(const std::string& name, const Counts& counts) {
  std::string line = "  " + name + ":";
  const char* separator = " ";
  for (const auto& [word, count] : counts) {
    line += separator + word + " " + std::to_string(count);
    separator = ", ";
  }
  return line + "\n";
}

}  // namespace

void ScenarioReport::Add(const Json& record) {
  const auto split = ValueNamed<Split>(record.at("split").get<std::string>()).value();
  ++parts_.at(static_cast<std::size_t>(split));
  ++bases_[record.at("base").get<std::string>()];
  ++weathers_[WeatherInWords(record.at("weather"))];
  for (const auto& [name, value] : record.at("drawn").items()) {
    if (value.is_string() || value.is_boolean()) {
      ++drawn_[name][value.is_string() ? value.get<std::string>() : value.dump()];
    }
  }
  for (const Json& object : record.at("placed")) {
    const auto name = object.at("name").get<std::string>();
    ++placed_[name.substr(0, name.rfind('/'))];
  }
}

Json ScenarioReport::Write(const SplitSpec& split) const {
  const std::uint32_t num = std::accumulate(parts_.begin(), parts_.end(), std::uint32_t{0});
  const PerPart<double> shares = SharesOf(split);
  Json splits = Json::object();
  for (const auto& [value, name] : kEnumNames<Split>) {
    const auto part = static_cast<std::size_t>(value);
    const double share = num == 0 ? 0.0 : static_cast<double>(parts_[part]) / num;
    splits[std::string(name)] = {
        {"scenarios", parts_[part]}, {"share", share}, {"asked", shares[part]}};
  }
  return {{"num_scenarios", num}, {"splits", std::move(splits)},
          {"bases", bases_},      {"weathers", weathers_},
          {"drawn", drawn_},      {"placed", placed_}};
}

std::string ScenarioReport::Text(const SplitSpec& split) const {
  std::string text = PartsText(parts_, split);
  text += CountsLine("bases", bases_) + CountsLine("weathers", weathers_);
  for (const auto& [name, words] : drawn_) text += CountsLine(name, words);
  if (!placed_.empty()) text += CountsLine("placed", placed_);
  return text;
}

std::string PartsText(const PerPart<std::uint32_t>& parts, const SplitSpec& split) {
  const double num = std::accumulate(parts.begin(), parts.end(), 0.0);
  const PerPart<double> shares = SharesOf(split);
  std::ostringstream text;
  text << std::fixed << std::setprecision(1);
  for (const auto& [value, name] : kEnumNames<Split>) {
    const auto part = static_cast<std::size_t>(value);
    text << "  " << std::left << std::setw(6) << name << std::right << std::setw(9) << parts[part]
         << " scenarios, " << 100.0 * parts[part] / num << " % (asked for: " << 100.0 * shares[part]
         << " %)\n";
  }
  return text.str();
}

}  // namespace railcast
