#include "core/trace/trace_program.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace railcast {
namespace {

TEST(TraceProgram, IsTheOneThatIsAskedFor) {
  EXPECT_EQ(IsaInUse("sse4.2"), "sse4.2");
}

// Compares with the compiler's own detection of the processor's features.
TEST(TraceProgram, UsesTheBestOfTheMachine) {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl")) {
    EXPECT_EQ(IsaInUse(""), "avx512");
  } else if (__builtin_cpu_supports("avx2")) {
    EXPECT_EQ(IsaInUse(""), "avx2");
  } else {
    EXPECT_NE(IsaInUse(""), "");
  }
#else
  EXPECT_NE(IsaInUse(""), "");
#endif
}

TEST(TraceProgram, RefusesWhatTheMachineLacks) {
  try {
    (void)IsaInUse("avx1024");
    FAIL() << "no machine has it";
  } catch (const InputError& error) {
    const std::string line = error.what();
    EXPECT_TRUE(line.starts_with("isa: must be an instruction set of this machine, one of sse2, "))
        << line;
    EXPECT_TRUE(line.ends_with(" (got avx1024)")) << line;
  }
}

TEST(TraceProgram, HasAVersionOfThreeNumbers) {
  const std::string version = EmbreeVersion();
  EXPECT_TRUE(version.starts_with("3.") || version.starts_with("4.")) << version;
  EXPECT_EQ(std::count(version.begin(), version.end(), '.'), 2) << version;
}

}  // namespace
}  // namespace railcast
