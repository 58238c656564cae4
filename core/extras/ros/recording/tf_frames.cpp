#include "core/extras/ros/recording/tf_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/base/join.h"

namespace railcast {
namespace {

constexpr std::size_t kMaxFrames = 10'000;

/// Some recorders leave out the first slash.
std::string WithSlash(const std::string& topic) {
  return topic.starts_with('/') ? topic : '/' + topic;
}

/// How a topic says that its transforms hold for all times. Latched ones may move nevertheless.
enum class Standing { kNo, kIfEqual, kYes };

Standing StandingOf(const bag::BagTopic& topic) {
  if (WithSlash(topic.name).ends_with("/tf_static")) return Standing::kYes;
  return topic.is_latched ? Standing::kIfEqual : Standing::kNo;
}

/// Whether a frame is called as one that is fixed, also with the name of a robot before it.
bool IsCalledFixed(std::string_view frame) {
  constexpr std::array<std::string_view, 9> kFixed = {
      "map", "odom", "earth", "world", "camera_init", "global", "utm", "enu", "ecef"};
  frame.remove_prefix(frame.rfind('/') + 1);  // npos + 1 is 0.
  std::string name(frame);
  std::ranges::transform(name, name.begin(), [](char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  });
  for (const std::string_view suffix : {"_frame", "_link"}) {
    if (name.ends_with(suffix)) name.resize(name.size() - suffix.size());
  }
  return std::ranges::any_of(kFixed, [&](std::string_view fixed) {
    return name == fixed || name.ends_with('_' + std::string(fixed));
  });
}

/// Whether a frame is called as one of a vehicle.
bool IsCalledVehicle(std::string_view frame) {
  constexpr std::array<std::string_view, 5> kVehicles = {"base", "body", "vehicle", "ego", "imu"};
  frame.remove_prefix(frame.rfind('/') + 1);
  return std::ranges::any_of(kVehicles,
                             [&](std::string_view name) { return frame.starts_with(name); });
}

}  // namespace

Remark TfTopics::RemarkOnOthers() const {
  return {.kind = RemarkKind::kTransformsElsewhere,
          .place = {},
          .number = others.size(),
          .detail = Join(others) + (names.empty() ? "" : "; the clouds' are " + names)};
}

TfTopics TfTopicsFor(const std::string& clouds, const std::vector<bag::BagTopic>& topics) {
  std::vector<std::string> wanted;
  const std::string name = WithSlash(clouds);
  for (const char* const base : {"/tf", "/tf_static"}) {
    const auto is_there = [&](const std::string& full) {
      return std::ranges::any_of(topics, [&](const bag::BagTopic& topic) {
        return topic.type == ros::TfMessage::kName && WithSlash(topic.name) == full;
      });
    };
    for (std::size_t slash = name.rfind('/');; slash = name.rfind('/', slash - 1)) {
      if (is_there(name.substr(0, slash) + base)) wanted.push_back(name.substr(0, slash) + base);
      if (slash == 0 || (!wanted.empty() && wanted.back().ends_with(base))) break;
    }
  }
  TfTopics found;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    if (topics[i].type != ros::TfMessage::kName) continue;
    const std::string shown = ShownText(topics[i].name);
    if (std::ranges::find(wanted, WithSlash(topics[i].name)) == wanted.end()) {
      found.others.push_back(shown);
      continue;
    }
    found.chosen.push_back(i);
    found.names += (found.names.empty() ? "" : ", ") + shown;
  }
  return found;
}

std::string PlainFrame(const std::string& frame) {
  return frame.starts_with('/') ? frame.substr(1) : frame;
}

std::string FaultOf(const ros::TransformStamped& transform) {
  const std::string child = PlainFrame(transform.child_frame_id);
  const std::string parent = PlainFrame(transform.header.frame_id);
  if (child.empty() || parent.empty()) return "a frame without a name";
  if (child == parent) return "from itself";
  const auto& [position, rotation] = transform.transform;
  if (!Vector3(position.x, position.y, position.z).allFinite()) return "a position that is none";
  const double length = Eigen::Vector4d(rotation.x, rotation.y, rotation.z, rotation.w).norm();
  constexpr double kTolerance = 0.1;  // As tf2 has it.
  if (std::abs(length - 1.0) <= kTolerance) return {};
  return "a quaternion of length " + ShortText(length);
}

void TfTree::Add(const ros::TransformStamped& transform, const bag::BagTopic& topic) {
  const Standing standing = StandingOf(topic);
  const auto& position = transform.transform.translation;
  const Vector3 position_m(position.x, position.y, position.z);
  ToFrame to{PlainFrame(transform.header.frame_id), standing != Standing::kNo, transform.transform,
             position_m, position_m};
  const auto [known, is_new] = frames_.try_emplace(PlainFrame(transform.child_frame_id), to);
  if (is_new) {
    if (frames_.size() <= kMaxFrames) return;
    throw InputError("must have at most " + NumberText(kMaxFrames) + " frames of reference");
  }
  if (standing == Standing::kIfEqual) {
    to.is_static = known->second.is_static && known->second.last == to.last;
  }
  if (known->second.parent == to.parent) {
    to.lowest_m = known->second.lowest_m.cwiseMin(position_m);
    to.highest_m = known->second.highest_m.cwiseMax(position_m);
  }
  known->second = std::move(to);
}

