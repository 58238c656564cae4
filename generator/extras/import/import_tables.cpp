#include <algorithm>
#include <cmath>
#include <iomanip>
#include <regex>
#include <sstream>
#include <utility>

#include "core/base/text.h"
#include "core/io/write_file.h"
#include "generator/extras/import/import_files.h"

namespace railcast {
namespace {

/// A text as a field of CSV.
std::string QuotedField(std::string text) {
  std::ranges::replace(text, '"', '\'');
  return '"' + text + '"';
}

std::string QualityCsv(const std::vector<ImportedLine>& lines) {
  std::ostringstream csv;
  csv << "line,length_m,points,elements,median_m,p99_m,largest_m,tightest_radius_before_m,"
         "tightest_radius_m,needed_radius_m,sign_changes_before_per_km,sign_changes_per_km,"
         "contradictions\n";
  for (const ImportedLine& line : lines) {
    const LineQuality& q = line.quality;
    csv << line.name << ',' << q.length_m << ',' << q.num_points << ',' << q.num_elements << ','
        << q.median_m << ',' << q.p99_m << ',' << q.largest_m << ',' << q.tightest_radius_before_m
        << ',' << q.tightest_radius_m << ',' << q.needed_radius_m << ','
        << q.sign_changes_before_per_km << ',' << q.sign_changes_per_km << ','
        << line.contradictions.size() << '\n';
  }
  return csv.str();
}

std::string QualityTable(const std::vector<ImportedLine>& lines) {
  std::ostringstream table;
  table << std::fixed
        << "| line | km | points off: median, 99 %, largest m | elements/km | tightest radius "
           "before, now, needed m | sign changes/km before, now |\n"
        << "|---|---|---|---|---|---|\n";
  for (const ImportedLine& line : lines) {
    const LineQuality& q = line.quality;
    table << "| " << line.name << " | " << std::setprecision(2) << 1e-3 * q.length_m << " | "
          << q.median_m << ", " << q.p99_m << ", " << q.largest_m << " | " << std::setprecision(1)
          << 1e3 * static_cast<double>(q.num_elements) / q.length_m << " | " << std::setprecision(0)
          << q.tightest_radius_before_m << ", " << q.tightest_radius_m << ", " << q.needed_radius_m
          << " | " << std::setprecision(1) << q.sign_changes_before_per_km << ", "
          << q.sign_changes_per_km << " |\n";
  }
  return table.str();
}

std::string HeightsCsv(const std::vector<ImportedLine>& lines) {
  std::ostringstream csv;
  csv << "line,points,median_m,p99_m,gradients,steepest_permil,gradient_smoothing_m,"
         "least_roundness\n";
  for (const ImportedLine& line : lines) {
    if (!line.height_quality) continue;
    const HeightQuality& q = *line.height_quality;
    csv << line.name << ',' << q.num_points << ',' << q.median_m << ',' << q.p99_m << ','
        << q.num_gradients << ',' << q.steepest_permil << ',' << line.alignment.gradient_smoothing_m
        << ',' << q.least_roundness << '\n';
  }
  return csv.str();
}

std::string TracksCsv(const std::vector<ImportedLine>& lines,
                      const std::vector<LineWorld>& worlds) {
  std::ostringstream csv;
  csv << "line,tracks,turnouts,median_shift_m,p95_shift_m,length_m,points,median_m,p99_m,"
         "crossings,switches,switches_made\n";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const SideTrackQuality& q = worlds[i].quality;
    csv << lines[i].name << ',' << q.num_tracks << ',' << q.num_turnouts << ','
        << QuantileOf(q.shifts_m, 0.5) << ',' << QuantileOf(q.shifts_m, 0.95) << ',' << q.length_m
        << ',' << q.distances_m.size() << ',' << QuantileOf(q.distances_m, 0.5) << ','
        << QuantileOf(q.distances_m, 0.99) << ',' << worlds[i].crossings.size() << ','
        << q.num_switches << ',' << worlds[i].switches.size() << '\n';
  }
  return csv.str();
}

std::string MovedCsv(const std::vector<ImportedLine>& lines, const std::vector<LineWorld>& worlds) {
  std::ostringstream csv;
  csv << "line,track,from_s_m,to_s_m,moved_m\n";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const MovedTrack& moved : MovedTracksOf(worlds[i])) {
      csv << lines[i].name << ',' << moved.name << ',' << RoundedTo(moved.begin_s_m, 100.0) << ','
          << RoundedTo(moved.end_s_m, 100.0) << ',' << RoundedTo(moved.most_m, 100.0) << '\n';
    }
  }
  return csv.str();
}

