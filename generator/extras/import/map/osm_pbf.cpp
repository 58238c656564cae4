// The encoding of https://wiki.openstreetmap.org/wiki/PBF_Format.
#include <cpl_conv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "generator/extras/import/map/map_formats.h"
#include "generator/extras/import/map/osm_map.h"

namespace railcast {
namespace {

[[noreturn]] void FailDamaged() {
  throw InputError("must be a .pbf file to its end (got damaged data)");
}

std::string_view TakeBytes(std::string_view& rest, std::uint64_t num) {
  if (num > rest.size()) FailDamaged();
  const std::string_view bytes = rest.substr(0, num);
  rest.remove_prefix(num);
  return bytes;
}

std::uint64_t TakeVarint(std::string_view& rest) {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const auto byte = static_cast<unsigned char>(TakeBytes(rest, 1).front());
    value |= std::uint64_t{byte & 0x7FU} << shift;
    if (byte < 0x80) return value;
  }
  FailDamaged();
}

std::int64_t Unzigzagged(std::uint64_t value) {
  return static_cast<std::int64_t>(value >> 1U) ^ -static_cast<std::int64_t>(value & 1U);
}

struct PbfField {
  std::uint64_t number{};
  std::uint64_t value{};   ///< Of a number.
  std::string_view bytes;  ///< Of anything else.
};

/// Visits the fields of a message.
template <class Visit>
void VisitFields(std::string_view message, const Visit& visit) {
  constexpr std::array<std::uint64_t, 6> kFixedBytes = {0, 8, 0, 0, 0, 4};
  while (!message.empty()) {
    const std::uint64_t key = TakeVarint(message);
    PbfField field{key >> 3U, 0, {}};
    const std::uint64_t wire_type = key & 7U;
    if (wire_type == 0) {
      field.value = TakeVarint(message);
    } else if (wire_type == 2) {
      field.bytes = TakeBytes(message, TakeVarint(message));
    } else if (wire_type == 1 || wire_type == 5) {
      field.bytes = TakeBytes(message, kFixedBytes.at(wire_type));
    } else {
      FailDamaged();
    }
    visit(field);
  }
}

std::vector<std::uint64_t> Numbers(std::string_view packed) {
  std::vector<std::uint64_t> numbers;
  while (!packed.empty()) numbers.push_back(TakeVarint(packed));
  return numbers;
}

/// Numbers of which each is given by its difference from the one before.
std::vector<std::int64_t> Sums(std::string_view packed) {
  std::vector<std::int64_t> sums;
  std::uint64_t sum = 0;  // Damaged ones may run over.
  while (!packed.empty()) {
    sum += static_cast<std::uint64_t>(Unzigzagged(TakeVarint(packed)));
    sums.push_back(static_cast<std::int64_t>(sum));
  }
  return sums;
}

/// What is common to the elements of a block.
struct PbfBlock {
  std::vector<std::string_view> texts;
  std::int64_t granularity_ndeg = 100;
  std::int64_t longitude_ndeg = 0;  ///< Of the origin.
  std::int64_t latitude_ndeg = 0;

