// Our part of OSI's messages, field by field, against the standard's own files.
#include <google/protobuf/descriptor.pb.h>
#include <gtest/gtest.h>

#include <osi_sensor_view.pb.h>
#include "generator/extras/osi/sensor_view.h"
#include "tests/generator/extras/osi/true_messages.h"

namespace railcast::osi {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::DescriptorPool;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;

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
