#include "viewer/draw/stage.h"

#include <X11/Xlib.h>

#include "core/base/error.h"

namespace railcast {

DisplayConnection::DisplayConnection() : display_(XOpenDisplay(nullptr)) {
  if (display_ == nullptr) {
    throw InputError(
        "no display: on a machine without one, run xvfb-run -a -s -noreset railcast-view ...");
  }
}

DisplayConnection::~DisplayConnection() {
  XCloseDisplay(static_cast<Display*>(display_));
}

}  // namespace railcast
