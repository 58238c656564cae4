#include "core/extras/ros/recording/tf_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/median.h"
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

/// How a topic says that its transforms hold for all times. Latched ones may move nevertheless.
enum class Standing { kNo, kIfEqual, kYes };

Standing StandingOf(const bag::BagTopic& topic) {
  if (topic.name.ends_with("/tf_static")) return Standing::kYes;
  return topic.is_latched ? Standing::kIfEqual : Standing::kNo;
}

/// Calls `visit(transform, standing)` for each transform of the bag.
template <typename Visit>
void ForEachTransform(bag::BagReader& bag, const Visit& visit) {
  std::vector<std::size_t> wanted;
  for (std::size_t i = 0; i < bag.topics().size(); ++i) {
    if (bag.topics()[i].type == ros::TfMessage::kName) wanted.push_back(i);
  }
  bag.Select(wanted);
  while (const auto message = bag.Next()) {
    const bag::BagTopic& topic = bag.topics()[message->topic];
    const Standing standing = StandingOf(topic);
    AtPlace(ShownText(topic.name) + ": ", [&] {
      for (const auto& transform : ros::FromCdr<ros::TfMessage>(message->data).transforms) {
        visit(transform, standing);
      }
    });
  }
}

/// What all transforms to a frame say.
struct ToFrame {
  std::string parent;
  bool is_static{};
  ros::RosTransform last;
};

}  // namespace

TfPoses::TfPoses(bag::BagReader& bag, const std::string& frame) {
  ReadLinks(bag, PlainFrame(frame));
  if (!links_.empty()) ReadPoses(bag);
}

void TfPoses::ReadLinks(bag::BagReader& bag, const std::string& frame) {
  std::map<std::string, ToFrame> parents;
  ForEachTransform(bag, [&](const ros::TransformStamped& transform, Standing standing) {
    ToFrame to{PlainFrame(transform.header.frame_id), standing != Standing::kNo,
               transform.transform};
    const auto [known, is_new] = parents.try_emplace(PlainFrame(transform.child_frame_id), to);
    if (standing == Standing::kIfEqual && !is_new) {
      to.is_static = known->second.is_static && known->second.last == to.last;
    }
    known->second = std::move(to);
    if (parents.size() > kMaxFrames) {
      throw InputError("must have at most " + NumberText(kMaxFrames) + " frames of reference");
    }
  });
  std::vector<TfLink> links;
  std::string child = frame;
  for (auto found = parents.find(child); found != parents.end(); found = parents.find(child)) {
    if (links.size() == parents.size()) {
      throw InputError("frames of reference must not go in circles (got " + Quoted(frame) + ")");
    }
    const auto& [parent, is_static, last] = found->second;
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
  ForEachTransform(bag, [&](const ros::TransformStamped& transform, Standing) {
    const auto link =
        std::ranges::find(links_, PlainFrame(transform.child_frame_id), &TfLink::child);
    if (link == links_.end()) return;
    if (const std::string parent = PlainFrame(transform.header.frame_id); parent != link->parent) {
      if (left_out_.number++ > 0) return;
      left_out_.detail =
          Quoted(link->child) + " from " + Quoted(parent) + ", not from " + Quoted(link->parent);
      return;
    }
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
  for (TfLink& link : links_) {
    std::ranges::stable_sort(link.poses, {}, &TimedPose::time_ns);
    std::vector<double> steps_ns;
    for (std::size_t i = 1; i < link.poses.size(); ++i) {
      steps_ns.push_back(static_cast<double>(link.poses[i].time_ns - link.poses[i - 1].time_ns));
    }
    constexpr double kTimesMedian = 10.0;
    const double usual_ns = steps_ns.empty() ? 0.0 : MedianOf(steps_ns);
    link.most_ns = std::max(kNsPerS, std::lround(kTimesMedian * usual_ns));
  }
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

std::int64_t TfPoses::Bridged_ns(std::int64_t time_ns) const {
  std::int64_t bridged_ns = 0;
  for (const TfLink& link : links_) {
    if (link.is_static) continue;
    const auto after = std::ranges::lower_bound(link.poses, time_ns, {}, &TimedPose::time_ns);
    if (after == link.poses.end() || after == link.poses.begin()) continue;
    const std::int64_t step_ns = after->time_ns - (after - 1)->time_ns;
    if (after->time_ns > time_ns && step_ns > link.most_ns) {
      bridged_ns = std::max(bridged_ns, step_ns);
    }
  }
  return bridged_ns;
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
