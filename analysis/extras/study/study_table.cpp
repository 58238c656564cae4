#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "analysis/detectability/detection_probability.h"
#include "analysis/extras/study/study_report.h"
#include "analysis/report/words.h"
#include "core/base/error.h"
#include "core/base/join.h"
#include "core/base/text.h"
#include "core/program/options.h"

namespace railcast {
namespace {

/// Observations that have the same values of some factors, by the factors' levels.
using TableCells = std::map<std::vector<std::size_t>, ObservedGroup>;

constexpr const char* kTooFewInCell = "too few";

TableCells CellsBy(const std::vector<const Factor*>& factors,
                   const std::vector<Observation>& observations) {
  TableCells cells;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    std::vector<std::size_t> levels;
    for (const Factor* factor : factors) levels.push_back(factor->level_of[i]);
    cells[levels].Add(observations[i]);
  }
  return cells;
}

bool IsDrawnForAll(const Factor& factor) {
  return std::ranges::find(factor.levels, kNotDrawn) == factor.levels.end();
}

// The kind of object first, then by weight; where none is weighed, names before thirds of numbers,
// and those with the fewest values first.
// What is drawn for some approaches only is a detail of another factor's value.
std::vector<const Factor*> FactorsBySize(const std::vector<Factor>& factors,
                                         const std::vector<FactorWeight>& weights) {
  std::vector<const Factor*> sorted;
  const auto add = [&](const Factor& factor) {
    if (IsDrawnForAll(factor) && std::ranges::find(sorted, &factor) == sorted.end()) {
      sorted.push_back(&factor);
    }
  };
  const auto add_named = [&](const std::string& name) {
    const auto named = std::ranges::find(factors, name, &Factor::name);
    if (named != factors.end()) add(*named);
  };
  add_named(kTarget);
  for (const FactorWeight& weight : weights) add_named(weight.name);
  if (!weights.empty()) return sorted;
  const auto num_targets = static_cast<std::ptrdiff_t>(sorted.size());
  for (const Factor& factor : factors) add(factor);
  std::stable_sort(sorted.begin() + num_targets, sorted.end(),
                   [](const Factor* one, const Factor* other) {
                     const auto key = [](const Factor& factor) {
                       return std::pair(!factor.numbers.empty(), factor.levels.size());
                     };
                     return key(*one) < key(*other);
                   });
  return sorted;
}

// "factor_object_person_posture" and "posture" for "object /person/posture".
TableColumn ColumnOfFactor(const Factor& factor) {
  TableColumn column{.key = "factor", .title = factor.name.substr(factor.name.rfind('/') + 1)};
  bool is_gap = true;
  for (const char letter : factor.name) {
    const bool is_plain =
        IsDigit(letter) || (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z');
    if (is_plain && is_gap) column.key += '_';
    if (is_plain) column.key += letter;
    is_gap = !is_plain;
  }
  return column;
}

// "12 cells: yes 7, no 2, not shown 1, too few 2."
std::string CountsText(const std::map<std::string, std::size_t>& num_by_words,
                       std::size_t num_cells,
                       std::size_t num_combinations) {
  std::string counts;
  for (const char* const words : {"yes", "no", "not shown", kTooFewInCell}) {
    const auto num = num_by_words.find(words);
    if (num == num_by_words.end()) continue;
    counts += std::string(counts.empty() ? " " : ", ") + words + " " + NumberText(num->second);
  }
  std::string text = NumberText(num_cells) + " cells:" + counts + ".";
  if (num_combinations == num_cells) return text;
  return text + " Combinations that did not occur: " + NumberText(num_combinations - num_cells) +
         ".";
}

}  // namespace

void AddTable(ProgramOptions& command, std::vector<std::string>& factors) {
  command
      .AddOption("--table", factors,
                 "Two or three factors of the table of verdicts, such as weather,target; "
                 "default: those that matter most")
      .SeparatedBy(',')
      .TakesOneWord();
}

void CheckTable(const std::vector<std::string>& names) {
  const std::set<std::string> different(names.begin(), names.end());
  const bool is_fit = different.size() == names.size() && names.size() >= 2 && names.size() <= 3;
  if (is_fit || names.empty()) return;
  throw InputError("--table: must be two or three different factors (got " +
                   Quoted(Join(names, ",")) + ")");
}

std::vector<const Factor*> NamedFactors(const std::vector<std::string>& names,
                                        const std::vector<Factor>& factors) {
  CheckTable(names);
  std::vector<const Factor*> named;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(factors, name, &Factor::name);
    if (found == factors.end()) {
      throw InputError("--table: must be factors of the study: " +
                       Join(factors, ", ", &Factor::name) + " (got " + Quoted(name) + ")");
    }
    named.push_back(&*found);
  }
  // Distances of one kind of object say nothing of another.
  const auto target = std::ranges::find(factors, kTarget, &Factor::name);
  if (!named.empty() && target != factors.end() &&
      std::ranges::find(named, &*target) == named.end()) {
    named.insert(named.begin(), &*target);
  }
  return named;
}

std::vector<const Factor*> LargestFactors(const std::vector<Observation>& observations,
                                          const std::vector<Factor>& factors,
                                          const std::vector<FactorWeight>& weights) {
  constexpr std::size_t kMostCells = 48;  // With its note, the table then is a page of paper.
  std::vector<const Factor*> chosen;
  std::size_t num_cells = 1;
  for (const Factor* factor : FactorsBySize(factors, weights)) {
    if (chosen.size() == 3) break;
    std::vector<const Factor*> finer = chosen;
    finer.push_back(factor);
    const std::size_t num = CellsBy(finer, observations).size();
    const bool leaves_enough = observations.size() >= DetectionFit::kMinTargets * num;
    if (num == num_cells || num > kMostCells || (chosen.size() == 2 && !leaves_enough)) continue;
    chosen = std::move(finer);
    num_cells = num;
  }
  return chosen.size() < 2 ? std::vector<const Factor*>() : chosen;
}

Section TableSection(const std::vector<Observation>& observations,
                     const std::vector<const Factor*>& factors) {
  Section section = SectionOf(kStudyWords, "verdict_by_condition");
  if (factors.empty()) return section;
  Table table = TableOf(kStudyWords, "verdict_by_condition");
  table.title = Join(factors, " × ", &Factor::name);
  const auto num_answers = static_cast<std::ptrdiff_t>(table.columns.size());
  std::size_t num_combinations = 1;
  for (const Factor* factor : factors) {
    table.columns.insert(table.columns.end() - num_answers, ColumnOfFactor(*factor));
    num_combinations *= factor->levels.size();
  }
  std::map<std::string, std::size_t> num_by_words;
  for (const auto& [levels, cell] : CellsBy(factors, observations)) {
    std::vector<Cell> row;
    for (std::size_t k = 0; k < factors.size(); ++k) {
      row.emplace_back(factors[k]->levels[levels[k]]);
    }
    Judgement answer = AnswerOf(cell);
    if (cell.num < DetectionFit::kMinTargets) answer.words = kTooFewInCell;
    ++num_by_words[answer.words];
    row.insert(row.end(), {std::move(answer), cell.num, cell.in_time_percent(),
                           DistanceOf90With95(cell.detected_m), cell.most_needed_m});
    table.rows.push_back(std::move(row));
  }
  section.paragraphs = {CountsText(num_by_words, table.rows.size(), num_combinations)};
  section.tables = {std::move(table)};
  return section;
}

}  // namespace railcast
