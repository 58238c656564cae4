#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "railcast/frame.h"
#include "railcast/transform.h"

// Functions that return clouds of PCL can be used by programs that have PCL's headers.
#if __has_include(<pcl/PCLPointCloud2.h>)
#include <pcl/PCLPointCloud2.h>
#else
namespace pcl {
struct PCLPointCloud2;
}
#endif

namespace railcast {

struct FrameTrack;

/// Selects which fields of the frame's table (ForEachField() in railcast/frame.h) a file carries,
/// and which values of the points relative to the vehicle's track
/// (core/io/cloud/track_fields.h). Fields are always stored in the table's order, those of the
/// track last: FieldSelection("label,x,y,z") stores x, y, z, label.
class FieldSelection {
 public:
  /// Selects every field that frames of all sensors have.
  FieldSelection();
  /// @param list Names separated by commas, in any order; "all" selects every field of the frame.
  /// @param has_velocity Whether the selection is for frames with velocities (Frame::has_velocity).
  /// @param has_track Whether the track of the frames' vehicle is known, so that the list may name
  ///   its fields.
  /// @throws InputError if a name is unknown (the message names the closest and all valid ones) or
  ///   is given twice.
  explicit FieldSelection(std::string_view list, bool has_velocity = false, bool has_track = false);

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] bool Has(std::string_view name) const;
  /// The names separated by commas, as the second constructor reads them.
  [[nodiscard]] std::string Text() const;

  /// Whether any field is one of the track; if so, call SetTrack() before a frame is stored.
  [[nodiscard]] bool NeedsTrack() const;
  void SetTrack(std::shared_ptr<const FrameTrack> track) { track_ = std::move(track); }
  [[nodiscard]] const FrameTrack* track() const { return track_.get(); }

  /// Whether both select the same fields.
  bool operator==(const FieldSelection& other) const { return names_ == other.names_; }

 private:
  std::vector<std::string> names_;
  std::shared_ptr<const FrameTrack> track_;
};

/// Encodings of the points of a PCD file.
enum class PcdEncoding {
  kBinary,            ///< Point by point, unpadded; the fastest to write.
  kBinaryCompressed,  ///< Field by field, LZF-compressed.
  kAscii,             ///< Shortest digits that read back as the same float (at most 9).
};

/// Encodes a frame as a PCD v0.7 file into `bytes`, whose memory is reused from frame to frame.
///
/// The cloud is organised: WIDTH = frame.width(), HEIGHT = frame.rows. Slots without a point have
/// NaN coordinates. VIEWPOINT stays identity, because PCL rounds it to float32. Types are the
/// frame's own: float32 F 4, label and instance U 4 (as PCL's PointXYZL needs), ring U 2, outcome U
/// 1.
void EncodePcd(const Frame& frame,
               const FieldSelection& fields,
               PcdEncoding encoding,
               std::string& bytes);

/// Naming conventions of a PLY file.
enum class PlyFlavour {
  /// Names and types of the frame (`uint label`), as PCL's PointXYZL and PointXYZI need them.
  kPcl,
  /// Opens without loss in both CloudCompare and Open3D: every field but x, y, z is named
  /// `scalar_*` and stored as int, float or double (Open3D drops unsigned properties). time_ns is a
  /// double.
  kCloudCompare,
};

/// Encodes a frame's points as a binary little-endian PLY file into `bytes`.
///
/// PLY has no organised clouds, and its viewers do not handle missing points, so the file holds
/// only the slots that have a point (HasPoint); ring, column and return_index identify the firing
/// of each. PCL's PLYWriter is not used: it keeps NaN points and adds a camera element, or drops
/// points by a test of all fields, and it reports success on a full disk.
/// @throws InputError if x, y or z is not selected, or an id does not fit kCloudCompare's int.
void EncodePly(const Frame& frame,
               const FieldSelection& fields,
               PlyFlavour flavour,
               std::string& bytes);

struct FrameFileSpec;
struct CloudFile;

/// One encoded file of a frame, not yet written.
struct FrameFile {
  std::string name;  ///< Relative to the sequence directory: "frames/000012.pcd".
  std::string bytes;
};

/// One of the files that a format writes per frame. Its name consists of folder, number and
/// extension.
struct FrameFileKind {
  std::string_view folder;     ///< Such as "frames/".
  std::string_view extension;  ///< Such as ".pcd".
};

/// Additional files of a format that is the layout of a whole dataset. Its frames are numbered from
/// 0, are in right-handed sensor coordinates, and have a fixed set of fields.
struct DatasetLayout {
  std::string_view title;                      ///< Name in messages: "KITTI".
  std::vector<std::string_view> record_files;  ///< Files with one line per frame.
  /// Makes a frame's lines of `record_files`, in their order.
  /// @param since_first_s Time since the stamp of the run's first frame.
  std::vector<std::string> (*record_lines)(const Transform& first_from_sensor,
                                           double since_first_s);
  /// Makes the files that exist once per run.
  std::vector<FrameFile> (*fixed_files)(const LabelTable& labels);
};

