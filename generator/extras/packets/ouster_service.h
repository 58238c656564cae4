#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/io/net/http_server.h"
#include "generator/live/live_streams.h"
#include "railcast/scenario.h"

namespace railcast {

/// Writes the metadata of an Ouster sensor that is captured beside its capture, as Ouster's
/// programs name them: drive_0.json for drive.pcap. Does nothing for other streams.
/// @throws InputError if there is another file of that name, or if the system refuses.
void WriteMetadataBeside(const SensorStreamSpec& stream, const LidarSpec& lidar);

/// Answers the drivers of an Ouster sensor over HTTP for as long as the result lives.
/// @param at HOST:PORT of this machine.
/// @throws InputError "--http: ..." if there is not one stream, of protocol ouster, or if the
/// address
///   cannot be used.
[[nodiscard]] std::unique_ptr<HttpServer> ServeOuster(const std::string& at,
                                                      const std::vector<SensorStreamSpec>& streams,
                                                      const ScenarioSpec& scenario);

}  // namespace railcast
