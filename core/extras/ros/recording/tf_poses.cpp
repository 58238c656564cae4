#include "core/extras/ros/recording/tf_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/median.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/recording/tf_frames.h"

namespace railcast {
namespace {

constexpr std::size_t kMaxPoses = 8'000'000;

std::int64_t StampOf(const ros::TransformStamped& transform) {
  return transform.header.stamp.sec * kNsPerS + transform.header.stamp.nanosec;
}

double DistanceBetween_m(const Vector3& a, const Vector3& b) {
  return (a - b).norm();
}

/// Clocks of known differences.
struct KnownDifference {
  double seconds{};
  std::string_view between;
};
constexpr std::array<KnownDifference, 3> kClocks = {
    {{37.0, "TAI and UTC"}, {18.0, "GPS and UTC"}, {19.0, "TAI and GPS"}}};

/// The exact difference of two clocks that was measured but for what messages are late by.
std::optional<KnownDifference> ExactDifference(double measured_s) {
  constexpr double kLate_s = 0.4;  // Less than half of what GPS and TAI differ by.
  const double size_s = std::abs(measured_s);
  for (const KnownDifference& clocks : kClocks) {
    if (std::abs(size_s - clocks.seconds) <= kLate_s) {
      return KnownDifference{std::copysign(clocks.seconds, measured_s), clocks.between};
    }
  }
  constexpr double kZone_s = 900.0;  // Zones of time are whole quarters of an hour apart.
  constexpr double kMostZone_s = 26.0 * 3600.0;
  const double zone_s = kZone_s * std::round(size_s / kZone_s);
  if (zone_s == 0.0 || zone_s > kMostZone_s || std::abs(size_s - zone_s) > kLate_s) {
    return std::nullopt;
  }
  return KnownDifference{std::copysign(zone_s, measured_s), "two zones of time"};
}

}  // namespace

std::optional<double> AheadOf(std::vector<double> differences_ns) {
  if (differences_ns.empty()) return std::nullopt;
  const double median_ns = MedianOf(differences_ns);
  // Played at another speed, or got at times that nobody noted.
  constexpr double kMostSpread_ns = 0.25e9;
  for (double& difference_ns : differences_ns) {
    difference_ns = std::abs(difference_ns - median_ns);
  }
  if (MedianOf(differences_ns) > kMostSpread_ns) return std::nullopt;
  return median_ns;
}

TfPoses::TfPoses(bag::BagReader& bag, const CloudHeaders& clouds) {
  const TfTopics topics = TfTopicsFor(clouds.topic, bag.topics());
  if (!topics.others.empty()) remarks_.push_back(topics.RemarkOnOthers());
  const TfTree tree = ReadTree(bag, topics.chosen, remarks_);
  const std::string frame = PlainFrame(clouds.frame_id);
  is_fixed_ = tree.IsFixed(frame);
  is_fixed_by_name_ = is_fixed_ && tree.is_empty() && topics.others.empty();
  if (is_fixed_) return;
  for (TfStep& step : tree.WayToFixed(frame)) links_.push_back({.step = std::move(step)});
  if (links_.empty()) {
    if (auto reason = tree.WhyNoWay(frame, topics)) remarks_.push_back(std::move(*reason));
    return;
  }
  ReadPoses(bag, topics.chosen);
  CompareClocks(clouds);
}

void TfPoses::ReadPoses(bag::BagReader& bag, const std::vector<std::size_t>& topics) {
  std::size_t num_poses = 0;
  Remark left_out{.kind = RemarkKind::kTransformsLeftOut, .place = {}, .number = 0};
  const auto take = [&](const ros::TransformStamped& transform, const bag::BagMessage& message) {
    if (!FaultOf(transform).empty()) return;
    const std::string child = PlainFrame(transform.child_frame_id);
    const auto link =
        std::ranges::find(links_, child, [](const TfLink& of) { return of.step.child; });
    if (link == links_.end()) return;
    if (const auto parent = PlainFrame(transform.header.frame_id); parent != link->step.parent) {
      if (left_out.number++ > 0) return;
      left_out.detail =
          Quoted(child) + " from " + Quoted(parent) + ", not from " + Quoted(link->step.parent);
      return;
    }
    const auto& [position, rotation] = transform.transform;
    TimedPose pose{StampOf(transform),
                   {position.x, position.y, position.z},
                   {rotation.w, rotation.x, rotation.y, rotation.z},
                   message.topic};
    pose.rotation.normalize();
    if (link->step.is_downwards) {
      pose.rotation = pose.rotation.conjugate();
      pose.position_m = -(pose.rotation * pose.position_m);
    }
    if (link->step.is_static) link->poses.clear();
    link->poses.push_back(pose);
    if (!link->step.is_static) {
      link->ahead_ns.push_back(static_cast<double>(pose.time_ns) -
                               static_cast<double>(message.time_ns));
    }
    if (++num_poses > kMaxPoses) {
      throw InputError("must have at most " + NumberText(kMaxPoses) + " transforms");
    }
  };
  ForEachTransform(bag, topics, take);
  if (left_out.number > 0) remarks_.push_back(std::move(left_out));
  for (const bag::BagTopic& topic : bag.topics()) topic_names_.push_back(ShownText(topic.name));
  for (TfLink& link : links_) Finish(link);
}

void TfPoses::Finish(TfLink& link) {
  std::ranges::stable_sort(link.poses, {}, &TimedPose::time_ns);
  std::vector<double> steps_ns;
  for (std::size_t i = 1; i < link.poses.size(); ++i) {
    steps_ns.push_back(static_cast<double>(link.poses[i].time_ns) -
                       static_cast<double>(link.poses[i - 1].time_ns));
  }
  link.jumps = JumpsOf(link.poses);
  constexpr double kTimesMedian = 10.0;
  const double usual_ns = steps_ns.empty() ? 0.0 : MedianOf(steps_ns);
  link.most_ns = std::max(kNsPerS, std::lround(kTimesMedian * usual_ns));
}

// Where transforms of two vehicles come in turns, each is near to the next but one, and the speed
// from each to the next is that of none.
std::vector<bool> TfPoses::JumpsOf(const std::vector<TimedPose>& poses) {
  constexpr double kShortest_m = 0.5;  // Nearer to each other than two vehicles are.
  constexpr double kFastest_mps = 100.0;
  constexpr double kTimesUsual = 3.0;
  constexpr std::size_t kNear = 3;  // As many vehicles are told apart.
  constexpr std::size_t kAround = 8;
  const auto speed_mps = [&](std::size_t i, std::size_t j) {
    const double way_m = DistanceBetween_m(poses[i].position_m, poses[j].position_m);
    const double time_s = SecondsFromNs(std::abs(poses[j].time_ns - poses[i].time_ns));
    if (way_m == 0.0) return 0.0;
    return time_s > 0.0 ? way_m / time_s : std::numeric_limits<double>::infinity();
  };
  std::vector<double> least_mps(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    least_mps[i] = std::numeric_limits<double>::infinity();
    const std::size_t end = std::min(i + kNear + 1, poses.size());
    for (std::size_t j = i - std::min(i, kNear); j < end; ++j) {
      if (j != i) least_mps[i] = std::min(least_mps[i], speed_mps(i, j));
    }
  }
  std::vector<bool> is_jump(poses.size());
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    if (DistanceBetween_m(poses[i].position_m, poses[i + 1].position_m) <= kShortest_m) continue;
    const auto begin = least_mps.begin() + static_cast<std::ptrdiff_t>(i - std::min(i, kAround));
    const auto end =
        least_mps.begin() + static_cast<std::ptrdiff_t>(std::min(i + 2 + kAround, poses.size()));
    std::vector<double> around_mps(begin, end);
    const double most_mps = std::min(kFastest_mps, kTimesUsual * MedianOf(around_mps));
    if (speed_mps(i, i + 1) <= most_mps) continue;
    is_jump[i] = true;
    // Which of two transforms of one time the others belong to is not known.
    if (poses[i].time_ns != poses[i + 1].time_ns) continue;
    if (i > 0) is_jump[i - 1] = true;
    if (i + 2 < poses.size()) is_jump[i + 1] = true;
  }
  return is_jump;
}

