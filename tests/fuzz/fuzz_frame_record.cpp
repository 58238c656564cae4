#include "core/io/run/frame_record.h"

#include <string_view>

#include "core/base/error.h"
#include "core/io/content_hash.h"
#include "core/io/record/record_text.h"
#include "tests/fuzz/fuzz_target.h"

/// a line of frames.jsonl as a resumed run reads it, without its hash,
/// which is added.
RAILCAST_FUZZ_TARGET(frame_record) {
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  static_cast<void>(railcast::ParseFrameLine(line));
  if (line.size() < 3 || !line.ends_with('}')) return 0;
  const auto record = railcast::ParseFrameLine(railcast::WithLineHash(line));
  if (!record) return 0;
  railcast::Check(railcast::ParseFrameLine(railcast::HashedRecordLine(*record)) == record,
                  "what is written reads the same");
  return 0;
}
