#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "viewer/color/rgb.h"

namespace railcast {

/// Lines and words over a cloud, in the sensor's axes at the frame's stamp, metres.
struct Drawing {
  struct Segment {
    Eigen::Vector3f from_m;
    Eigen::Vector3f to_m;
    Rgb rgb{};
    float opacity = 1.0F;
  };
  struct Word {
    Eigen::Vector3f at_m;
    std::string text;
    Rgb rgb{};
  };
  std::vector<Segment> segments;
  std::vector<Word> words;
};

}  // namespace railcast