std::vector<TfStep> TfTree::WayUp(const std::string& frame) const {
  std::vector<TfStep> way;
  for (auto found = frames_.find(frame); found != frames_.end();
       found = frames_.find(found->second.parent)) {
    if (way.size() == frames_.size()) break;  // In circles.
    way.push_back({found->first, found->second.parent, found->second.is_static});
  }
  return way;
}

bool TfTree::IsFixed(const std::string& frame) const {
  if (IsCalledFixed(frame)) return true;
  const auto is_moving = [](const TfStep& step) { return !step.is_static; };
  if (frame.empty() || std::ranges::any_of(WayUp(frame), is_moving)) return false;
  constexpr double kTravel_m = 0.5;  // Farther than wheels and wipers do.
  std::multimap<std::string_view, std::string_view> below;
  for (const auto& [child, to] : frames_) below.emplace(to.parent, child);
  std::set<std::string_view> passed = {frame};
  std::vector<std::string_view> waiting = {frame};
  while (!waiting.empty()) {
    const auto [begin, end] = below.equal_range(waiting.back());
    waiting.pop_back();
    for (auto entry = begin; entry != end; ++entry) {
      const std::string_view child = entry->second;
      const ToFrame& to = frames_.find(child)->second;
      const bool travels = !to.is_static && (to.highest_m - to.lowest_m).norm() >= kTravel_m;
      // One of another name that leads nowhere may be a fixed one, written the other way round.
      const bool is_vehicle = IsCalledVehicle(child) || below.contains(child);
      if (travels && is_vehicle && !IsCalledFixed(child)) return true;
      if (passed.insert(child).second) waiting.push_back(child);
    }
  }
  return false;
}

std::vector<TfStep> TfTree::WayToFixed(const std::string& frame) const {
  std::vector<TfStep> way = WayUp(frame);
  if (!way.empty() && frames_.contains(way.back().parent)) {
    throw InputError("frames of reference must not go in circles (got " + Quoted(frame) + ")");
  }
  const bool is_moving =
      std::ranges::any_of(way, [](const TfStep& step) { return !step.is_static; });
  if (is_moving || (!way.empty() && IsCalledFixed(way.back().parent))) return way;
  return WayToNamed(frame);
}

std::vector<TfStep> TfTree::WayToNamed(const std::string& frame) const {
  std::map<std::string, std::vector<TfStep>> steps_from;
  for (const auto& [child, to] : frames_) {
    steps_from[child].push_back({child, to.parent, to.is_static});
    steps_from[to.parent].push_back({child, to.parent, to.is_static, true});
  }
  const auto end_of = [](const TfStep& step) -> const std::string& {
    return step.is_downwards ? step.child : step.parent;
  };
  std::map<std::string, const TfStep*> step_to;  // The last of the shortest way.
  std::queue<std::string> waiting({frame});
  std::string farthest;
  while (!waiting.empty()) {
    const std::string from = std::move(waiting.front());
    waiting.pop();
    if (from != frame && IsCalledFixed(from)) farthest = from;
    for (const TfStep& step : steps_from[from]) {
      const std::string& to = end_of(step);
      if (to != frame && step_to.emplace(to, &step).second) waiting.push(to);
    }
  }
  std::vector<TfStep> way;
  for (std::string at = farthest; !at.empty() && at != frame;) {
    const TfStep& step = *step_to.at(at);
    way.push_back(step);
    at = step.is_downwards ? step.parent : step.child;
  }
  std::ranges::reverse(way);
  return way;
}

std::optional<Remark> TfTree::WhyNoWay(const std::string& frame, const TfTopics& topics) const {
  if (frames_.empty()) return std::nullopt;
  std::set<std::string> names;
  for (const auto& [child, to] : frames_) names.insert({child, to.parent});
  std::string list;
  constexpr std::size_t kMost = 20;
  std::size_t num = 0;
  for (const std::string& name : names) {
    if (num++ < kMost) list += (list.empty() ? "" : ", ") + ShownText(name);
  }
  if (num > kMost) list += " and " + NumberText(num - kMost) + " others";
  const std::string reason =
      frame.empty() ? "the clouds have no frame_id"
      : !names.contains(frame)
          ? "no transform leads to " + Quoted(frame)
          : "nothing moves " + Quoted(frame) + ", nor is it linked to a " + "fixed frame";
  return Remark{.kind = RemarkKind::kPosesUnknown,
                .place = {},
                .detail = reason + "; frames of " + topics.names + ": " + list};
}

TfTree ReadTree(bag::BagReader& bag,
                const std::vector<std::size_t>& topics,
                std::vector<Remark>& remarks) {
  TfTree tree;
  Remark invalid{.kind = RemarkKind::kTransformsInvalid, .place = {}, .number = 0};
  const auto take = [&](const ros::TransformStamped& transform, const bag::BagMessage& message) {
    const bag::BagTopic& topic = bag.topics()[message.topic];
    const std::string fault = FaultOf(transform);
    if (fault.empty()) return tree.Add(transform, topic);
    if (invalid.number++ > 0) return;
    invalid.place = ShownText(topic.name);
    invalid.detail = Quoted(transform.child_frame_id) + ": " + fault;
  };
  ForEachTransform(bag, topics, take);
  if (invalid.number > 0) remarks.push_back(std::move(invalid));
  return tree;
}

}  // namespace railcast
