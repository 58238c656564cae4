#include "core/io/openlabel.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/pose_numbers.h"
#include "core/base/text.h"

namespace railcast {
namespace {

Transform CheckedTransform(const Eigen::Matrix3d& axes,
                           const Vector3& origin_m,
                           const OpenLabelPlace& place) {
  constexpr double kRounding = 1e-3;
  if (!(axes.transpose() * axes).isIdentity(kRounding) || axes.determinant() <= 0.0) {
    place.Fail("must be a rotation and a translation");
  }
  return MakeTransform(Eigen::Quaterniond(axes).normalized().toRotationMatrix(), origin_m);
}

}  // namespace

void OpenLabelPlace::Fail(const std::string& rule) const {
  throw InputError(file + ": " + pointer + ": " + rule);
}

Json ParseOpenLabel(const std::string& text, const std::string& shown) {
  try {
    return Json::parse(text);
  } catch (const Json::exception&) {
    throw InputError(shown + ": must be a file of OpenLABEL");
  }
}

const Json& OpenLabelMember(const Json& json, const std::string& key, const OpenLabelPlace& place) {
  const auto found = json.is_object() ? json.find(key) : json.end();
  if (!json.is_object() || found == json.end()) (place / key).Fail("missing");
  return *found;
}

std::string OpenLabelText(const Json& json, const std::string& key, const OpenLabelPlace& place) {
  const Json& value = OpenLabelMember(json, key, place);
  if (!value.is_string()) (place / key).Fail("must be a text");
  return value.get<std::string>();
}

std::vector<double> OpenLabelNumbers(const Json& json,
                                     std::size_t count,
                                     const OpenLabelPlace& place) {
  const bool are_numbers =
      json.is_array() && json.size() == count && std::ranges::all_of(json, [](const Json& number) {
        return number.is_number() && std::isfinite(number.get<double>());
      });
  if (!are_numbers) place.Fail("must be " + NumberText(count) + " numbers");
  return json.get<std::vector<double>>();
}

Transform OpenLabelTransform(const Json& json, const OpenLabelPlace& place) {
  if (json.is_object() && json.contains("matrix4x4")) {
    const auto rows = OpenLabelNumbers(json.at("matrix4x4"), 16, place / "matrix4x4");
    const Eigen::Matrix4d matrix =
        Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(rows.data());
    return CheckedTransform(matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>(), place);
  }
  const auto turn =
      OpenLabelNumbers(OpenLabelMember(json, "quaternion", place), 4, place / "quaternion");
  auto pose =
      OpenLabelNumbers(OpenLabelMember(json, "translation", place), 3, place / "translation");
  pose.insert(pose.end(), turn.begin(), turn.end());
  return OpenLabelPose(pose, place);
}

Transform OpenLabelPose(const std::vector<double>& numbers, const OpenLabelPlace& place) {
  constexpr std::ptrdiff_t kNumbers = 7;
  return MakePose({numbers.begin(), numbers.begin() + kNumbers}, place.file + ": " + place.pointer);
}

}  // namespace railcast
