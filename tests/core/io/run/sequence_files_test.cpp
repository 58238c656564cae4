#include "core/io/run/sequence_files.h"

#include <gtest/gtest.h>

namespace railcast {
namespace {

TEST(SequenceFiles, AreWhatARunWrites) {
  for (const char* name : {"run.json", "manifest.json", "scenario.resolved.json", "commands.jsonl",
                           "frames/000000.pcd", "frames/999999.ply", "frames/1000000.pcd",
                           "sequences/00/velodyne/000000.bin", "sequences/00/labels/000000.label",
                           "sequences/00/calib.txt", "semantic-kitti-railcast.yaml",
                           "inputs/0123456789abcdef/rock.obj", "inputs/0123456789abcdef/a b"}) {
    EXPECT_TRUE(IsSequenceFile(name)) << name;
  }
}

TEST(SequenceFiles, AreNothingElse) {
  for (const char* name : {"",
                           "letter.txt",
                           "./run.json",
                           "run.json.part",
                           "frames",
                           "frames/",
                           "frames/0.pcd",
                           "frames/0000000.pcd",
                           "frames/00000a.pcd",
                           "frames/000000.pcd.part",
                           "frames/000000.txt",
                           "frames/x/000000.pcd",
                           "sequences/01/velodyne/000000.bin",
                           "sequences/00/velodyne/000000.pcd",
                           "inputs/rock.obj",
                           "inputs/0123456789abcdef/",
                           "inputs/0123456789abcdef",
                           "inputs/0123456789ABCDEF/rock.obj",
                           "inputs/0123456789abcdef/..",
                           "inputs/0123456789abcdef/a/b"}) {
    EXPECT_FALSE(IsSequenceFile(name)) << name;
  }
}

}  // namespace
}  // namespace railcast
