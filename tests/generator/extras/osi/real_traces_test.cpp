// Traces that others wrote, of OSI 3.0.0 to 3.7.0, by the reader that reads ours, and its messages
// against the standard's own files.

#include <google/protobuf/descriptor.pb.h>
#include <gtest/gtest.h>
#include <osi_sensor_view.pb.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/osi/trace_file.h"
#include "generator/extras/osi/sensor_view.h"
#include "tests/generator/extras/osi/true_messages.h"

namespace railcast::osi {
namespace {

class RealTraces : public testing::Test {
 protected:
  void SetUp() override {
    if (!exists(root_)) GTEST_SKIP() << root_ << " is not there";
    truth_.emplace();
  }
  // The messages of a trace as our part of OSI sees them, and that the standard's own files know
  // all of it.
  [[nodiscard]] std::vector<osi3::SensorView> Read(const std::string& name) {
    std::vector<osi3::SensorView> views;
    SingleChannelReader reader(root_ / name);
    while (const auto bytes = reader.Next()) {
      const std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
      EXPECT_TRUE(views.emplace_back().ParseFromString(text)) << name;
      EXPECT_EQ(CountUnknown(*truth_->Parse(text)), 0) << name;
    }
    return views;
  }

  const std::filesystem::path root_ = RAILCAST_SHARED_DATA_DIR "/osi";
  std::optional<TrueMessages> truth_;
};

TEST_F(RealTraces, HaveAsManyMessagesAsTheirNamesSay) {
  const std::map<std::string, std::size_t> num_messages = {
      {"20230621T113737Z_sv_350_32112_100.osi", 100},
      {"20240221T141700Z_sv_300_2112_10_one_moving_object.osi", 10},
      {"20240617T163554Z_sv_370_244_20_one_object.osi", 20},
      {"20240618T122540Z_sv_370_244_20_minimal_valid_example.osi", 20},
      {"20250320T135754Z_sv_360_2112_140_scenario_example_two_vehicles.osi", 140}};
  for (const auto& [name, num] : num_messages) {
    const auto views = Read(name);
    ASSERT_EQ(views.size(), num) << name;
    EXPECT_FALSE(views.front().global_ground_truth().moving_object().empty()) << name;
  }
}

TEST_F(RealTraces, SayWhereThingsAre) {
  const auto views = Read("20240618T122540Z_sv_370_244_20_minimal_valid_example.osi");
  const auto& view = views.at(0);
  EXPECT_EQ(view.version().version_minor(), 7U);
  const auto& host = view.global_ground_truth().moving_object(0);
  EXPECT_EQ(host.id().value(), view.host_vehicle_id().value());
  EXPECT_EQ(host.type(), osi3::MovingObject::TYPE_VEHICLE);
  EXPECT_EQ(host.base().dimension().length(), 5.0);
  EXPECT_EQ(host.base().velocity().x(), 10.0);
}

TEST_F(RealTraces, ThatTheCheckersOfTheStandardRefuseLackAVersion) {
  EXPECT_TRUE(Read("qc_example_sv_trace.osi").at(0).has_version());
  EXPECT_FALSE(Read("qc_invalid_version_not_set.osi").at(0).has_version());
}

using google::protobuf::Descriptor;
using google::protobuf::DescriptorPool;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;

// Our part of OSI's messages, field by field, against the standard's own files.
void ExpectIn(const DescriptorPool& pool, const EnumDescriptor& ours) {
  const EnumDescriptor* const theirs = pool.FindEnumTypeByName(ours.full_name());
  ASSERT_NE(theirs, nullptr) << ours.full_name();
  for (int i = 0; i < ours.value_count(); ++i) {
    const auto* const value = theirs->FindValueByName(ours.value(i)->name());
    ASSERT_NE(value, nullptr) << ours.value(i)->full_name();
    EXPECT_EQ(value->number(), ours.value(i)->number()) << value->full_name();
  }
}

std::string TypeOf(const FieldDescriptor& field) {
  if (field.message_type() != nullptr) return field.message_type()->full_name();
  return field.enum_type() != nullptr ? field.enum_type()->full_name() : field.type_name();
}

int num_compared = 0;

void ExpectIn(const DescriptorPool& pool, const Descriptor& ours) {
  const Descriptor* const theirs = pool.FindMessageTypeByName(ours.full_name());
  ASSERT_NE(theirs, nullptr) << ours.full_name();
  for (int i = 0; i < ours.field_count(); ++i) {
    const FieldDescriptor& field = *ours.field(i);
    const FieldDescriptor* const other = theirs->FindFieldByName(field.name());
    ASSERT_NE(other, nullptr) << field.full_name();
    EXPECT_EQ(other->number(), field.number()) << field.full_name();
    EXPECT_EQ(other->label(), field.label()) << field.full_name();
    EXPECT_EQ(TypeOf(*other), TypeOf(field)) << field.full_name();
    EXPECT_EQ(other->is_packed(), field.is_packed()) << field.full_name();
    ++num_compared;
  }
  for (int i = 0; i < ours.nested_type_count(); ++i) ExpectIn(pool, *ours.nested_type(i));
  for (int i = 0; i < ours.enum_type_count(); ++i) ExpectIn(pool, *ours.enum_type(i));
}

TEST(Descriptors, AreThoseOfTheStandard) {
  if (!exists(kTrueProtos)) GTEST_SKIP() << kTrueProtos << " is not there";
  const TrueMessages truth;
  const auto& file = *osi3::SensorView::descriptor()->file();
  num_compared = 0;
  for (int i = 0; i < file.message_type_count(); ++i) {
    ExpectIn(truth.pool(), *file.message_type(i));
  }
  EXPECT_GT(num_compared, 80);
}

// As MCAP holds them: readers build the messages from these alone.
TEST(Descriptors, DefineTheMessageWithoutAnyFile) {
  google::protobuf::FileDescriptorSet set;
  ASSERT_TRUE(set.ParseFromString(SensorViewDescriptors()));
  ASSERT_EQ(set.file_size(), 1);
  google::protobuf::DescriptorPool pool;
  ASSERT_NE(pool.BuildFile(set.file(0)), nullptr);
  EXPECT_NE(pool.FindMessageTypeByName("osi3.SensorView"), nullptr);
}

}  // namespace
}  // namespace railcast::osi
