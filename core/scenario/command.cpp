#include "core/scenario/command.h"

#include <utility>

#include "core/scenario/command_reading.h"
#include "core/scenario/descriptions.h"
#include "core/scenario/json_reader.h"
#include "core/scenario/json_writer.h"

namespace railcast {

// The key "command" distinguishes commands. "type" is not used, since objects have it as well.
template <class T>
inline constexpr const char* kCommandName = nullptr;
template <>
inline constexpr const char* kCommandName<SetSpeed> = "set_speed";
template <>
inline constexpr const char* kCommandName<Brake> = "brake";
template <>
inline constexpr const char* kCommandName<Stop> = "stop";
template <>
inline constexpr const char* kCommandName<PlaceObject> = "place_object";
template <>
inline constexpr const char* kCommandName<RemoveObject> = "remove_object";
template <>
inline constexpr const char* kCommandName<SetWeather> = "set_weather";
template <>
inline constexpr const char* kCommandName<Step> = "step";
template <>
inline constexpr const char* kCommandName<Reset> = "reset";

// No railway vehicle exceeds the upper limit: magnetic track brakes reach 3 m/s^2. At a rate below
// the lower limit, a change of speed would take hours or days.
[[nodiscard]] inline Limits AccelerationLimits() {
  return Within(1e-3, 10);
}

void Describe(Archive& a, SetSpeed& s) {
  a.Required("speed_mps", s.speed_mps, "Speed to be reached and then kept.", Within(0, 200));
  a.Optional("acceleration_mps2", s.acceleration_mps2,
             "Magnitude of the acceleration or deceleration on the way there.",
             AccelerationLimits());
}

void Describe(Archive& a, Brake& s) {
  a.Optional("deceleration_mps2", s.deceleration_mps2, "To a standstill.", AccelerationLimits());
}

void Describe(Archive&, Stop&) {}

void Describe(Archive& a, PlaceObject& s) {
  a.Required("object", s.object, "As in world.objects.");
}

void Describe(Archive& a, RemoveObject& s) {
  a.Required("name", s.name, "Name of the object.", NonEmptyString());
}

void Describe(Archive& a, SetWeather& s) {
  a.Required("weather", s.weather, "A whole section: what is left out takes its default.");
}

void Describe(Archive&, Step&) {}

void Describe(Archive&, Reset&) {}

namespace {

template <class Alternatives>
struct Names;
template <class... Ts>
struct Names<std::variant<Ts...>> {
  static std::vector<std::string> All() { return {kCommandName<Ts>...}; }

