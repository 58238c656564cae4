#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>

#include "core/io/recording/recording.h"

namespace railcast {

/// A .pcap or .pcapng capture of VLP-16, HDL-32E, VLP-32C or Pandar64: a frame for each turn, the
/// first and last of which are usually cut short. The first packet of one of these says which;
/// datagrams of anything else, and damaged ones, are left out. Packets that segmentation offload
/// merged into one datagram are cut apart.
/// @throws InputError with one line that says what was found instead; so does reading, where a
///   merged datagram ends within a packet.
[[nodiscard]] std::unique_ptr<Recording> OpenCapture(const std::filesystem::path& file);

/// The same of a capture that `open` opens, which is called twice: to look what is in it, and to
/// read it. @param name What faults call it.
[[nodiscard]] std::unique_ptr<Recording> OpenCapture(const std::function<std::FILE*()>& open,
                                                     const std::string& name);

}  // namespace railcast
