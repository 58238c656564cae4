#include "analysis/frontier/pareto.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace railcast {
namespace {

// Times and errors of two rows.
struct Standing {
  double time_a{}, time_b{}, error_a{}, error_b{};
};

std::optional<Standing> Compare(const RowResult& a,
                                const RowResult& b,
                                const FrontierError& error) {
  if (!a.difference || !b.difference) return {};
  const Standing standing{a.ratio(), b.ratio(), error.of(*a.difference), error.of(*b.difference)};
  if (std::isnan(standing.error_a) || std::isnan(standing.error_b)) return {};
  return standing;
}

// Whether a is faster and more accurate than b.
bool Defeats(const RowResult& a, const RowResult& b, const FrontierError& error) {
  const auto s = Compare(a, b, error);
  return s && s->time_a < s->time_b && s->error_a < s->error_b;
}

// Whether a is no worse than b in time and error, and better in one of them.
bool Beats(const RowResult& a, const RowResult& b, const FrontierError& error) {
  const auto s = Compare(a, b, error);
  return s && s->time_a <= s->time_b && s->error_a <= s->error_b &&
         (s->time_a < s->time_b || s->error_a < s->error_b);
}

bool IsCandidate(const RowResult& result, const FrontierError& error) {
  return result.row.group != RowGroup::kReference && result.row.group != RowGroup::kChosen &&
         result.difference && !std::isnan(error.of(*result.difference));
}

}  // namespace

std::vector<std::string> ParetoFront(const std::vector<RowResult>& results,
                                     const FrontierError& error) {
  std::vector<std::string> front;
  for (const RowResult& result : results) {
    const bool is_beaten = std::ranges::any_of(results, [&](const RowResult& other) {
      return IsCandidate(other, error) && Beats(other, result, error);
    });
    if (IsCandidate(result, error) && !is_beaten) front.push_back(result.row.name);
  }
  return front;
}

std::vector<Defeat> FindDefeats(const std::vector<RowResult>& results) {
  std::vector<Defeat> defeats;
  for (const FrontierError& error : kFrontierErrors) {
    for (const RowResult& brute_force : results) {
      if (brute_force.row.group != RowGroup::kBruteForce) continue;
      for (const RowResult& ours : results) {
        if (ours.row.group == RowGroup::kLadder && Defeats(brute_force, ours, error)) {
          defeats.push_back({brute_force.row.name, ours.row.name, error.name});
        }
      }
    }
  }
  return defeats;
}

std::string DefeatsText(const std::vector<RowResult>& results) {
  const auto has = [&](RowGroup group) {
    return std::ranges::any_of(results, [&](const RowResult& result) {
      return result.row.group == group && result.difference;
    });
  };
  if (!has(RowGroup::kBruteForce) || !has(RowGroup::kLadder)) {
    return "Brute force is not compared with the rungs: there must be rows of both.";
  }
  const std::vector<Defeat> defeats = FindDefeats(results);
  if (defeats.empty()) return "No row of brute force is faster and more accurate than a rung.";
  std::string text;
  for (const Defeat& defeat : defeats) {
    text += (text.empty() ? "Faster and more accurate than a rung: " : "; ") + defeat.brute_force +
            " than " + defeat.ours + " in " + defeat.error;
  }
  return text + ".";
}

}  // namespace railcast