std::string MovedText(const std::vector<LineWorld>& worlds) {
  double length_m = 0.0;
  double most_m = 0.0;
  std::size_t num_stretches = 0;
  for (const LineWorld& world : worlds) {
    for (const MovedTrack& moved : MovedTracksOf(world)) {
      ++num_stretches;
      length_m += moved.end_s_m - moved.begin_s_m;
      most_m = std::max(most_m, moved.most_m);
    }
  }
  if (num_stretches == 0) return "";
  std::ostringstream text;
  text << std::fixed << std::setprecision(2)
       << "more than 0.5 m from where the map has it (moved.csv): " << 1e-3 * length_m << " km in "
       << num_stretches << " stretches, by " << most_m << " m at most\n\n";
  return text.str();
}

/// What beside a line is in no run of tracks; steps that follow each other for one reason are one.
std::vector<LeftOut> UnusedStretches(const std::vector<UnusedStep>& steps) {
  std::vector<LeftOut> stretches;
  for (const UnusedStep& step : steps) {
    const std::string what = step.kind + " track";
    const bool goes_on = !stretches.empty() && stretches.back().what == what &&
                         stretches.back().reason == step.reason &&
                         step.s_m.begin_s_m <= stretches.back().end_s_m &&
                         step.s_m.end_s_m >= stretches.back().begin_s_m;
    if (!goes_on) stretches.push_back({what, step.s_m.begin_s_m, step.s_m.end_s_m, step.reason});
    LeftOut& stretch = stretches.back();
    stretch.begin_s_m = std::min(stretch.begin_s_m, step.s_m.begin_s_m);
    stretch.end_s_m = std::max(stretch.end_s_m, step.s_m.end_s_m);
  }
  return stretches;
}

bool IsInPieces(const std::string& what) {
  constexpr auto kInMetres = std::to_array<std::string_view>({"tunnel", "bridge", "platform"});
  return !what.ends_with("track") && std::ranges::find(kInMetres, what) == kInMetres.end();
}

/// Kinds of rows in their order.
std::vector<std::string> KindsOf(const std::vector<AccountRow>& rows) {
  std::vector<std::string> kinds;
  for (const AccountRow& row : rows) {
    if (std::ranges::count(kinds, row.what) == 0) kinds.push_back(row.what);
  }
  return kinds;
}

/// A reason without the names of tracks, which differ from world to world.
std::string WithoutNames(const std::string& reason) {
  static const std::regex name("track [a-z]+_[0-9]+");
  return std::regex_replace(reason, name, "another track");
}

std::string AccountCsv(const std::vector<AccountRow>& rows) {
  std::ostringstream csv;
  csv << "what,place,unit,on_map,in_worlds,left_out,reasons\n" << std::fixed;
  for (const AccountRow& row : rows) {
    const bool is_pieces = IsInPieces(row.what);
    csv << std::setprecision(is_pieces ? 0 : 2) << row.what << ',' << QuotedField(row.place) << ','
        << (is_pieces ? "pieces" : "m") << ',' << row.on_map << ',' << row.in_worlds << ','
        << row.out() << ',';
    std::ostringstream reasons;
    reasons << std::fixed << std::setprecision(is_pieces ? 0 : 2);
    const char* separator = "";
    for (const auto& [reason, amount] : row.left_out) {
      reasons << std::exchange(separator, "; ") << amount << ": " << reason;
    }
    csv << QuotedField(reasons.str()) << '\n';
  }
  return csv.str();
}

std::string AccountTable(const std::vector<AccountRow>& rows) {
  std::ostringstream table;
  std::ostringstream losses;
  table << "| account.csv | on the map | in worlds | % |\n|---|---|---|---|\n";
  for (const std::string& kind : KindsOf(rows)) {
    const AccountRow sum = SumOf(rows, kind);
    const bool is_pieces = IsInPieces(kind);
    const double scale = is_pieces ? 1.0 : 1e-3;
    const char* unit = is_pieces ? "" : " km";
    for (std::ostringstream* text : {&table, &losses}) {
      *text << std::fixed << std::setprecision(is_pieces ? 0 : 2);
    }
    const int percent =
        sum.on_map > 0.0 ? static_cast<int>(std::floor(100.0 * sum.in_worlds / sum.on_map)) : 100;
    table << "| " << kind << " | " << scale * sum.on_map << unit << " | " << scale * sum.in_worlds
          << unit << " | " << percent << " |\n";
    std::vector<std::pair<double, std::string>> reasons;
    for (const auto& [reason, amount] : sum.left_out) reasons.emplace_back(amount, reason);
    std::ranges::sort(reasons, std::ranges::greater{});
    constexpr std::size_t kShown = 4;
    for (std::size_t i = 0; i < std::min(kShown, reasons.size()); ++i) {
      losses << "  " << kind << ", " << scale * reasons[i].first << unit << ": "
             << ShownLines(reasons[i].second) << '\n';
    }
  }
  if (losses.str().empty()) return table.str();
  return table.str() + "\ngreatest losses:\n" + losses.str();
}

