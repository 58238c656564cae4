#include "analysis/frontier/table.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "analysis/frontier/pareto.h"

namespace railcast {
namespace {

std::string Padded(const char* format, double value) {
  std::array<char, 32> text{};
  if (std::isnan(value)) {
    std::snprintf(text.data(), text.size(), "%9s", "-");
  } else {
    std::snprintf(text.data(), text.size(), format, value);
  }
  return text.data();
}

std::string Percent(double share) {
  return Padded("%9.2f", 100.0 * share);
}
std::string Percent(const Matched& found) {
  return Percent(1.0 - MissedShare(found));
}
std::string Millimetres(double value_m) {
  return Padded("%9.2f", 1e3 * value_m);
}

std::string Name(const std::string& name) {
  std::string padded = name;
  padded.resize(std::max<std::size_t>(27, name.size()), ' ');
  return padded;
}

}  // namespace

std::string FrontierTable(const std::vector<RowResult>& results) {
  std::string text = Name("") +
                     "      p50      p99     time   recall   precis.   range    range   intens."
                     "  dropout    wires  further   second\n" +
                     Name("") +
                     "       ms       ms    x raw        %        %    p50 mm   p95 mm    p50 %"
                     "        %  found %  found %  found %\n";
  for (const RowResult& result : results) {
    text += Name(result.row.name) + Padded("%9.2f", result.p50_ms()) +
            Padded("%9.2f", result.p99_ms()) + Padded("%9.2f", result.ratio());
    if (result.difference) {
      const FrameDifference& d = *result.difference;
      text += Percent(d.reference_echoes) + Percent(d.echoes) + Millimetres(d.range_m.median) +
              Millimetres(d.range_m.p95) + Percent(d.intensity.median) + Percent(d.dropout_error) +
              Percent(d.thin) + Percent(d.further) + Percent(d.second);
    }
    text += "\n";
  }
  return text;
}

}  // namespace railcast