  [[nodiscard]] std::string TextAt(std::uint64_t index) const {
    if (index >= texts.size()) FailDamaged();
    return std::string(texts[index]);
  }
  [[nodiscard]] Eigen::Vector2d Place_deg(std::int64_t longitude, std::int64_t latitude) const {
    const auto degrees = [&](std::int64_t origin_ndeg, std::int64_t value, double most_deg) {
      constexpr double kPerDegree = 1e9;  // Dividing by it gives the double of the decimal number.
      const double angle_deg =
          static_cast<double>(static_cast<std::int64_t>(
              static_cast<std::uint64_t>(origin_ndeg) +
              static_cast<std::uint64_t>(granularity_ndeg) * static_cast<std::uint64_t>(value))) /
          kPerDegree;
      if (!(std::abs(angle_deg) <= most_deg)) {
        throw InputError("must have places that are degrees" + Got(angle_deg));
      }
      return angle_deg;
    };
    return {degrees(longitude_ndeg, longitude, kMostLongitude_deg),
            degrees(latitude_ndeg, latitude, kMostLatitude_deg)};
  }
};

/// An element other than a dense node.
struct PbfElement {
  std::int64_t id{};
  MapTags tags;
  bool is_deleted = false;
  std::int64_t longitude{};
  std::int64_t latitude{};
  OsmWay way;
};

/// The fields of a group.
constexpr std::uint64_t kNode = 1;
constexpr std::uint64_t kDenseNodes = 2;
constexpr std::uint64_t kWay = 3;
constexpr std::uint64_t kRelation = 4;

PbfElement ElementOf(const PbfBlock& block, std::string_view message, std::uint64_t kind) {
  const bool is_node = kind == kNode;
  PbfElement element;
  std::vector<std::uint64_t> keys;
  std::vector<std::uint64_t> values;
  std::vector<std::int64_t> longitudes;
  std::vector<std::int64_t> latitudes;
  VisitFields(message, [&](const PbfField& field) {
    if (field.number == 1) {
      element.id = is_node ? Unzigzagged(field.value) : static_cast<std::int64_t>(field.value);
    } else if (field.number == 2) {
      keys = Numbers(field.bytes);
    } else if (field.number == 3) {
      values = Numbers(field.bytes);
    } else if (field.number == 4) {
      VisitFields(field.bytes, [&](const PbfField& info) {
        if (info.number == 6) element.is_deleted = info.value == 0;
      });
    } else if (is_node && field.number == 8) {
      element.latitude = Unzigzagged(field.value);
    } else if (is_node && field.number == 9) {
      element.longitude = Unzigzagged(field.value);
    } else if (kind == kWay && field.number == 8) {
      element.way.nodes = Sums(field.bytes);
    } else if (kind == kWay && field.number == 9) {
      latitudes = Sums(field.bytes);
    } else if (kind == kWay && field.number == 10) {
      longitudes = Sums(field.bytes);
    }
  });
  if (keys.size() != values.size() || latitudes.size() != longitudes.size()) FailDamaged();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    element.tags.emplace(block.TextAt(keys[i]), block.TextAt(values[i]));
  }
  if (latitudes.size() != element.way.nodes.size()) return element;
  for (std::size_t i = 0; i < latitudes.size(); ++i) {
    element.way.drawn_deg.emplace_back(block.Place_deg(longitudes[i], latitudes[i]));
  }
  return element;
}

void RefuseFault(const char* kind, std::int64_t id, const std::optional<Fault>& fault) {
  if (!fault) return;
  throw InputError(
      {Fault{std::string(kind) + " " + std::to_string(id), fault->rule, fault->value}});
}

/// Visits the fields of a block's groups of elements.
template <class Visit>
void VisitGroups(std::string_view data, const Visit& visit) {
  PbfBlock block;
  std::vector<std::string_view> groups;
  VisitFields(data, [&](const PbfField& field) {
    if (field.number == 1) {
      VisitFields(field.bytes, [&](const PbfField& text) { block.texts.push_back(text.bytes); });
    } else if (field.number == 2) {
      groups.push_back(field.bytes);
    } else if (field.number == 17) {
      block.granularity_ndeg = static_cast<std::int64_t>(field.value);
    } else if (field.number == 19) {
      block.latitude_ndeg = static_cast<std::int64_t>(field.value);
    } else if (field.number == 20) {
      block.longitude_ndeg = static_cast<std::int64_t>(field.value);
    }
  });
  for (const std::string_view group : groups) {
    VisitFields(group, [&](const PbfField& field) { visit(block, field); });
  }
}
/// Reads a file's ways first, then the nodes that they need: most of a map are others.
class OsmPbfReader {
 public:
  void ReadWays(std::string_view data) {
    VisitGroups(data, [&](const PbfBlock& block, const PbfField& field) {
      if (field.number != kWay && field.number != kRelation) return;
      const bool is_way = field.number == kWay;
      PbfElement element = ElementOf(block, field.bytes, field.number);
      if (element.is_deleted) {
        const char* kind = is_way ? "way" : "relation";
        RefuseFault(kind, element.id, maker_.AddDeleted(kind, element.id, element.tags));
      } else if (is_way) {
        element.way.id = element.id;
        element.way.tags = std::move(element.tags);
        RefuseFault("way", element.id, maker_.AddWay(std::move(element.way)));
      } else {
        maker_.AddRelation(element.id, element.tags);
      }
    });
  }