void TfPoses::CompareClocks(const CloudHeaders& clouds) {
  // Localisation may state times up to a second ahead, for its poses to be there when asked for.
  constexpr double kOtherClock_s = 1.25;
  for (TfLink& link : links_) {
    const auto ahead_ns = AheadOf(std::exchange(link.ahead_ns, {}));
    if (!ahead_ns || !clouds.ahead_ns) continue;
    const double measured_s = (*clouds.ahead_ns - *ahead_ns) / static_cast<double>(kNsPerS);
    if (std::abs(measured_s) <= kOtherClock_s) continue;
    // Where stamps of one time are farther apart than both last together, none are equal. If some
    // are, the transforms were recorded at another time, as those of a replay.
    const std::int64_t first_ns = link.poses.front().time_ns;
    const std::int64_t last_ns = link.poses.back().time_ns;
    const bool do_meet = clouds.first_ns <= last_ns && first_ns <= clouds.last_ns;
    const double both_s =
        SecondsFromNs(clouds.last_ns - clouds.first_ns) + SecondsFromNs(last_ns - first_ns);
    if (do_meet && std::abs(measured_s) > both_s) continue;
    const auto exact = ExactDifference(measured_s);
    const double by_s = exact ? exact->seconds : measured_s;
    other_clock_ = (exact ? NumberText(std::abs(by_s)) : ShortText(std::abs(by_s))) +
                   (by_s > 0.0 ? " s ahead" : " s behind");
    if (exact) {
      other_clock_ += ", as between " + std::string(exact->between);
      link.shift_ns = std::llround(by_s * static_cast<double>(kNsPerS));
      continue;
    }
    other_clock_ += ", which no two known clocks are apart";
    is_clock_known_ = false;
    return;
  }
}

