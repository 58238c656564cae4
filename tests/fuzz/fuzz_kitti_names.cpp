#include <cstdint>
#include <string>

#include "core/base/error.h"
#include "core/io/cloud/kitti_names.h"
#include "tests/fuzz/fault_lines.h"

/// Entry point for libFuzzer: a configuration of semantic-kitti-api, of which names and colours are
/// read.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace railcast;
  try {
    const std::string yaml(reinterpret_cast<const char*>(data), size);
    const LabelTable names = ParseSemanticKittiNames(yaml, "fuzz");
    for (const Label& label : names.labels()) {
      Check(names.Find(label.id)->name == label.name && !label.name.empty(), "a label has a name");
    }
  } catch (const InputError& error) {
    CheckFaultLines(error.what());
  }
  return 0;
}