std::string LeftOutLinesText(const std::vector<LeftOutLine>& left_out) {
  std::string text;
  for (const LeftOutLine& line : left_out) {
    text += "left out line " + line.track.name + " of " + NumberText(std::round(line.length_m)) +
            " m: " + ShownLines(line.reason) + "\n";
  }
  return text;
}

}  // namespace

std::string ContradictionsCsv(const std::vector<ImportedLine>& lines) {
  std::ostringstream csv;
  csv << std::setprecision(10) << "line,s_m,offset_m,longitude_deg,latitude_deg\n";
  for (const ImportedLine& line : lines) {
    for (const Contradiction& point : line.contradictions) {
      csv << line.name << ',' << point.s_m << ',' << point.offset_m << ','
          << point.geographic_deg.x() << ',' << point.geographic_deg.y() << '\n';
    }
  }
  return csv.str();
}

std::string LeftOutCsv(const LeftOutOfMap& left_out,
                       const std::vector<ImportedLine>& lines,
                       const std::vector<LineWorld>& worlds) {
  std::ostringstream csv;
  csv << "line,what,from_s_m,to_s_m,reason\n";
  const auto add = [&](const std::string& line, const LeftOut& thing) {
    csv << line << ',' << thing.what << ',' << RoundedTo(thing.begin_s_m, 100.0) << ','
        << RoundedTo(thing.end_s_m, 100.0) << ',' << QuotedField(thing.reason) << '\n';
  };
  for (const Remark& remark : left_out.remarks) {
    Remark placeless = remark;
    placeless.place.clear();
    csv << ',' << remark.type().name << ",,,"
        << QuotedField(remark.place + (remark.place.empty() ? "" : ": ") + placeless.Text())
        << '\n';
  }
  for (const LeftOutLine& line : left_out.lines)
    add(line.track.name, {"line", 0.0, line.length_m, line.reason});
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const LeftOut& thing : worlds[i].left_out) add(lines[i].name, thing);
    for (const LeftOut& thing : UnusedStretches(worlds[i].beside.unused)) add(lines[i].name, thing);
  }
  return csv.str();
}

AccountRow SumOf(const std::vector<AccountRow>& rows, const std::string& what) {
  AccountRow sum{what, ""};
  for (const AccountRow& row : rows) {
    if (row.what != what) continue;
    sum.on_map += row.on_map;
    sum.in_worlds += row.in_worlds;
    for (const auto& [reason, amount] : row.left_out) sum.left_out[WithoutNames(reason)] += amount;
  }
  return sum;
}

void WriteTables(const std::filesystem::path& out,
                 const std::vector<ImportedLine>& lines,
                 const std::vector<LineWorld>& worlds,
                 const std::vector<AccountRow>& account,
                 const LeftOutOfMap& left_out) {
  WriteFileWhole(out / "left_out.csv", LeftOutCsv(left_out, lines, worlds));
  WriteFileWhole(out / "moved.csv", MovedCsv(lines, worlds));
  WriteFileWhole(out / "tracks.csv", TracksCsv(lines, worlds));
  WriteFileWhole(out / "account.csv", AccountCsv(account));
  WriteFileWhole(out / "heights.csv", HeightsCsv(lines));
  WriteFileWhole(out / "lines.csv", QualityCsv(lines));
  WriteFileWhole(out / "contradictions.csv", ContradictionsCsv(lines));
}

std::string TablesText(const std::vector<ImportedLine>& lines,
                       const std::vector<LineWorld>& worlds,
                       const std::vector<AccountRow>& account,
                       const std::vector<LeftOutLine>& left_out) {
  return QualityTable(lines) + "\n" + AccountTable(account) + "\n" + MovedText(worlds) +
         LeftOutLinesText(left_out);
}

}  // namespace railcast
