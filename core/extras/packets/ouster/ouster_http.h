#pragma once

#include "core/io/net/http_server.h"
#include "core/scenario/json_text.h"

namespace railcast {

/// Answers what drivers of Ouster's sensors ask a sensor over HTTP before they listen to its
/// packets (Ouster, HTTP API reference; ouster-lidar/ouster-sdk, sensor_http_imp.cpp): its metadata
/// as a whole and section by section, firmware and configuration. A driver that sets the
/// configuration is answered that this is done if it asks for what is so already, and otherwise
/// what differs.
/// @param metadata As MetadataOfStream() makes it.
[[nodiscard]] HttpAnswer AnswerAsOuster(const Json& metadata, const HttpRequest& request);

}  // namespace railcast
