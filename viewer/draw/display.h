#pragma once

namespace railcast {

/// A connection to the X server, to be held for as long as anything is drawn. VTK ends the process
/// where there is no server, and a server that loses its last client may be unavailable for a
/// moment.
class DisplayConnection {
 public:
  /// @throws InputError if there is no display.
  DisplayConnection();
  ~DisplayConnection();
  DisplayConnection(const DisplayConnection&) = delete;
  DisplayConnection& operator=(const DisplayConnection&) = delete;

 private:
  void* display_;
};

}  // namespace railcast
