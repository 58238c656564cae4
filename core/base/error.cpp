#include "core/base/error.h"

#include <cstdio>
#include <cstdlib>

namespace railcast {

void ErrorList::ThrowIfAny() const {
  if (lines_.empty()) return;
  std::string all;
  for (const std::string& line : lines_) {
    if (!all.empty()) all += '\n';
    all += line;
  }
  throw InputError(all);
}

void Check(bool condition, const char* assumption, const char* file, int line) {
  if (condition) return;
  std::fprintf(stderr, "%s:%d: broken assumption: %s\n", file, line, assumption);
  std::abort();
}

}  // namespace railcast
