#include "core/io/run/fixed_file.h"

#include <gtest/gtest.h>

#include "core/io/content_hash.h"
#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

class FixedFileTest : public testing::Test {
 protected:
  [[nodiscard]] fs::path Path(const std::string& name) const { return directory_.path() / name; }
  /// Of 3 MB, more than is copied at once.
  [[nodiscard]] FixedFile LargeCopy(std::string hash = {}) const {
    WriteFileWhole(Path("large"), std::string(3'000'000, 'x') + "y");
    return {"inputs/large", nullptr, Path("large"), std::move(hash)};
  }

  TemporaryDirectory directory_;
};

TEST_F(FixedFileTest, IsWrittenUnlessItIsThere) {
  for (const FixedFile& file : {FixedText("inputs/text", "content"), LargeCopy()}) {
    EXPECT_FALSE(HasFixedFile(Path("run"), file));
    WriteFixedFile(Path("run"), file);
    EXPECT_TRUE(HasFixedFile(Path("run"), file));
    const auto written = fs::last_write_time(Path("run") / file.name);
    WriteFixedFile(Path("run"), file);
    EXPECT_EQ(fs::last_write_time(Path("run") / file.name), written);
    // One byte of the same length.
    std::string bytes = ReadFileWhole(Path("run") / file.name);
    bytes.back() = '?';
    WriteFileWhole(Path("run") / file.name, bytes);
    EXPECT_FALSE(HasFixedFile(Path("run"), file));
    WriteFixedFile(Path("run"), file);
    EXPECT_TRUE(HasFixedFile(Path("run"), file));
  }
}

TEST_F(FixedFileTest, IsALinkToItsTwinUntilEitherIsWrittenAnew) {
  const FixedFile file = FixedText("inputs/rock.obj", "v 0 0 0");
  WriteFixedFile(Path("front"), file);
  WriteFixedFile(Path("rear"), file, Path("front"));
  EXPECT_EQ(fs::hard_link_count(Path("front") / file.name), 2U);
  WriteFileWhole(Path("rear") / file.name, "other");
  EXPECT_TRUE(HasFixedFile(Path("front"), file));
  WriteFixedFile(Path("rear"), file, Path("front"));
  EXPECT_EQ(fs::hard_link_count(Path("front") / file.name), 2U);
  EXPECT_TRUE(HasFixedFile(Path("rear"), file));
}

TEST_F(FixedFileTest, IsWrittenWhereItsTwinCannotBeLinked) {
  const FixedFile file = FixedText("inputs/rock.obj", "v 0 0 0");
  WriteFixedFile(Path("rear"), file, Path("nowhere"));
  EXPECT_TRUE(HasFixedFile(Path("rear"), file));
}

TEST_F(FixedFileTest, SaysThatWhatItCopiesWasChanged) {
  const FixedFile file = LargeCopy(ContentHash("as it was read"));
  EXPECT_EQ(MessageOf([&] { WriteFixedFile(Path("run"), file); }),
            Path("large").string() + ": was changed while the scenario was read; run it again");
  EXPECT_FALSE(fs::exists(Path("run") / file.name));
}

// It leads to what is not the run's.
TEST_F(FixedFileTest, IsNotWrittenThroughASymbolicLink) {
  const FixedFile file = FixedText("rock.obj", "v 0 0 0");
  fs::create_directories(Path("run"));
  WriteFileWhole(Path("mine"), "v 0 0 0");
  fs::create_symlink(Path("mine"), Path("run") / "rock.obj");
  EXPECT_FALSE(HasFixedFile(Path("run"), file));
  EXPECT_EQ(MessageOf([&] { WriteFixedFile(Path("run"), file); }),
            (Path("run") / "rock.obj").string() + ": must be a regular file (got a symbolic link)");
}

}  // namespace
}  // namespace railcast
