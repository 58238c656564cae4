#pragma once

#include <string>

#include "core/frame/frame.h"
#include "core/io/field_selection.h"

namespace railcast {

/// How the points of a PCD file are stored.
enum class PcdEncoding {
  kBinary,            ///< Point by point, unpadded. The fastest to write.
  kBinaryCompressed,  ///< Field by field, LZF.
  kAscii,             ///< Shortest digits that give the same float back (at most 9).
};

/// Puts a frame as a PCD v0.7 file into `bytes`; keeps its memory from frame to frame.
///
/// The cloud is organised: WIDTH = frame.width(), HEIGHT = frame.rows; a slot without a point has
/// NaN coordinates. VIEWPOINT stays identity (PCL rounds it to float32). Types are the frame's own:
/// float32 F 4, label and instance U 4 (as PCL's PointXYZL needs), ring U 2, outcome U 1.
void EncodePcd(const Frame& frame,
               const FieldSelection& fields,
               PcdEncoding encoding,
               std::string& bytes);

}  // namespace railcast