  void ReadNodes(std::string_view data) {
    VisitGroups(data, [&](const PbfBlock& block, const PbfField& field) {
      if (field.number == kDenseNodes) ReadDense(block, field.bytes);
      if (field.number != kNode) return;
      PbfElement node = ElementOf(block, field.bytes, kNode);
      if (node.is_deleted) {
        RefuseFault("node", node.id, maker_.AddDeleted("node", node.id, node.tags));
      } else {
        AddNode(node.id, block.Place_deg(node.longitude, node.latitude), std::move(node.tags));
      }
    });
  }

  [[nodiscard]] OsmMapMaker& maker() { return maker_; }

 private:
  void AddNode(std::int64_t id, const Eigen::Vector2d& place_deg, MapTags tags) {
    if (!maker_.Needs(id) && !IsThing(tags)) return;
    RefuseFault("node", id, maker_.AddNode(id, place_deg, std::move(tags)));
  }

  void ReadDense(const PbfBlock& block, std::string_view message) {
    std::vector<std::int64_t> ids;
    std::vector<std::int64_t> latitudes;
    std::vector<std::int64_t> longitudes;
    std::vector<std::uint64_t> words;
    std::vector<std::uint64_t> visible;
    VisitFields(message, [&](const PbfField& field) {
      if (field.number == 1) ids = Sums(field.bytes);
      if (field.number == 8) latitudes = Sums(field.bytes);
      if (field.number == 9) longitudes = Sums(field.bytes);
      if (field.number == 10) words = Numbers(field.bytes);
      if (field.number != 5) return;
      VisitFields(field.bytes, [&](const PbfField& info) {
        if (info.number == 6) visible = Numbers(info.bytes);
      });
    });
    if (latitudes.size() != ids.size() || longitudes.size() != ids.size()) FailDamaged();
    std::size_t word = 0;  // Keys and values in turn; 0 ends those of a node.
    for (std::size_t i = 0; i < ids.size(); ++i) {
      MapTags tags;
      for (; word < words.size() && words[word] != 0; word += 2) {
        if (word + 1 == words.size()) FailDamaged();
        tags.emplace(block.TextAt(words[word]), block.TextAt(words[word + 1]));
      }
      ++word;
      if (i < visible.size() && visible[i] == 0) {
        RefuseFault("node", ids[i], maker_.AddDeleted("node", ids[i], tags));
      } else {
        AddNode(ids[i], block.Place_deg(longitudes[i], latitudes[i]), std::move(tags));
      }
    }
  }

  OsmMapMaker maker_;
};

