#pragma once

#include <string>
#include <vector>

#include "core/io/cloud/cloud.h"
#include "railcast/frame.h"
#include "railcast/io/cloud_files.h"
#include "railcast/remark.h"

namespace railcast {

/// The frame as a PCD file.
[[nodiscard]] inline std::string PcdBytes(const Frame& frame,
                                          const FieldSelection& fields = {},
                                          PcdEncoding encoding = PcdEncoding::kBinary) {
  std::string bytes;
  EncodePcd(frame, fields, encoding, bytes);
  return bytes;
}

/// The frame as a PLY file.
[[nodiscard]] inline std::string PlyBytes(const Frame& frame,
                                          const FieldSelection& fields = {},
                                          PlyFlavour flavour = PlyFlavour::kPcl) {
  std::string bytes;
  EncodePly(frame, fields, flavour, bytes);
  return bytes;
}

/// The numbers of a field, point after point.
[[nodiscard]] inline std::vector<double> FieldNumbers(const Cloud& cloud, const std::string& name) {
  std::vector<double> numbers;
  VisitField(cloud, *cloud.Find(name),
             [&](std::size_t, auto value) { numbers.push_back(static_cast<double>(value)); });
  return numbers;
}

/// Names and numbers of remarks: "points-beyond 2".
[[nodiscard]] inline std::vector<std::string> RemarkTexts(const std::vector<Remark>& remarks) {
  std::vector<std::string> texts;
  for (const Remark& remark : remarks) {
    texts.push_back(std::string(remark.type().name) + " " + std::to_string(remark.number));
  }
  return texts;
}

}  // namespace railcast
