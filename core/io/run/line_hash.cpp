#include "core/io/run/line_hash.h"

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"

namespace railcast {
namespace {

constexpr std::string_view kBegin = ",\"line_xxh3\":\"";
constexpr std::string_view kEnd = "\"}";

}  // namespace

std::string WithLineHash(std::string_view object) {
  Check(object.size() > 2 && object.ends_with('}'), "a line is an object with members");
  object.remove_suffix(1);
  std::string line(object);
  line += kBegin;
  line += ContentHash(object);
  return line += kEnd;
}

bool HasLineHash(std::string_view line) {
  return line.find(kBegin) != std::string_view::npos;
}

std::string LineHashFault(std::string_view line) {
  const std::size_t begin = line.rfind(kBegin);
  if (begin == std::string_view::npos) return "must end with line_xxh3, the hash of all before it";
  const std::string hash = ContentHash(line.substr(0, begin));
  std::string_view got = line.substr(begin + kBegin.size());
  if (got == hash + std::string(kEnd)) return "";
  if (got.ends_with(kEnd)) got.remove_suffix(kEnd.size());
  return "/line_xxh3: must be " + hash + ", that of all before it (got " + ShownText(got) + ")";
}

}  // namespace railcast
