// docs/accuracy.md lists every effect with the figure that backs it and the test that holds the
// figure. These tests read the page, the table of effects and the sources of the tests.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core/detect/detector/effect_table.h"

namespace railcast {
namespace {

std::string TextOf(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// A row of the page's table.
struct Claim {
  std::string effect;
  std::string figure;
  std::string tests;
};

std::vector<Claim> ReadClaims() {
  const std::string page = TextOf(RAILCAST_SOURCE_DIR "/docs/accuracy.md");
  const std::size_t begin = page.find("### Each effect\n");
  std::istringstream lines(begin == std::string::npos ? "" : page.substr(begin));
  const std::regex row(R"(\| `([a-z_]+)` \| (.+) \| (.+) \|)");
  std::vector<Claim> claims;
  for (std::string line; std::getline(lines, line);) {
    if (std::smatch cells; std::regex_match(line, cells, row)) {
      claims.push_back({cells[1], cells[2], cells[3]});
    } else if (!claims.empty()) {
      break;  // The table ends.
    }
  }
  return claims;
}

/// The names Suite.Test of all tests in C++.
std::set<std::string> ReadTestNames() {
  const std::regex test(R"(\nTEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\))");
  std::set<std::string> names;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(RAILCAST_SOURCE_DIR "/tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = TextOf(entry.path());
    for (std::sregex_iterator found(text.begin(), text.end(), test), end; found != end; ++found) {
      names.insert((*found)[1].str() + "." + (*found)[2].str());
    }
  }
  return names;
}

bool IsThere(const std::string& pattern, const std::set<std::string>& names) {
  if (!pattern.ends_with('*')) return names.contains(pattern);
  const std::string begin = pattern.substr(0, pattern.size() - 1);
  const auto found = names.lower_bound(begin);
  return found != names.end() && found->starts_with(begin);
}

TEST(EffectClaims, HaveARowForEveryEffectAndNoOther) {
  std::vector<std::string> claimed;
  for (const Claim& claim : ReadClaims()) claimed.push_back(claim.effect);
  EXPECT_EQ(claimed, EffectNames());
}

TEST(EffectClaims, HaveAFigureEach) {
  for (const Claim& claim : ReadClaims()) {
    EXPECT_TRUE(std::ranges::any_of(
        claim.figure, [](char letter) { return std::isdigit(static_cast<unsigned char>(letter)); }))
        << claim.effect << ": " << claim.figure;
  }
}

TEST(EffectClaims, NameTestsThatAreThere) {
  const std::set<std::string> names = ReadTestNames();
  const std::regex quoted("`([^`]+)`");
  for (const Claim& claim : ReadClaims()) {
    std::size_t num = 0;
    for (std::sregex_iterator found(claim.tests.begin(), claim.tests.end(), quoted), end;
         found != end; ++found, ++num) {
      EXPECT_TRUE(IsThere((*found)[1], names)) << claim.effect << ": " << (*found)[1];
    }
    EXPECT_GE(num, 1U) << claim.effect;
  }
}

}  // namespace
}  // namespace railcast
