#include "core/io/record/read_record.h"

#include <utility>

#include "core/base/error.h"
#include "core/scenario/descriptions.h"
#include "core/scenario/json_reader.h"

namespace railcast {
namespace {

Node Opened(JsonSource& source, const std::string& text, const std::string& place) {
  auto root = source.OpenText(text, place);
  const auto& faults = source.errors().faults();
  if (!root) throw InputError(place + ": is damaged: " + faults.front().rule);
  if (!faults.empty()) throw InputError({faults.front()});
  return *root;
}

}  // namespace

Json ReadRecordedJson(const std::string& text, const std::string& place) {
  JsonSource source;
  return *Opened(source, text, place).json;
}

void ReadRecordInto(const std::string& text, const std::string& place, const ValueRef& record) {
  JsonSource source;
  const Node root = Opened(source, text, place);
  if (auto list = source.PlainMembers(root)) {
    ReadMembers(source, root, std::move(*list), record);
  }
  if (!source.errors().empty()) throw InputError({source.errors().faults().front()});
}

}  // namespace railcast