  // Calls `read` with a value of the type of that name.
  template <class Reading>
  static void With(const std::string& name, const Reading& read) {
    const auto read_if = [&]<class T>(T value) {
      if (name == kCommandName<T>) read(std::move(value));
    };
    (read_if(Ts{}), ...);
  }
};

constexpr double kMaxId = 0x1p53;  // Most programs read JSON numbers as doubles.

// A hostile line may have hundreds of faults; the sender needs only the first few.
std::vector<std::string> FirstFew(std::vector<std::string> faults) {
  constexpr std::size_t kMaxFaults = 8;
  constexpr std::size_t kMaxLength = 300;
  if (faults.size() > kMaxFaults) {
    const std::size_t num_more = faults.size() - kMaxFaults;
    faults.resize(kMaxFaults);
    faults.push_back("command: " + std::to_string(num_more) + " more");
  }
  for (std::string& fault : faults) {
    if (fault.size() <= kMaxLength) continue;
    std::size_t end = kMaxLength;
    // Do not cut within a UTF-8 character of several bytes.
    while (end > 0 && (static_cast<unsigned char>(fault[end]) & 0xC0U) == 0x80U) --end;
    fault = fault.substr(0, end) + "...";
  }
  return faults;
}

// Refuses meshes: a mesh is read from a file, and the sender of a command must not choose files.
bool PlacesMesh(JsonSource& source, const Node& command) {
  if (!command.json->contains("object")) return false;
  const Node object = command.Child("object");
  if (!object.json->is_object() || object.json->value("type", Json()) != "mesh") return false;
  source.Fault(object.Child("type"), "must be no mesh, since a command reads no files");
  return true;
}

// Reads the session and the id, of which neither may be given alone. Without a session, a restarted
// client could take the acknowledgement of an old command with the same id for that of a new one.
void ReadTag(JsonSource& source, const Node& object, JsonReader& reader, CommandTag& tag) {
  const auto read = [&](const char* key, auto& value, KeyDoc doc, const auto& rule) {
    const std::size_t num_faults = source.errors().size();
    reader.Optional(key, value, doc, rule);
    if (source.errors().size() > num_faults) value.reset();
  };
  read("session", tag.session, "Chosen anew at each start of a client.", NonEmptyString());
  read("id", tag.id, "Comes back in the acknowledgement.", Limits{.at_most = kMaxId});
  if (tag.session && tag.session->size() > kMaxSessionBytes) {
    source.Fault(object.Child("session"),
                 "must have at most " + std::to_string(kMaxSessionBytes) + " bytes");
    tag.session.reset();
  }
  const bool has_session = object.json->contains("session");
  const bool has_id = object.json->contains("id");
  if (has_id && !has_session) {
    source.FaultWithoutValue(object.Child("id"),
                             "must be given with session, which a client chooses when it starts");
  }
  if (has_session && !has_id)
    source.FaultWithoutValue(object.Child("session"), "must be given with id");
}

}  // namespace

std::optional<Command> ReadCommandObject(JsonSource& source, const Node& object, CommandTag& tag) {
  auto list = source.PlainMembers(object);
  if (!list) return std::nullopt;
  const std::size_t num_faults = source.errors().size();
  JsonReader reader(source, object, std::move(*list));
  ReadTag(source, object, reader, tag);
  // Without the command's name the other keys of the object cannot be checked.
  if (!object.json->contains("command")) {
    source.Missing(object, "command");
    return std::nullopt;
  }
  std::string name;
  reader.Required("command", name, "What to do.", OneOf(Names<Command>::All()));
  if (name.empty() || PlacesMesh(source, object)) return std::nullopt;
  std::optional<Command> command;
  Names<Command>::With(name, [&](auto value) {
    Describe(reader, value);
    command = std::move(value);
  });
  reader.Finish();
  if (source.errors().size() > num_faults) return std::nullopt;
  return command;
}

CommandLine ReadCommand(std::string_view line, const std::vector<ModelSpec>& models) {
  CommandLine result;
  if (line.ends_with('\n')) line.remove_suffix(1);
  if (line.size() > kMaxCommandBytes) {
    result.faults.push_back("command: must be at most " + std::to_string(kMaxCommandBytes) +
                            " bytes long (got " + std::to_string(line.size()) + ")");
    return result;
  }
  JsonSource source;
  source.types().Add(models);
  if (const auto root = source.OpenText(std::string(line), "command")) {
    result.command = ReadCommandObject(source, *root, result.tag);
  }
  result.faults = FirstFew(source.errors().lines());
  if (!result.faults.empty()) result.command.reset();
  return result;
}

std::string CommandName(const Command& command) {
  return std::visit([]<class T>(const T&) { return kCommandName<T>; }, command);
}

Json CommandJson(const Command& command, const CommandTag& tag) {
  Json json = Json::object();
  if (tag.session) json["session"] = *tag.session;
  if (tag.id) json["id"] = *tag.id;
  json["command"] = CommandName(command);
  std::visit(
      [&](auto value) {  // A copy: descriptions take mutable values because the reader fills them.
        const Json keys = JsonWriter::Write(value);
        json.update(keys);
      },
      command);
  return json;
}

std::string WriteCommand(const Command& command, const CommandTag& tag) {
  return CommandJson(command, tag).dump();
}

}  // namespace railcast
