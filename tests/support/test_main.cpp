// The main function of the test programs. --tests_of=FILE runs only the tests whose sources FILE
// names, an absolute path a line: one program holds the tests of many folders.

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>
#include <string>

namespace {

// "Suite.Test:..." of every test in one of `sources`.
std::string FilterOf(const std::set<std::filesystem::path>& sources) {
  std::string filter;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int s = 0; s < all.total_test_suite_count(); ++s) {
    const testing::TestSuite& suite = *all.GetTestSuite(s);
    for (int t = 0; t < suite.total_test_count(); ++t) {
      const testing::TestInfo& test = *suite.GetTestInfo(t);
      if (sources.contains(std::filesystem::path(test.file()).lexically_normal()))
        filter += std::string(suite.name()) + "." + test.name() + ":";
    }
  }
  return filter;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  constexpr const char* kOption = "--tests_of=";
  for (int a = 1; a < argc; ++a) {
    if (std::strncmp(argv[a], kOption, std::strlen(kOption)) != 0) continue;
    std::ifstream list(argv[a] + std::strlen(kOption));
    std::set<std::filesystem::path> sources;
    for (std::string line; std::getline(list, line);) sources.insert(line);
    const std::string filter = FilterOf(sources);
    if (filter.empty()) {
      std::cerr << argv[a] << ": no test is of a source that this file names\n";
      return 1;
    }
    // A filter of the caller's stays: it chooses among all tests, as if there were no list.
    if (testing::GTEST_FLAG(filter) == "*") testing::GTEST_FLAG(filter) = filter;
  }
  return RUN_ALL_TESTS();
}