/// Everything that railcast knows about a file format for frames.
struct FrameFormat {
  std::string_view name;  ///< Name on command lines and in run.json.
  /// Files per frame; the points file comes first. None if only the records of frames are written.
  std::vector<FrameFileKind> files;
  /// Encodes a frame: fills the bytes of one file for each of `files`.
  /// @param moving Instance ids of moving objects, for which KITTI has separate labels.
  /// @throws InputError if the format cannot represent the frame.
  void (*encode)(const Frame& frame,
                 const FrameFileSpec& spec,
                 const std::set<std::uint32_t>& moving,
                 std::vector<FrameFile>& files);
  /// Parses the points file held in `bytes`, to which the result refers, given the content of the
  /// second file if there is one. Null if railcast does not read the format.
  /// @throws InputError with one line if a file is damaged.
  CloudFile (*parse)(const std::string& file,
                     std::string_view bytes,
                     const std::optional<std::string>& second) = nullptr;
  bool has_all_slots = false;  ///< Whether the file also stores slots without a point.
  std::optional<DatasetLayout> dataset{};
  /// Name of the bag of ROS 2 messages that holds the frames of all sensors of a run, in the run's
  /// directory: a file with the extension .mcap or the directory of a rosbag2. Empty = none.
  std::string_view bag{};
  /// Extension of the trace of OSI messages (core/io/run/trace_name.h) that holds the frames of a
  /// sensor, in its directory. Empty = none.
  std::string_view trace{};
};

/// The table of all formats.
[[nodiscard]] const std::vector<FrameFormat>& FrameFormats();

[[nodiscard]] std::vector<std::string> FrameFormatNames();

/// The format of that name.
/// @throws InputError if there is none; the message names the valid ones.
[[nodiscard]] const FrameFormat& ParseFrameFormat(std::string_view name);

/// How frames are stored in files.
struct FrameFileSpec {
  const FrameFormat* format = &FrameFormats().front();
  FieldSelection fields;  ///< Ignored by formats with fixed fields.
  LabelTable labels;      ///< Used by KITTI only.
};

/// The format of that name; null if there is none.
[[nodiscard]] const FrameFormat* FindFrameFormat(std::string_view name);

/// The format that reads points files with this name; null if there is none.
[[nodiscard]] const FrameFormat* FindReader(const std::filesystem::path& file);

/// The extensions of all points files that can be read, followed by `more`: ".pcd, .ply or .bin".
/// @param with_datasets Whether to include those of dataset layouts.
[[nodiscard]] std::string ReadableExtensions(bool with_datasets,
                                             const std::vector<std::string>& more = {});

/// The names of a frame's files relative to the sequence directory: "frames/000012.pcd"; for KITTI,
/// the points file and then the labels file.
/// @param number Number in the name, padded to at least six digits.
[[nodiscard]] std::vector<std::string> FrameFileNames(const FrameFormat& format,
                                                      std::uint32_t number);

/// Encodes a frame into the file or files (KITTI: points and labels) that store it. `files` reuses
/// its memory from frame to frame.
/// @param number As in FrameFileNames().
/// @param moving Instance ids of moving objects, for which KITTI has separate labels.
/// @throws InputError as the format's encoder does.
void EncodeFrameFiles(const Frame& frame,
                      const FrameFileSpec& spec,
                      std::uint32_t number,
                      std::vector<FrameFile>& files,
                      const std::set<std::uint32_t>& moving = {});

/// Reads a PCD file of any encoding and with any fields, whether or not railcast wrote it.
///
/// For files that are whole, the cloud is that of pcl::io::loadPCDFile(), for any encoding.
/// @throws InputError with one line if the file cannot be read or is damaged.
[[nodiscard]] pcl::PCLPointCloud2 ReadPcd(const std::filesystem::path& file);

/// Reads the points of a PLY file, ASCII or binary little-endian, with every scalar property under
/// its own name and type. Faces and other elements are skipped. A cloud without points is allowed.
///
/// PCL's PLYReader is not used: it takes a cloud's shape from comments and camera elements,
/// converts colours and intensities to other types, and crashes where they contradict the number of
/// points.
/// @throws InputError with one line if the file cannot be read or is damaged.
[[nodiscard]] pcl::PCLPointCloud2 ReadPly(const std::filesystem::path& file);

/// As ReadPly(), for a file already held in `bytes`.
/// @param file Name used in error messages.
[[nodiscard]] pcl::PCLPointCloud2 ParsePly(const std::string& file, const std::string& bytes);

}  // namespace railcast
