#include "core/io/recording/with_topic.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

TEST(WithTopic, NamesTheTopicOfBagsAlone) {
  const TemporaryDirectory folder;
  const std::filesystem::path bag = folder.path() / "run.mcap";
  std::ofstream(bag) << "";
  const std::vector<std::filesystem::path> sources = {"sequence", bag};
  EXPECT_EQ(WithTopic(sources, ""), sources);
  EXPECT_EQ(WithTopic(sources, "/lidar/points"),
            (std::vector<std::filesystem::path>{"sequence", bag.string() + ":/lidar/points"}));
  EXPECT_EQ(WithTopic({bag}, "points"),
            (std::vector<std::filesystem::path>{bag.string() + ":/points"}));
  EXPECT_EQ(MessageOf([&] { (void)WithTopic({"sequence"}, "/lidar/points"); }),
            "--topic: must come with a bag of ROS 2, .mcap, .db3 or a directory of them (got "
            "sequence)");
}

}  // namespace
}  // namespace railcast
