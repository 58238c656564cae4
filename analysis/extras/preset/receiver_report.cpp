#include <string>
#include <utility>

#include "analysis/extras/preset/receiver_figures.h"
#include "analysis/report/chart_columns.h"
#include "analysis/report/words.h"
#include "core/base/text.h"

namespace railcast {

extern const char* const kPresetWords;

Section MakeReceiverSection(const ReceiverFigures& figures) {
  constexpr double kPercent = 100.0;
  constexpr double kMm = 1e3;
  Table table = TableOf(kPresetWords, "receiver");
  const auto add = [&](std::string name, const char* unit, double scale, const TwoDeviations& of) {
    table.rows.push_back({std::move(name), unit, Scaled(of.robust, scale), Scaled(of.rms, scale)});
  };
  const auto add_one = [&](const char* name, const char* unit, double scale, const Estimate& of) {
    table.rows.push_back({name, unit, Scaled(of, scale), std::string()});
  };
  if (figures.has_moved) {
    for (const char* name : {"intensity from turn to turn", "range from turn to turn"}) {
      table.rows.push_back({name, std::string(), std::string("moving"), std::string("moving")});
    }
  } else {
    add("intensity from turn to turn", "%", kPercent, figures.intensity_noise);
    add("range from turn to turn", "mm", kMm, figures.range_noise_m);
  }
  add_one("gain of single channels", "%", kPercent, figures.channel_gain);
  add_one("of these, at all ranges", "%", kPercent, figures.gain_at_all_ranges);
  add_one("of these, by range", "%", kPercent, figures.gain_by_range);
  for (std::size_t lag = 0; lag < figures.texture.size(); ++lag) {
    add("texture at " + ShortText(kTextureLags_m.at(lag)) + " m", "", 1.0, figures.texture.at(lag));
  }
  add_one("lost at depth jumps of 3 to 10 m", "%", kPercent, figures.jumps.share);
  add_one("firings lost at an edge: base", "", 1.0, figures.jumps.base);
  add_one("firings lost at an edge: b", "mm", kMm, figures.jumps.common_m);
  add_one("firings lost at an edge: b more, near side last", "mm", kMm, figures.jumps.aside_m);
  add_one("interior holes", "%", kPercent, figures.holes);
  Section section =
      SectionOf(kPresetWords, "receiver", {{"has_no_turns", figures.range_noise_m.rms.num == 0}});
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace railcast
