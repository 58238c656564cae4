#pragma once

#include <cpl_error.h>

#include <string>

namespace railcast {

/// Keeps GDAL from printing while it lives, and keeps the first of its errors.
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
    if (!errors.first_.empty() || kind < CE_Failure) return;
    errors.first_ = *message != '\0' ? message : "unknown error";
  }

  std::string first_;
};

}  // namespace railcast
