#pragma once

#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/dynamic_message.h>
#include <google/protobuf/unknown_field_set.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "tests/core/io/damage.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/run_command.h"

namespace railcast::osi {

/// Where the files of OSI 3.8.0 are, which define its messages.
inline const std::filesystem::path kTrueProtos = RAILCAST_SHARED_DATA_DIR "/osi/proto_3.8";

/// The messages of the standard's own files, as protobuf's compiler reads them. A reader that knows
/// nothing of ours.
class TrueMessages {
 public:
  /// @pre kTrueProtos exists.
  TrueMessages() {
    // OSI's own build makes the file of the version so.
    const TemporaryDirectory folder;
    std::string version = ReadFileWhole(kTrueProtos / "osi_version.proto.in");
    version = Replaced(version, "@VERSION_MAJOR@", "3");
    version = Replaced(version, "@VERSION_MINOR@", "8");
    version = Replaced(version, "@VERSION_PATCH@", "0");
    WriteFileWhole(folder.path() / "osi_version.proto", version);
    const std::filesystem::path set_file = folder.path() / "set";
    const Ended run =
        RunCommand("protoc --include_imports --descriptor_set_out=" + set_file.string() + " -I" +
                   folder.path().string() + " -I" + kTrueProtos.string() + " osi_sensorview.proto");
    EXPECT_EQ(run.status, 0) << run.said;
    google::protobuf::FileDescriptorSet set;
    EXPECT_TRUE(set.ParseFromString(ReadFileWhole(set_file)));
    for (const auto& file : set.file()) EXPECT_NE(pool_.BuildFile(file), nullptr) << file.name();
  }

  [[nodiscard]] const google::protobuf::DescriptorPool& pool() const { return pool_; }

  /// The bytes as a SensorView.
  [[nodiscard]] std::unique_ptr<google::protobuf::Message> Parse(const std::string& bytes) {
    const auto* const type = pool_.FindMessageTypeByName("osi3.SensorView");
    std::unique_ptr<google::protobuf::Message> message(factory_.GetPrototype(type)->New());
    EXPECT_TRUE(message->ParseFromString(bytes));
    return message;
  }

 private:
  google::protobuf::DescriptorPool pool_;
  google::protobuf::DynamicMessageFactory factory_;
};

/// How many fields of a message and of all that it holds its definition does not name.
inline int CountUnknown(const google::protobuf::Message& message) {
  const google::protobuf::Reflection& reflection = *message.GetReflection();
  int num = reflection.GetUnknownFields(message).field_count();
  std::vector<const google::protobuf::FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const auto* const field : fields) {
    if (field->cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_MESSAGE) continue;
    if (!field->is_repeated()) {
      num += CountUnknown(reflection.GetMessage(message, field));
      continue;
    }
    for (int i = 0; i < reflection.FieldSize(message, field); ++i) {
      num += CountUnknown(reflection.GetRepeatedMessage(message, field, i));
    }
  }
  return num;
}

}  // namespace railcast::osi
