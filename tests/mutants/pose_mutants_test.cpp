#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "core/base/text.h"
#include "generator/extras/insert/plan/pose_file.h"
#include "tests/mutants/mutants.h"

namespace railcast {
namespace {

Reading ReadPosesWhole(const std::filesystem::path& file) {
  Reading reading;
  SetRemarkReceiver([&](const Remark& remark) { reading.remarks.push_back(remark); });
  const PoseFile poses = ReadPoseFile(file, "lidar");
  SetRemarkReceiver(nullptr);
  for (const Transform& pose : poses.world_from_sensor) {
    reading.values.insert(reading.values.end(), pose.matrix().data(), pose.matrix().data() + 16);
  }
  for (const std::int64_t stamp_ns : poses.stamps_ns) {
    reading.values.push_back(1e-9 * static_cast<double>(stamp_ns));
  }
  return reading;
}

constexpr std::size_t kPoses = 12;
constexpr double kFirst_s = 1'700'000'000.0;

/// The numbers of a pose: time in s, x, y, z in m, qx, qy, qz, qw. The sensor goes round an arc.
std::array<double, 8> PoseNumbers(std::size_t i) {
  const double turned_rad = 0.3 + 0.02 * static_cast<double>(i);
  return {0.1 * static_cast<double>(i),
          100.0 * std::sin(turned_rad),
          100.0 * (1.0 - std::cos(turned_rad)),
          4.0,
          0.01,
          0.02,
          std::sin(turned_rad / 2.0),
          std::sqrt(1.0 - 0.0005 - std::pow(std::sin(turned_rad / 2.0), 2))};
}

using PoseChange = std::function<void(std::size_t i, std::array<double, 8>& numbers)>;

std::string ShownStamp(double since_first_s, bool is_csv) {
  const auto ns = static_cast<std::int64_t>(std::llround(1e9 * since_first_s)) +
                  static_cast<std::int64_t>(kFirst_s) * 1'000'000'000;
  if (is_csv) return std::to_string(ns);
  std::string fraction = std::to_string(ns % 1'000'000'000);
  fraction.insert(0, 9 - fraction.size(), '0');
  return std::to_string(ns / 1'000'000'000) + "." + fraction;
}

std::string PoseText(bool is_csv, const PoseChange& change = {}) {
  std::string text = is_csv ? "stamp_ns,x,y,z,qx,qy,qz,qw\n" : "";
  for (std::size_t i = 0; i < kPoses; ++i) {
    std::array<double, 8> numbers = PoseNumbers(i);
    if (change) change(i, numbers);
    text += ShownStamp(numbers[0], is_csv);
    for (std::size_t k = 1; k < 8; ++k) text += (is_csv ? "," : " ") + NumberText(numbers.at(k));
    text += "\n";
  }
  return text;
}

// NOLINTNEXTLINE(readability-function-size): a list of changes
void TryPoses(Mutants& mutants, bool is_csv) {
  const auto with = [&](const std::string& what, const std::string& detail,
                        const PoseChange& change) {
    mutants.Try(what, detail, PoseText(is_csv, change));
  };
  for (std::size_t at = 0; at < kPoses; ++at) {
    const std::string detail = "pose " + NumberText(at);
    const auto one = [&](const std::string& what,
                         const std::function<void(std::array<double, 8>&)>& change) {
      with(what, detail, [&](std::size_t i, auto& numbers) {
        if (i == at) change(numbers);
      });
    };
    for (const double factor : {0.0, 0.5, 2.0, 1e3}) {
      one("a rotation of another length", [&](auto& numbers) {
        for (std::size_t k = 4; k < 8; ++k) numbers.at(k) *= factor;
      });
    }
    one("a place not a number", [](auto& numbers) { numbers[1] = std::nan(""); });
    one("a place in millimetres", [](auto& numbers) {
      for (std::size_t k = 1; k < 4; ++k) numbers.at(k) *= 1e3;
    });
    one("a place 1 km away", [](auto& numbers) { numbers[2] += 1e3; });
    if (at > 0) one("a time before the others", [](auto& numbers) { numbers[0] -= 100.0; });
    if (at > 0) one("a time as the one before", [](auto& numbers) { numbers[0] -= 0.1; });
    if (at + 1 < kPoses)
      one("a time behind the others", [](auto& numbers) { numbers[0] += 1000.0; });
  }
  with("places in millimetres", "", [](std::size_t, auto& numbers) {
    for (std::size_t k = 1; k < 4; ++k) numbers.at(k) *= 1e3;
  });
  with("times that are all one", "", [](std::size_t, auto& numbers) { numbers[0] = 0.0; });
  with("times in another unit", "ms", [](std::size_t, auto& numbers) { numbers[0] *= 1e3; });
  with("times in another unit", "us", [](std::size_t, auto& numbers) { numbers[0] *= 1e6; });
  with("times in another unit", "1/1000", [](std::size_t, auto& numbers) { numbers[0] *= 1e-3; });
  with("times that go back", "",
       [](std::size_t, auto& numbers) { numbers[0] = 10.0 - numbers[0]; });
  with("the real part of rotations first", "", [](std::size_t, auto& numbers) {
    std::rotate(numbers.begin() + 4, numbers.begin() + 7, numbers.end());
  });
  with("rotations before places", "", [](std::size_t, auto& numbers) {
    std::rotate(numbers.begin() + 1, numbers.begin() + 4, numbers.end());
  });
  with("the time last", "", [](std::size_t, auto& numbers) {
    std::rotate(numbers.begin(), numbers.begin() + 1, numbers.end());
  });
  const std::string& good = mutants.good();
  const std::string blank = is_csv ? "," : " ";
  for (std::size_t i = 0; i < 7 * kPoses; ++i) {
    mutants.Try("a word lost", NumberText(i), Replaced(good, blank, "", i));
    for (const char* other : {"x", ";", "  ", ",", "\n", "\t"})
      mutants.Try("another mark between numbers", other + NumberText(i),
                  Replaced(good, blank, other, i));
    mutants.Try("a decimal comma", NumberText(i), Replaced(good, ".", ",", i));
  }
  if (is_csv) {
    for (const char* head : {"stamp_s,x,y,z,qx,qy,qz,qw", "stamp_ns,x,y,z,qw,qx,qy,qz",
                             "stamp_ns,y,x,z,qx,qy,qz,qw", "timestamp,x,y,z,qx,qy,qz,qw", ""}) {
      mutants.Try("another header", head, Replaced(good, "stamp_ns,x,y,z,qx,qy,qz,qw", head));
    }
  }
  for (std::size_t size = 1; size + 1 < good.size(); size += 3)
    mutants.Try("cut off", NumberText(size), good.substr(0, size));
}

TEST(PoseMutants, AreNeverReadWrongWithoutAWord) {
  Mutants of_csv("poses.csv", "a.csv", PoseText(true), ReadPosesWhole);
  TryPoses(of_csv, true);
  Mutants of_tum("poses of TUM", "a.tum", PoseText(false), ReadPosesWhole);
  TryPoses(of_tum, false);
  for (Mutants* mutants : {&of_csv, &of_tum}) {
    mutants->Excuse("cut off", "whether there is a pose for each frame is asked later");
  }
  CheckSection("Poses", {&of_csv, &of_tum});
}

}  // namespace
}  // namespace railcast
