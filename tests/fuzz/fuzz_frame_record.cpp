#include "generator/sequence/frame_record.h"

#include <cstdint>
#include <string_view>

#include "core/base/error.h"

/// Entry point for libFuzzer: a line of frames.jsonl as a resumed run reads it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto record =
      railcast::ParseFrameLine(std::string_view(reinterpret_cast<const char*>(data), size));
  if (!record) return 0;
  railcast::Check(railcast::ParseFrameLine(railcast::FrameRecordLine(*record)) == record,
                  "what is written reads the same");
  return 0;
}
