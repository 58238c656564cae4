#pragma once

#include <string>

#include "core/frame/frame.h"
#include "core/io/field_selection.h"

namespace railcast {

/// Whose conventions a PLY file follows.
enum class PlyFlavour {
  /// Names and types of the frame (`uint label`), as PCL's PointXYZL and PointXYZI need them.
  kPcl,
  /// What CloudCompare and Open3D both open in full: every field but x, y, z is called `scalar_*`
  /// and is an int, float or double (Open3D drops unsigned properties). time_ns is a double.
  kCloudCompare,
};

/// Puts a frame's points as a binary little-endian PLY file into `bytes`.
///
/// PLY knows no organised clouds and its viewers no missing points, so it holds only the slots that
/// have a point (HasPoint); ring, column and return_index tell which firing each belongs to.
/// Written here and not by PCL's PLYWriter, which keeps NaN points and adds a camera element, or
/// drops points by a test of all fields, and which reports success on a full disk.
/// @throws InputError if x, y or z is not selected, or an id does not fit kCloudCompare's int.
void EncodePly(const Frame& frame,
               const FieldSelection& fields,
               PlyFlavour flavour,
               std::string& bytes);

}  // namespace railcast
