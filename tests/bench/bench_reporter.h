#pragma once

#include <benchmark/benchmark.h>

#include <cstdio>

#include "core/trace/trace_program.h"

namespace railcast {

/// Google Benchmark's table under a first line of our own.
///
/// The library's own first lines warn of a debug build, which is how Debian builds the library and
/// says nothing of the code that is measured.
class BenchReporter : public benchmark::ConsoleReporter {
 public:
  bool ReportContext(const Context& context) override {
    constexpr double kMega = 1e6;
    std::printf("%d cores of %.0f MHz; Embree %s, %s\n", context.cpu_info.num_cpus,
                context.cpu_info.cycles_per_second / kMega, EmbreeVersion().c_str(),
                IsaInUse("").c_str());
    name_field_width_ = context.name_field_width;
    printed_header_ = false;
    prev_counters_.clear();
    return true;
  }
};

}  // namespace railcast
