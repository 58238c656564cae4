#include "core/scenario/command_log.h"

#include <fstream>
#include <optional>
#include <sstream>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/scenario/command_reading.h"
#include "core/scenario/json_reader.h"

namespace railcast {
namespace {

struct Header {
  int railcast_commands{};
  std::string scenario_xxh3;
};

template <class Archive>
void Describe(Archive& a, Header& s) {
  a.Required("railcast_commands", s.railcast_commands, "Version of the log.", OneNumberOf({1}));
  a.Required("scenario_xxh3", s.scenario_xxh3, "The scenario that was run.", NonEmptyString());
}

// About 100 years.
constexpr double kMaxTime_ns = 3.2e18;

std::optional<TimedCommand> ReadEntry(JsonSource& source, const Node& root) {
  auto list = source.PlainMembers(root);
  if (!list) return std::nullopt;
  for (const char* key : {"time_ns", "command"}) {
    if (!root.json->contains(key)) source.Missing(root, key);
  }
  for (const Member& member : list->members) {
    if (member.key == "time_ns" || member.key == "command") continue;
    source.FaultWithoutValue(member.value, Unknown("key", member.key, {"time_ns", "command"}));
  }
  if (!source.errors().empty()) return std::nullopt;
  std::uint64_t time_ns = 0;
  ReadValue(source, root.Child("time_ns"), time_ns, Limits{.at_most = kMaxTime_ns});
  CommandTag tag;
  auto command = ReadCommandObject(source, root.Child("command"), tag);
  if (!command || !source.errors().empty()) return std::nullopt;
  return TimedCommand{static_cast<std::int64_t>(time_ns), std::move(*command)};
}

}  // namespace

std::string CommandLogHeader(const std::string& scenario_xxh3) {
  return Json{{"railcast_commands", 1}, {"scenario_xxh3", scenario_xxh3}}.dump() + "\n";
}

std::string CommandLogLine(const TimedCommand& command) {
  if (std::holds_alternative<Step>(command.command)) return "";
  return Json{{"time_ns", command.time_ns}, {"command", CommandJson(command.command, {})}}.dump() +
         "\n";
}

std::string CommandLogText(const CommandLog& log) {
  std::string text = CommandLogHeader(log.scenario_xxh3);
  for (const TimedCommand& command : log.commands) text += CommandLogLine(command);
  return text;
}

CommandLog ReadCommandLog(const std::filesystem::path& file, const std::vector<ModelSpec>& models) {
  std::ifstream stream = OpenInput(file);
  return ParseCommandLog(stream, ShownPath(file), models);
}

CommandLog ParseCommandLog(std::istream& stream,
                           const std::string& shown,
                           const std::vector<ModelSpec>& models) {
  CommandLog log;
  std::string line;
  std::size_t number = 0;
  while (std::getline(stream, line)) {
    ++number;
    const std::string place = shown + ": line " + std::to_string(number);
    if (stream.eof()) throw InputError(place + ": must end in a line break");
    JsonSource source;
    source.types().Add(models);
    const auto root = source.OpenText(line, place);
    if (root && number == 1 &&
        !(root->json->is_object() && root->json->contains("railcast_commands"))) {
      source.FaultWithoutValue(*root, R"(must be {"railcast_commands": 1, "scenario_xxh3": ...})");
    } else if (root && number == 1) {
      Header header;
      if (auto list = source.PlainMembers(*root)) {
        ReadMembers(source, *root, std::move(*list), header);
      }
      log.scenario_xxh3 = header.scenario_xxh3;
    } else if (root) {
      auto entry = ReadEntry(source, *root);
      const bool is_back = entry && !log.commands.empty() &&
                           entry->time_ns < log.commands.back().time_ns &&
                           !std::holds_alternative<Reset>(entry->command);
      if (is_back) {
        source.Fault(root->Child("time_ns"), "must be at least " +
                                                 std::to_string(log.commands.back().time_ns) +
                                                 ", that of the command before it");
      } else if (entry && std::holds_alternative<Reset>(entry->command)) {
        log.commands.clear();
      } else if (entry && !std::holds_alternative<Step>(entry->command)) {
        log.commands.push_back(std::move(*entry));
      }
    }
    source.errors().ThrowIfAny();
  }
  if (number == 0) throw InputError(shown + ": is empty");
  return log;
}

}  // namespace railcast
