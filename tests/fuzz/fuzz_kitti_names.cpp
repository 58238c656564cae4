#include <string>

#include "core/base/error.h"
#include "core/io/cloud/kitti_names.h"
#include "tests/fuzz/fault_lines.h"
#include "tests/fuzz/fuzz_target.h"

/// a configuration of semantic-kitti-api, of which names and colours are
/// read.
RAILCAST_FUZZ_TARGET(kitti_names) {
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
