#include "core/mesh/dae_text.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "core/mesh/mesh_format.h"

namespace railcast {
namespace {

std::string_view WithoutEndBlanks(std::string_view text) {
  constexpr std::string_view kXmlBlanks = " \t\r\n";
  text.remove_prefix(std::min(text.find_first_not_of(kXmlBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kXmlBlanks) + 1);
}

/// Takes what comes before `end` off the text, with `end` itself.
std::string_view TakeThrough(std::string_view& rest, std::string_view end) {
  const std::size_t place = rest.find(end);
  const std::string_view part =
      rest.substr(0, place == std::string_view::npos ? place : place + end.size());
  rest.remove_prefix(part.size());
  return part;
}

/// Takes a tag, which begins with "<", off the text and appends it with its attributes trimmed.
void AppendTag(std::string_view& rest, std::string& plain) {
  while (!rest.empty()) {
    const std::size_t stop = std::min(rest.find_first_of(">\"'"), rest.size() - 1);
    const char found = rest[stop];
    plain += rest.substr(0, stop + 1);
    rest.remove_prefix(stop + 1);
    if (found == '>') return;
    if (found != '"' && found != '\'') continue;
    std::string_view value = TakeThrough(rest, {&found, 1});
    const bool is_closed = value.ends_with(found);
    if (is_closed) value.remove_suffix(1);
    plain += WithoutEndBlanks(value);
    if (is_closed) plain += found;
  }
}

}  // namespace

std::string PlainDae(std::string bytes) {
  const std::string xml = AsUtf8(std::move(bytes));
  std::string plain;
  plain.reserve(xml.size());
  std::string_view rest = xml;
  while (!rest.empty()) {
    const std::string_view text = rest.substr(0, rest.find('<'));
    rest.remove_prefix(text.size());
    plain += WithoutEndBlanks(text);
    if (rest.starts_with("<!--")) {
      plain += TakeThrough(rest, "-->");
    } else if (rest.starts_with("<![CDATA[")) {
      plain += TakeThrough(rest, "]]>");
    } else if (rest.starts_with("<?")) {
      plain += TakeThrough(rest, "?>");
    } else {
      AppendTag(rest, plain);
    }
  }
  return plain;
}

}  // namespace railcast