/// The data of a blob, decompressed.
std::string DataOfBlob(std::string_view blob) {
  constexpr std::uint64_t kMostBytes = 32 << 20;  // By the format.
  constexpr auto kCompressions =
      std::to_array<std::string_view>({"lzma", "bzip2", "lz4", "zstd"});  // Fields from 4 on.
  std::string data;
  std::string_view zlib;
  std::uint64_t raw_size = 0;
  bool has_data = false;
  VisitFields(blob, [&](const PbfField& field) {
    if (field.number == 1) data = field.bytes;
    if (field.number == 2) raw_size = field.value;
    if (field.number == 3) zlib = field.bytes;
    has_data = has_data || field.number == 1 || field.number == 3;
    if (field.number < 4 || field.number >= 4 + kCompressions.size()) return;
    throw InputError(
        "must have blobs that are zlib or plain (osmium cat IN.pbf -o OUT.pbf makes "
        "them so) (got " +
        std::string(kCompressions[field.number - 4]) + ")");
  });
  if (!has_data) FailDamaged();
  if (zlib.empty()) return data;
  if (raw_size > kMostBytes) FailDamaged();
  data.resize(raw_size);
  std::size_t num = 0;
  if (CPLZLibInflate(zlib.data(), zlib.size(), data.data(), data.size(), &num) == nullptr ||
      num != raw_size) {
    FailDamaged();
  }
  return data;
}

/// What a file needs of its reader, by its header.
void CheckFeatures(std::string_view header) {
  constexpr auto kKnown =
      std::to_array<std::string_view>({"OsmSchema-V0.6", "DenseNodes", "LocationsOnWays"});
  VisitFields(header, [&](const PbfField& field) {
    if (field.number != 4 || std::ranges::find(kKnown, field.bytes) != kKnown.end()) return;
    throw InputError(
        "must need no features but OsmSchema-V0.6, DenseNodes and LocationsOnWays (got " +
        Quoted(field.bytes) + ")");
  });
}

/// The type of blocks that hold elements.
constexpr std::string_view kElements = "OSMData";

/// Visits the blocks behind the header, with their types.
void VisitBlocks(
    const std::filesystem::path& file,
    const std::function<void(const std::string& type, const std::string& blob)>& visit) {
  constexpr std::size_t kMostHeader = 64 << 10;  // By the format, as kMostBlob.
  constexpr std::size_t kMostBlob = 32 << 20;
  std::ifstream stream = OpenInput(file);
  const auto read = [&](std::size_t num) {
    std::string bytes(num, '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(num));
    if (static_cast<std::size_t>(stream.gcount()) < num) FailDamaged();
    return bytes;
  };
  while (stream.peek() != std::ifstream::traits_type::eof()) {
    std::size_t header_size = 0;
    for (const char byte : read(4))
      header_size = header_size << 8U | static_cast<unsigned char>(byte);
    if (header_size > kMostHeader) FailDamaged();
    const std::string header = read(header_size);
    std::string type;
    std::uint64_t blob_size = 0;
    VisitFields(header, [&](const PbfField& field) {
      if (field.number == 1) type = field.bytes;
      if (field.number == 3) blob_size = field.value;
    });
    if (blob_size > kMostBlob) FailDamaged();
    const std::string blob = read(blob_size);
    if (type == "OSMHeader") {
      CheckFeatures(DataOfBlob(blob));
    } else {
      visit(type, blob);
    }
  }
}

}  // namespace

bool IsOsmPbf(std::string_view begin) {
  constexpr std::string_view kType = "\x0A\x09OSMHeader";
  return begin.size() > 4 && begin.substr(4).starts_with(kType);
}

RailMap ReadOsmPbf(const std::filesystem::path& file) {
  return AtPlace(ShownPath(file) + ": ", [&] {
    OsmPbfReader reader;
    std::map<std::string, std::uint64_t> unread;  // Numbers of blocks, by their type.
    VisitBlocks(file, [&](const std::string& type, const std::string& blob) {
      if (type == kElements) {
        reader.ReadWays(DataOfBlob(blob));
      } else {
        ++unread[type];
      }
    });
    VisitBlocks(file, [&](const std::string& type, const std::string& blob) {
      if (type == kElements) reader.ReadNodes(DataOfBlob(blob));
    });
    for (const auto& [type, number] : unread) {
      reader.maker().Tell(RemarkKind::kExtensionUnread, "", number, "block " + Quoted(type));
    }
    return reader.maker().Make();
  });
}

}  // namespace railcast
