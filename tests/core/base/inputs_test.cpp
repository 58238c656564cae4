#include "core/base/inputs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

class InputsTest : public testing::Test {
 protected:
  std::filesystem::path Written(const std::string& name, const std::string& bytes) const {
    std::ofstream(directory_.path() / name) << bytes;
    return directory_.path() / name;
  }

  TemporaryDirectory directory_;
};

TEST_F(InputsTest, HoldWhatAFileHeldWhenItWasReadFirst) {
  const Inputs inputs;
  const std::filesystem::path file = Written("rock.obj", "first");
  const InputBytes first = ReadInput(file);
  Written("rock.obj", "second");
  // By another name of the same path, too.
  EXPECT_EQ(ReadInput(directory_.path() / "." / "rock.obj"), first);
  EXPECT_EQ(*first, "first");
  Inputs::Release();
  EXPECT_EQ(*ReadInput(file), "second");
}

TEST_F(InputsTest, AreReadAnewInALibrary) {
  const std::filesystem::path file = Written("rock.obj", "first");
  EXPECT_EQ(*ReadInput(file), "first");
  Written("rock.obj", "second");
  EXPECT_EQ(*ReadInput(file), "second");
  EXPECT_THAT(InputFiles(), testing::IsEmpty());
}

TEST_F(InputsTest, SayWhyAFileCannotBeRead) {
  const Inputs inputs;
  const std::filesystem::path file = directory_.path() / "none.obj";
  EXPECT_EQ(MessageOf([&] { static_cast<void>(ReadInput(file)); }),
            file.string() + ": no such file or directory");
  // It may come to be.
  Written("none.obj", "here");
  EXPECT_EQ(*ReadInput(file), "here");
}

}  // namespace
}  // namespace railcast