TfPoses::PoseRange TfPoses::RangeOf(const TfLink& link,
                                    std::int64_t begin_ns,
                                    std::int64_t end_ns) {
  const auto from = std::ranges::lower_bound(link.poses, begin_ns, {}, &TimedPose::time_ns);
  const auto to = std::ranges::upper_bound(link.poses, end_ns, {}, &TimedPose::time_ns);
  const auto first = static_cast<std::size_t>(from - link.poses.begin());
  return {first - std::min<std::size_t>(first, 1),
          static_cast<std::size_t>(to - link.poses.begin())};
}

std::optional<Transform> TfPoses::PoseOf(const TfLink& link, std::int64_t time_ns) {
  const auto to_transform = [](const Vector3& position_m, const Eigen::Quaterniond& rotation) {
    return MakeTransform(rotation.toRotationMatrix(), position_m);
  };
  if (link.step.is_static) {
    return to_transform(link.poses.front().position_m, link.poses.front().rotation);
  }
  // Points state their times in rounded seconds, so that the last one may seem to be behind the
  // last transform.
  constexpr std::int64_t kRounding_ns = 1000;
  if (!link.poses.empty()) {
    const std::int64_t known_ns =
        std::clamp(time_ns, link.poses.front().time_ns, link.poses.back().time_ns);
    if (std::abs(known_ns - time_ns) <= kRounding_ns) time_ns = known_ns;
  }
  const auto after = std::ranges::lower_bound(link.poses, time_ns, {}, &TimedPose::time_ns);
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
  if (links_.empty() || !is_clock_known_) return std::nullopt;
  Transform fixed_from_frame = Transform::Identity();
  for (auto link = links_.rbegin(); link != links_.rend(); ++link) {
    const auto parent_from_child = PoseOf(*link, time_ns - link->shift_ns);
    if (!parent_from_child) return std::nullopt;
    fixed_from_frame = fixed_from_frame * *parent_from_child;
  }
  return fixed_from_frame;
}

std::string TfPoses::JumpWithin(std::int64_t begin_ns, std::int64_t end_ns) const {
  for (const TfLink& link : links_) {
    if (link.step.is_static) continue;
    const auto [first, last] = RangeOf(link, begin_ns - link.shift_ns, end_ns - link.shift_ns);
    for (std::size_t i = first; i < std::min(last, link.poses.size()); ++i) {
      if (!link.jumps[i]) continue;
      const TimedPose& from = link.poses[i];
      const TimedPose& to = link.poses[i + 1];
      return ShortText(DistanceBetween_m(from.position_m, to.position_m)) + " m in " +
             SecondsText(to.time_ns - from.time_ns) + " of " + topic_names_.at(from.topic) +
             (from.topic == to.topic ? "" : " and " + topic_names_.at(to.topic));
    }
  }
  return {};
}

std::int64_t TfPoses::Bridged_ns(std::int64_t time_ns) const {
  std::int64_t bridged_ns = 0;
  for (const TfLink& link : links_) {
    if (link.step.is_static) continue;
    const std::int64_t at_ns = time_ns - link.shift_ns;
    const auto after = std::ranges::lower_bound(link.poses, at_ns, {}, &TimedPose::time_ns);
    if (after == link.poses.end() || after == link.poses.begin()) continue;
    const std::int64_t step_ns = after->time_ns - (after - 1)->time_ns;
    if (after->time_ns > at_ns && step_ns > link.most_ns) {
      bridged_ns = std::max(bridged_ns, step_ns);
    }
  }
  return bridged_ns;
}

std::int64_t TfPoses::Beyond_ns(std::int64_t time_ns) const {
  std::int64_t beyond_ns = 0;
  for (const TfLink& link : links_) {
    if (link.step.is_static || link.poses.empty()) continue;
    const std::int64_t at_ns = time_ns - link.shift_ns;
    const std::int64_t known_ns =
        std::clamp(at_ns, link.poses.front().time_ns, link.poses.back().time_ns);
    beyond_ns = std::max(beyond_ns, std::abs(at_ns - known_ns));
  }
  return beyond_ns;
}

}  // namespace railcast
