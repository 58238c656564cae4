#include "analysis/stats/certificate_section.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/io/record/record_text.h"
#include "core/io/run/run_record.h"
#include "core/io/write_file.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

/// The recording of an insertion that has a certified frame.
RecordingInfo CertifiedInsertionIn(const std::filesystem::path& folder) {
  const FrameCertificate frame{.strata = {{{.label = 13}, 60, 0.1}}, .drawn = {{.cell = 4}}};
  const RunCertificate run{.cost_share = 0.01, .frames = 1, .firings = 60, .drawn = 1};
  const auto member = [](const std::string& record) {
    return Json{{"certificate", Json::parse(record)}};
  };
  std::filesystem::create_directories(folder / "recording");
  WriteFileWhole(folder / "insert.jsonl", member(RecordText(frame)).dump() + "\n");
  WriteFileWhole(folder / "manifest.json",
                 WithManifestHash(member(RecordText(run)).dump(2) + "\n"));
  RecordingInfo info;
  info.source = folder / "recording";
  return info;
}

TEST(CertificateSection, IsOfWhatWasPutIntoARecording) {
  const TemporaryDirectory folder;
  const RecordingInfo first = CertifiedInsertionIn(folder.path() / "first");
  const auto alone = CertificateOf({first});
  ASSERT_TRUE(alone);
  EXPECT_EQ(alone->firings, 60U);
  const auto both = CertificateOf({first, CertifiedInsertionIn(folder.path() / "second")});
  ASSERT_TRUE(both);
  EXPECT_EQ(both->frames, 2U);
  EXPECT_EQ(both->firings, 120U);
  EXPECT_EQ(both->drawn, 2U);
  // An unfinished one tells nothing yet.
  std::filesystem::remove(folder.path() / "first/manifest.json");
  EXPECT_FALSE(CertificateOf({first}));
}

}  // namespace
}  // namespace railcast
