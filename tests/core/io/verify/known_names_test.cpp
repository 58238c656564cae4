#include "core/io/verify/known_names.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

namespace railcast {
namespace {

/// Whether names are known as a set of them would have it, after each of them.
void ExpectAsASet(const std::vector<std::string>& names, const std::vector<std::string>& asked) {
  KnownNames known;
  std::set<std::string> set;
  for (const std::string& name : names) {
    known.insert(name);
    set.insert(name);
    for (const std::string& each : asked) {
      EXPECT_EQ(known.contains(each), set.contains(each)) << each << " after " << name;
    }
  }
}

std::string NumberedCloud(const std::string& number) {
  return "frames/" + number + ".pcd";
}

TEST(KnownNames, AreTheNumbersThatWereGiven) {
  const std::vector<std::string> all = {NumberedCloud("000002"),  NumberedCloud("000003"),
                                        NumberedCloud("000005"),  NumberedCloud("000007"),
                                        NumberedCloud("000008"),  NumberedCloud("000009"),
                                        NumberedCloud("000012"),  NumberedCloud("999999"),
                                        NumberedCloud("1000000"), NumberedCloud("1000001")};
  ExpectAsASet({all[0], all[2], all[4]}, all);
  ExpectAsASet({all[1], all[2], all[3], all[5], all[6]}, all);
  ExpectAsASet({all[7], all[8], all[9]}, all);
  // Out of order, twice, and with another step in between.
  ExpectAsASet({all[5], all[0], all[0], all[3], all[6], all[1]}, all);
}

TEST(KnownNames, DifferInMoreThanTheNumber) {
  const std::vector<std::string> all = {
      "frames/000001.pcd", "frames/000001.ply",  "frames/000001.pcd.part", "000001.pcd",
      "frames/1.pcd",      "frames/0000001.pcd", "frames/#.pcd",           "frames/-00001.pcd",
      "frames/000001",     "frames/a000001.pcd", "frames/000002.pcd",      "run.json"};
  ExpectAsASet(all, all);
  for (const std::string& name : all) ExpectAsASet({name}, all);
}

}  // namespace
}  // namespace railcast
