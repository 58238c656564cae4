#include "core/scenario/command_log.h"

#include <algorithm>
#include <fstream>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/scenario/command_reading.h"
#include "core/scenario/json_reader.h"

namespace railcast {
namespace {

struct LogHeader {
  int railcast_commands{};
  std::string scenario_xxh3;
};

void Describe(Archive& a, LogHeader& s) {
  a.Required("railcast_commands", s.railcast_commands, "Version of the log.", OneNumberOf({1, 2}));
  a.Required("scenario_xxh3", s.scenario_xxh3, "The scenario that was run.", NonEmptyString());
}

// About 100 years.
constexpr double kMaxTime_ns = 3.2e18;

/// Reads the count of the commands up to a line.
void ReadCount(JsonSource& source, const Node& node, std::size_t count) {
  std::uint64_t got = 0;
  ReadAs(source, node, got);
  if (!source.errors().empty() || got == count) return;
  source.Fault(node, "must be " + std::to_string(count) +
                         ", the count of the commands up to here: lines are missing or were added");
}

/// What the lines of a log have said so far.
class LogLines {
 public:
  void Read(JsonSource& source, const Node& root) {
    if (version_ == 0) {
      ReadHeader(source, root);
    } else if (is_ended_) {
      source.FaultWithoutValue(root, "must not come after the log's end");
    } else if (version_ > 1 && root.json->is_object() && root.json->contains("num_commands") &&
               root.json->size() == 1) {
      is_ended_ = true;
      ReadCount(source, root.Child("num_commands"), num_lines_);
    } else {
      ++num_lines_;
      ReadEntry(source, root);
    }
  }

  CommandLog Take(const std::string& shown) {
    if (version_ == 0) throw InputError(shown + ": is empty");
    if (version_ > 1 && !is_ended_) {
      throw InputError(shown + R"(: must end in {"num_commands":)" + std::to_string(num_lines_) +
                       "}, unless the run was killed or lines are missing");
    }
    return std::move(log_);
  }

 private:
  void ReadHeader(JsonSource& source, const Node& root) {
    if (!root.json->is_object() || !root.json->contains("railcast_commands")) {
      source.FaultWithoutValue(root, R"(must be {"railcast_commands": 2, "scenario_xxh3": ...})");
      return;
    }
    LogHeader header;
    if (auto list = source.PlainMembers(root)) {
      ReadMembers(source, root, std::move(*list), header);
    }
    version_ = header.railcast_commands;
    log_.scenario_xxh3 = header.scenario_xxh3;
  }

  void ReadEntry(JsonSource& source, const Node& root) {
    auto list = source.PlainMembers(root);
    if (!list) return;
    std::vector<std::string> keys = {"time_ns", "command"};
    if (version_ > 1) keys.insert(keys.begin(), "number");
    for (const std::string& key : keys) {
      if (!root.json->contains(key)) source.Missing(root, key);
    }
    for (const Member& member : list->members) {
      if (std::ranges::find(keys, member.key) != keys.end()) continue;
      source.FaultWithoutValue(member.value, Unknown("key", member.key, keys));
    }
    if (!source.errors().empty()) return;
    if (version_ > 1) ReadCount(source, root.Child("number"), num_lines_);
    std::uint64_t time_ns = 0;
    ReadAs(source, root.Child("time_ns"), time_ns, Limits{.at_most = kMaxTime_ns});
    CommandTag tag;
    auto command = ReadCommandObject(source, root.Child("command"), tag);
    if (!command || !source.errors().empty()) return;
    Add(source, root, {static_cast<std::int64_t>(time_ns), std::move(*command)});
  }

  void Add(JsonSource& source, const Node& root, TimedCommand command) {
    auto& commands = log_.commands;
    if (std::holds_alternative<Reset>(command.command)) {
      commands.clear();
    } else if (!commands.empty() && command.time_ns < commands.back().time_ns) {
      source.Fault(root.Child("time_ns"), "must be at least " +
                                              std::to_string(commands.back().time_ns) +
                                              ", that of the command before it");
    } else if (!std::holds_alternative<Step>(command.command)) {
      commands.push_back(std::move(command));
    }
  }

  CommandLog log_;
  int version_ = 0;  ///< 0 = the header is yet to come.
  std::size_t num_lines_ = 0;
  bool is_ended_ = false;
};

}  // namespace

std::string CommandLogHeader(const std::string& scenario_xxh3) {
  return Json{{"railcast_commands", 2}, {"scenario_xxh3", scenario_xxh3}}.dump() + "\n";
}

std::string CommandLogLine(const TimedCommand& command, std::size_t number) {
  return Json{{"number", number},
              {"time_ns", command.time_ns},
              {"command", CommandJson(command.command, {})}}
             .dump() +
         "\n";
}

std::string CommandLogEnd(std::size_t num_commands) {
  return Json{{"num_commands", num_commands}}.dump() + "\n";
}

std::string CommandLogText(const CommandLog& log) {
  std::string text = CommandLogHeader(log.scenario_xxh3);
  std::size_t number = 0;
  for (const TimedCommand& command : log.commands) text += CommandLogLine(command, ++number);
  return text + CommandLogEnd(number);
}

CommandLog ReadCommandLog(const std::filesystem::path& file, const std::vector<ModelSpec>& models) {
  std::ifstream stream = OpenInput(file);
  return ParseCommandLog(stream, ShownPath(file), models);
}

CommandLog ParseCommandLog(std::istream& stream,
                           const std::string& shown,
                           const std::vector<ModelSpec>& models) {
  LogLines lines;
  std::string line;
  for (std::size_t number = 1; std::getline(stream, line); ++number) {
    const std::string place = shown + ": line " + std::to_string(number);
    if (stream.eof()) throw InputError(place + ": must end in a line break");
    JsonSource source;
    source.types().Add(models);
    if (const auto root = source.OpenText(line, place)) lines.Read(source, *root);
    source.errors().ThrowIfAny();
  }
  return lines.Take(shown);
}

}  // namespace railcast
