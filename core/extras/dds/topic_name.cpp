#include <algorithm>
#include <string_view>

#include "core/extras/dds/participant.h"

namespace railcast::dds {
namespace {

bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}

bool IsInName(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || IsDigit(c);
}

}  // namespace

bool IsTopicName(std::string_view name) {
  while (name.starts_with('/')) {
    name.remove_prefix(1);
    const std::string_view part = name.substr(0, name.find('/'));
    if (part.empty() || IsDigit(part.front()) || !std::ranges::all_of(part, IsInName)) return false;
    name.remove_prefix(part.size());
    if (name.empty()) return true;
  }
  return false;
}

}  // namespace railcast::dds
