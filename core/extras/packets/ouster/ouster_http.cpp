#include "core/extras/packets/ouster/ouster_http.h"

#include <charconv>
#include <string>
#include <string_view>

#include "core/base/text.h"
#include "core/scenario/json_source.h"

namespace railcast {
namespace {

constexpr std::string_view kMetadata = "/api/v1/sensor/metadata";
constexpr std::string_view kConfig = "/api/v1/sensor/config";
constexpr std::string_view kCommand = "/api/v1/sensor/cmd/";
constexpr std::string_view kFirmware = "/api/v1/system/firmware";
constexpr std::string_view kUserData = "/api/v1/user/data";

HttpAnswer NotFound() {
  return {404, R"({"error": "not found"})"};
}

HttpAnswer Refused(const std::string& reason) {
  return {400, Json{{"error", reason}}.dump()};
}

/// A section of the metadata; nothing is there if there is none of that name.
HttpAnswer SectionAnswer(const Json& metadata, std::string_view name) {
  const auto it = metadata.find(std::string(name));
  return it == metadata.end() ? NotFound() : HttpAnswer{200, it->dump()};
}

/// Undoes the escapes of a URL; "+" stands for itself.
std::string Unescaped(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned code = 0;
    const std::string_view digits = text.substr(i, 3);
    const bool is_escape =
        digits.size() == 3 && digits[0] == '%' &&
        std::from_chars(digits.data() + 1, digits.data() + 3, code, 16).ptr == digits.data() + 3;
    plain += is_escape ? static_cast<char>(code) : text[i];
    i += is_escape ? 2 : 0;
  }
  return plain;
}

/// What keeps a configuration from being as asked; empty if it is as asked.
std::string Difference(const Json& config, const Json& asked) {
  for (const auto& [key, value] : asked.items()) {
    const bool is_here = key == "udp_dest" && value == "@auto";
    if (is_here || (config.contains(key) && config[key] == value)) continue;
    return key + " must be " + (config.contains(key) ? ValueText(config[key]) : "left out") +
           ", as railcast streams it (got " + ValueText(value) + ")";
  }
  return "";
}

HttpAnswer SetConfig(const Json& metadata, const std::string& text, const std::string& done) {
  const JsonText asked = ParseJson(text);
  if (!asked.json || !asked.json->is_object()) return Refused("must be an object of JSON");
  const std::string difference = Difference(metadata["config_params"], *asked.json);
  return difference.empty() ? HttpAnswer{200, done} : Refused(difference);
}

/// Commands as firmware before 3.1 has them.
HttpAnswer CommandAnswer(const Json& metadata, std::string_view command) {
  if (command == "get_config_param?args=active" || command == "get_config_param?args=staged") {
    return SectionAnswer(metadata, "config_params");
  }
  if (command == "set_udp_dest_auto" || command == "reinitialize" ||
      command == "save_config_params") {
    return {200, "{}"};
  }
  constexpr std::string_view kSet = "set_config_param?args=";
  if (!command.starts_with(kSet)) return NotFound();
  command.remove_prefix(kSet.size());
  const std::size_t plus = command.find('+');
  if (plus == std::string_view::npos) return Refused("must be a key, + and a value");
  const std::string key = Unescaped(command.substr(0, plus));
  const std::string value = Unescaped(command.substr(plus + 1));
  const std::string done = R"("set_config_param")";
  if (key == ".") return SetConfig(metadata, value, done);
  const JsonText parsed = ParseJson(value);
  // Escapes may stand for bytes that are no UTF-8.
  const Json asked{{key, parsed.json.value_or(Json(value))}};
  return SetConfig(metadata, asked.dump(-1, ' ', false, Json::error_handler_t::replace), done);
}

HttpAnswer AnswerToGet(const Json& metadata, std::string_view target) {
  const std::string_view path = target.substr(0, target.find('?'));
  if (path == kMetadata) return {200, metadata.dump()};
  if (path.starts_with(std::string(kMetadata) + "/")) {
    return SectionAnswer(metadata, path.substr(kMetadata.size() + 1));
  }
  if (path == kConfig) return SectionAnswer(metadata, "config_params");
  if (target.starts_with(kCommand)) {
    return CommandAnswer(metadata, target.substr(kCommand.size()));
  }
  if (path == kFirmware) {
    return {200, Json{{"fw", metadata["sensor_info"].value("image_rev", "")}}.dump()};
  }
  if (path != kUserData) return NotFound();
  const bool is_plain = target.size() == path.size();
  return {200, is_plain ? R"("")" : R"({"policy": "clear_on_config_delete", "value": ""})"};
}

}  // namespace

HttpAnswer AnswerAsOuster(const Json& metadata, const HttpRequest& request) {
  if (request.method == "GET") return AnswerToGet(metadata, request.target);
  const std::string_view path =
      std::string_view(request.target).substr(0, request.target.find('?'));
  if (path != kConfig) return NotFound();
  if (request.method == "POST" || request.method == "PUT") {
    return SetConfig(metadata, request.body, "{}");
  }
  return {405, R"({"error": "must be GET, POST or PUT"})"};
}

}  // namespace railcast
