#include "tests/mutants/mutants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/write_file.h"
#include "tests/core/io/recording/read_all.h"

namespace railcast {
namespace {

bool IsEqual(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return a == b || std::abs(a - b) <= 1e-4;
}

/// The page from a heading to the next.
std::pair<std::size_t, std::size_t> SectionOf(const std::string& page, const std::string& heading) {
  const std::size_t begin = page.find("\n## " + heading + "\n");
  if (begin == std::string::npos) return {page.size(), page.size()};
  return {begin, std::min(page.find("\n## ", begin + 1), page.size())};
}

void AppendFrame(const RecordedFrame& recorded, std::vector<double>& values) {
  const Frame& frame = recorded.frame;
  values.insert(values.end(), {static_cast<double>(frame.rows), static_cast<double>(frame.columns),
                               static_cast<double>(recorded.is_grid),
                               static_cast<double>(frame.stamp_ns / kNsPerS),
                               static_cast<double>(frame.stamp_ns % kNsPerS)});
  if (recorded.has_pose) {
    const auto pose = frame.world_from_sensor.matrix();
    values.insert(values.end(), pose.data(), pose.data() + pose.size());
  }
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < frame.x.size(); ++i) {
    if (!std::isnan(frame.x[i])) seen.push_back(i);
  }
  ForEachField(frame, [&](std::string_view name, std::string_view, const auto& field) {
    if (!recorded.Has(name)) return;
    const std::size_t axis = name == "x" ? 0 : name == "y" ? 1 : name == "z" ? 2 : 3;
    const double origin_m = axis == 3 ? 0.0 : recorded.origin_m[static_cast<Eigen::Index>(axis)];
    // Times that text has in single precision are right to 10 ns.
    const double scale = name == "time_ns" ? 1e-5 : 1.0;
    auto value = values.insert(values.end(), seen.size(), 0.0);
    for (const std::size_t i : seen) *value++ = scale * static_cast<double>(field[i]) + origin_m;
  });
  for (const ForeignField& field : recorded.foreign) {
    values.insert(values.end(), field.values.begin(), field.values.end());
  }
}

}  // namespace

Mutants::Mutants(std::string reader, const std::string& file, std::string good, Reader read)
    : reader_(std::move(reader)),
      file_(folder_.path() / file),
      good_(std::move(good)),
      read_(std::move(read)),
      expected_(Read(good_)) {
  EXPECT_EQ(expected_.fault, "");
  EXPECT_FALSE(expected_.values.empty());
}

Reading Mutants::Read(const std::string& bytes) const {
  WriteFileWhole(file_, bytes);
  try {
    return read_(file_);
  } catch (const InputError& error) {
    EXPECT_STRNE(error.what(), "");
    return {.fault = error.what()};
  }
}

std::string Mutants::Try(const std::string& change,
                         const std::string& detail,
                         const std::string& bytes) {
  if (bytes == good_) return {};
  auto row = std::ranges::find(rows_, change, &Row::change);
  if (row == rows_.end()) row = rows_.insert(row, {.change = change});
  const Reading got = Read(bytes);
  std::set<std::string> told;
  for (const Remark& remark : got.remarks) {
    const auto same = [&](const Remark& other) {
      return other.kind == remark.kind && other.number == remark.number;
    };
    if (std::ranges::none_of(expected_.remarks, same)) told.emplace(remark.type().name);
  }
  if (!got.fault.empty()) {
    ++row->num_refused;
  } else if (!told.empty()) {
    ++row->num_told;
    row->remarks.merge(told);
  } else if (std::ranges::equal(got.values, expected_.values, IsEqual)) {
    ++row->num_equal;
  } else {
    row->silent.push_back(detail);
  }
  if (std::getenv("RAILCAST_SHOW_MUTANTS") != nullptr) {
    std::printf("%s | %s | %s | %s\n", reader_.c_str(), change.c_str(), detail.c_str(),
                !got.fault.empty() ? got.fault.c_str()
                : told.empty()     ? ""
                                   : told.begin()->c_str());
  }
  return got.fault;
}

void Mutants::TryHarmless(const std::string& change, const std::string& bytes) {
  EXPECT_NE(bytes, good_) << reader_ << ": " << change;
  EXPECT_EQ(Try(change, "", bytes), "") << reader_ << ": " << change;
}

std::size_t Mutants::num() const {
  std::size_t num = 0;
  for (const Row& row : rows_) {
    num += row.num_refused + row.num_told + row.num_equal + row.silent.size();
  }
  return num;
}

