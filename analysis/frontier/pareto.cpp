#include "analysis/frontier/pareto.h"

#include <cmath>
#include <optional>

namespace railcast {
namespace {

// Both rows' times and errors, if they have any.
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

// Whether a has at most b's time and error, and less of one of them.
bool Beats(const RowResult& a, const RowResult& b, const FrontierError& error) {
  const auto s = Compare(a, b, error);
  return s && s->time_a <= s->time_b && s->error_a <= s->error_b &&
         (s->time_a < s->time_b || s->error_a < s->error_b);
}

bool IsCandidate(const RowResult& result, const FrontierError& error) {
  return result.row.group != RowGroup::kReference && result.difference &&
         !std::isnan(error.of(*result.difference));
}

}  // namespace

std::vector<bool> ParetoFront(const std::vector<RowResult>& results, const FrontierError& error) {
  std::vector<bool> is_on_front;
  for (const RowResult& result : results) {
    bool is_unbeaten = IsCandidate(result, error);
    for (const RowResult& other : results) {
      if (IsCandidate(other, error) && Beats(other, result, error)) is_unbeaten = false;
    }
    is_on_front.push_back(is_unbeaten);
  }
  return is_on_front;
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

std::string DefeatsText(const std::vector<Defeat>& defeats) {
  if (defeats.empty()) return "no row of brute force is faster and more accurate than a rung\n";
  std::string text = "faster and more accurate than a rung:\n";
  for (const Defeat& defeat : defeats) {
    text += "  " + defeat.error + ": " + defeat.brute_force + " beats " + defeat.ours + "\n";
  }
  return text;
}

}  // namespace railcast
