#pragma once

#include <cpl_error.h>

#include <array>
#include <string>
#include <string_view>

namespace railcast {

/// Keeps GDAL from printing while it lives, and keeps the first of its errors.
///
/// Of a .pbf file it passes over blobs that are compressed in another way than with zlib, so that a
/// map would seem empty, and says so only where CPL_DEBUG has PBF: that is an error here.
class GdalErrors {
 public:
  GdalErrors() { CPLPushErrorHandlerEx(&GdalErrors::Take, this); }
  ~GdalErrors() { CPLPopErrorHandler(); }
  GdalErrors(const GdalErrors&) = delete;
  GdalErrors& operator=(const GdalErrors&) = delete;

  [[nodiscard]] const std::string& first() const { return first_; }
  /// Formats that do not fit are errors, too, until one does.
  void Forget() { first_.clear(); }

 private:
  static void CPL_STDCALL Take(CPLErr kind, CPLErrorNum /*number*/, const char* message) {
    auto& errors = *static_cast<GdalErrors*>(CPLGetErrorHandlerUserData());
    if (!errors.first_.empty()) return;
    if (kind == CE_Debug) {
      errors.first_ = UnreadCompression(message);
    } else if (kind >= CE_Failure) {
      errors.first_ = *message != '\0' ? message : "unknown error";
    }
  }

  /// What is wrong with a blob that is passed over, by the number that its data has as a field
  /// (https://wiki.openstreetmap.org/wiki/PBF_Format); empty for any other message.
  [[nodiscard]] static std::string UnreadCompression(std::string_view message) {
    constexpr std::array<std::string_view, 4> kCompressions = {"lzma", "bzip2", "lz4", "zstd"};
    constexpr std::size_t kFirstField = 4;
    for (std::size_t i = 0; i < kCompressions.size(); ++i) {
      if (message == "PBF: Unhandled case: nFieldNumber = " + std::to_string(kFirstField + i) +
                         ", nWireType = 2") {
        return "blobs must be zlib or plain; field " + std::to_string(kFirstField + i) + " (" +
               std::string(kCompressions[i]) + ") is passed over";
      }
    }
    return "";
  }

  std::string first_;
};

}  // namespace railcast