std::string Mutants::Rows() const {
  std::string text;
  std::size_t num_refused = 0, num_told = 0, num_equal = 0, num_silent = 0;
  for (const Row& row : rows_) {
    num_refused += row.num_refused;
    num_told += row.num_told;
    num_equal += row.num_equal;
    num_silent += row.silent.size();
    const auto excuse = excuses_.find(row.change);
    const bool is_excused = excuse != excuses_.end();
    std::string examples;
    for (std::size_t i = 0; i < std::min<std::size_t>(row.silent.size(), 12); ++i) {
      examples += "\n  " + row.silent[i];
    }
    EXPECT_EQ(!row.silent.empty(), is_excused)
        << reader_ << ": " << row.change << ": " << row.silent.size() << examples;
    if (row.silent.empty() && row.remarks.empty()) continue;
    std::string told = NumberText(row.num_told);
    for (const std::string& name : row.remarks) told += " `" + name + "`";
    text += "| " + reader_ + " | " + row.change + " | " + NumberText(row.num_refused) + " | " +
            told + " | " + NumberText(row.num_equal) + " | " + NumberText(row.silent.size()) +
            (is_excused ? ": " + excuse->second : "") + " |\n";
  }
  return text + "| " + reader_ + " | all | " + NumberText(num_refused) + " | " +
         NumberText(num_told) + " | " + NumberText(num_equal) + " | " + NumberText(num_silent) +
         " |\n";
}

Reading ReadRecordingWhole(const std::filesystem::path& source) {
  const auto recording = OpenRecording(source);
  Reading reading;
  for (const RecordedFrame& recorded : ReadAll(*recording)) AppendFrame(recorded, reading.values);
  reading.remarks = recording->info().remarks->List();
  return reading;
}

void CheckSection(const std::string& heading, const std::vector<const Mutants*>& all) {
  std::size_t num = 0;
  std::string rows;
  for (const Mutants* mutants : all) {
    num += mutants->num();
    rows += mutants->Rows();
  }
  const std::string text = "\n## " + heading + "\n\n" + NumberText(num) +
                           " mutants.\n\n| reader | change | refused | told | same values | "
                           "silent |\n|---|---|---|---|---|---|\n" +
                           rows;
  const std::string file = std::string(RAILCAST_SOURCE_DIR) + "/docs/results/mutants.md";
  std::ostringstream read;
  read << std::ifstream(file).rdbuf();
  std::string page = read.str();
  const auto [begin, end] = SectionOf(page, heading);
  if (std::getenv("RAILCAST_WRITE_MUTANTS") != nullptr) {
    std::ofstream(file) << page.replace(begin, end - begin, text);
  } else {
    EXPECT_EQ(page.substr(begin, end - begin), text);
  }
}

std::string Replaced(std::string text,
                     const std::string& part,
                     const std::string& other,
                     std::size_t number) {
  std::size_t place = text.find(part);
  for (; number > 0 && place != std::string::npos; --number) place = text.find(part, place + 1);
  return place == std::string::npos ? text : text.replace(place, part.size(), other);
}

std::string AllReplaced(std::string text, const std::string& part, const std::string& other) {
  for (std::size_t place = text.find(part); place != std::string::npos;
       place = text.find(part, place + other.size())) {
    text.replace(place, part.size(), other);
  }
  return text;
}

void TryChanges(Mutants& mutants, const std::vector<TextChange>& changes) {
  constexpr std::size_t kMostTimes = 40;
  for (const auto& [what, part, other] : changes) {
    for (std::size_t number = 0; number < kMostTimes; ++number) {
      mutants.Try(what, part + " as " + other + ", " + NumberText(number),
                  Replaced(mutants.good(), part, other, number));
    }
    mutants.Try(what + " everywhere", part + " as " + other,
                AllReplaced(mutants.good(), part, other));
  }
}

void TryCuts(Mutants& mutants, std::size_t step) {
  const std::string& good = mutants.good();
  for (std::size_t place = 1; place < good.size(); place += step) {
    mutants.Try("cut off", NumberText(place), good.substr(0, place));
  }
  for (std::size_t num = 1; num < 9; ++num) {
    mutants.Try("cut off", "last " + NumberText(num), good.substr(0, good.size() - num));
  }
  mutants.Try("line ends of Windows put in", "all", AllReplaced(good, "\n", "\r\n"));
  for (std::size_t place = step; place < good.size(); place += step) {
    mutants.Try("a byte lost", NumberText(place), std::string(good).erase(place, 1));
  }
}

}  // namespace railcast
