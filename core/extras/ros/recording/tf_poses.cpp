#include "core/extras/ros/recording/tf_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/geometry_messages.h"

namespace railcast {
namespace {

constexpr std::size_t kMaxFrames = 10'000;
constexpr std::size_t kMaxPoses = 8'000'000;

/// tf2 takes "/map" for "map".
std::string PlainFrame(const std::string& frame) {
  return frame.starts_with('/') ? frame.substr(1) : frame;
}

/// Calls `visit(transform, is_static)` for each transform of the bag.
template <typename Visit>
void ForEachTransform(bag::BagReader& bag, const Visit& visit) {
  std::vector<std::size_t> wanted;
  for (std::size_t i = 0; i < bag.topics().size(); ++i) {
    if (bag.topics()[i].type == ros::TfMessage::kName) wanted.push_back(i);
  }
  bag.Select(wanted);
  while (const auto message = bag.Next()) {
    const bag::BagTopic& topic = bag.topics()[message->topic];
    const bool is_static = topic.is_latched || topic.name.ends_with("/tf_static");
    AtPlace(ShownText(topic.name) + ": ", [&] {
      for (const auto& transform : ros::FromCdr<ros::TfMessage>(message->data).transforms) {
        visit(transform, is_static);
      }
    });
  }
}

}  // namespace

TfPoses::TfPoses(bag::BagReader& bag, const std::string& frame) {
  ReadLinks(bag, PlainFrame(frame));
  if (!links_.empty()) ReadPoses(bag);
}

void TfPoses::ReadLinks(bag::BagReader& bag, const std::string& frame) {
  std::map<std::string, std::pair<std::string, bool>> parents;
  ForEachTransform(bag, [&](const ros::TransformStamped& transform, bool is_static) {
    parents.insert_or_assign(PlainFrame(transform.child_frame_id),
                             std::pair(PlainFrame(transform.header.frame_id), is_static));
    if (parents.size() > kMaxFrames) {
      throw InputError("must have at most " + NumberText(kMaxFrames) + " frames of reference");
    }
  });
  std::vector<TfLink> links;
  std::string child = frame;
  for (auto found = parents.find(child); found != parents.end(); found = parents.find(child)) {
    const auto& [parent, is_static] = found->second;
    if (links.size() == parents.size()) {
      throw InputError("frames of reference must not go in circles (got " + Quoted(frame) + ")");
    }
    links.push_back({child, parent, is_static, {}});
    child = parent;
  }
  constexpr std::array<std::string_view, 4> kFixed = {"map", "odom", "earth", "world"};
  const bool is_fixed =
      std::ranges::find(kFixed, child) != kFixed.end() ||
      std::ranges::any_of(links, [](const TfLink& link) { return !link.is_static; });
  if (is_fixed) links_ = std::move(links);
}

void TfPoses::ReadPoses(bag::BagReader& bag) {
  std::size_t num_poses = 0;
  ForEachTransform(bag, [&](const ros::TransformStamped& transform, bool) {
    const auto link =
        std::ranges::find(links_, PlainFrame(transform.child_frame_id), &TfLink::child);
    if (link == links_.end() || PlainFrame(transform.header.frame_id) != link->parent) return;
    const auto& [position, rotation] = transform.transform;
    TimedPose pose{transform.header.stamp.sec * kNsPerS + transform.header.stamp.nanosec,
                   {position.x, position.y, position.z},
                   {rotation.w, rotation.x, rotation.y, rotation.z}};
    constexpr double kTolerance = 0.1;  // That of tf2.
    if (!pose.position_m.allFinite() || !(std::abs(pose.rotation.norm() - 1.0) <= kTolerance)) {
      throw InputError("the transform to " + Quoted(link->child) +
                       " must be a position and a unit quaternion");
    }
    pose.rotation.normalize();
    if (link->is_static) link->poses.clear();
    link->poses.push_back(pose);
    if (++num_poses > kMaxPoses) {
      throw InputError("must have at most " + NumberText(kMaxPoses) + " transforms");
    }
  });
  for (TfLink& link : links_) std::ranges::stable_sort(link.poses, {}, &TimedPose::time_ns);
}

std::optional<Transform> TfPoses::PoseOf(const TfLink& link, std::int64_t time_ns) {
  const auto to_transform = [](const Vector3& position_m, const Eigen::Quaterniond& rotation) {
    return MakeTransform(rotation.toRotationMatrix(), position_m);
  };
  // Points state their times in rounded seconds, so that the last one may seem to be behind the
  // last transform.
  constexpr std::int64_t kRounding_ns = 1000;
  if (!link.poses.empty()) {
    const std::int64_t known_ns =
        std::clamp(time_ns, link.poses.front().time_ns, link.poses.back().time_ns);
    if (std::abs(known_ns - time_ns) <= kRounding_ns) time_ns = known_ns;
  }
  const auto after = std::ranges::lower_bound(link.poses, time_ns, {}, &TimedPose::time_ns);
  if (link.is_static) {
    return to_transform(link.poses.front().position_m, link.poses.front().rotation);
  }
  if (after == link.poses.end()) return std::nullopt;
  if (after->time_ns == time_ns) return to_transform(after->position_m, after->rotation);
  if (after == link.poses.begin()) return std::nullopt;
  const TimedPose& before = *(after - 1);
  const double share = static_cast<double>(time_ns - before.time_ns) /
                       static_cast<double>(after->time_ns - before.time_ns);
  return to_transform(before.position_m + share * (after->position_m - before.position_m),
                      before.rotation.slerp(share, after->rotation));
}

std::optional<Transform> TfPoses::At(std::int64_t time_ns) const {
  if (links_.empty()) return std::nullopt;
  Transform fixed_from_frame = Transform::Identity();
  for (auto link = links_.rbegin(); link != links_.rend(); ++link) {
    const auto parent_from_child = PoseOf(*link, time_ns);
    if (!parent_from_child) return std::nullopt;
    fixed_from_frame = fixed_from_frame * *parent_from_child;
  }
  return fixed_from_frame;
}

std::int64_t TfPoses::Beyond_ns(std::int64_t time_ns) const {
  std::int64_t beyond_ns = 0;
  for (const TfLink& link : links_) {
    if (link.is_static || link.poses.empty()) continue;
    const std::int64_t known_ns =
        std::clamp(time_ns, link.poses.front().time_ns, link.poses.back().time_ns);
    beyond_ns = std::max(beyond_ns, std::abs(time_ns - known_ns));
  }
  return beyond_ns;
}

}  // namespace railcast
