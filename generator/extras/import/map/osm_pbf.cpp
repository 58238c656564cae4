// The encoding of https://wiki.openstreetmap.org/wiki/PBF_Format: libosmium decompresses blobs, and
// protozero takes messages apart. libosmium's elements do not serve: they have places to 1e-7
// degrees, those beyond 214 degrees elsewhere, and repeat texts, by which 3 kB become 4 GB.
#define OSMIUM_WITH_LZ4
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <osmium/io/detail/pbf_decoder.hpp>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "generator/extras/import/map/map_formats.h"
#include "generator/extras/import/map/osm_map.h"

namespace railcast {
namespace {

using osmium::io_error;
using protozero::data_view;

struct PbfField {
  std::uint32_t number{};
  std::uint64_t value{};   ///< Value of a number.
  data_view bytes{"", 0};  ///< A message's, a text's, or packed numbers.
};

/// Visits the fields of a message.
template <class Visit>
void VisitFields(data_view message, const Visit& visit) {
  for (protozero::pbf_reader reader(message); reader.next();) {
    PbfField field{.number = reader.tag()};
    if (reader.wire_type() == protozero::pbf_wire_type::varint) {
      field.value = reader.get_uint64();
    } else if (reader.wire_type() == protozero::pbf_wire_type::length_delimited) {
      field.bytes = reader.get_view();
    } else {
      reader.skip();
    }
    visit(field);
  }
}

std::vector<std::uint64_t> Numbers(data_view packed) {
  std::vector<std::uint64_t> numbers;
  const char* at = packed.data();
  const char* end = at + packed.size();
  while (at != end) numbers.push_back(protozero::decode_varint(&at, end));
  return numbers;
}

/// Numbers of which each is given by its difference from the one before.
std::vector<std::int64_t> Sums(data_view packed) {
  std::vector<std::int64_t> sums;
  std::uint64_t sum = 0;  // Damaged ones may run over.
  for (const std::uint64_t number : Numbers(packed)) {
    sum += static_cast<std::uint64_t>(protozero::decode_zigzag64(number));
    sums.push_back(static_cast<std::int64_t>(sum));
  }
  return sums;
}

/// What is common to the elements of a block.
struct PbfBlock {
  std::vector<data_view> texts;
  std::int64_t granularity_ndeg = 100;
  std::int64_t longitude_ndeg = 0;  ///< Longitude of the origin.
  std::int64_t latitude_ndeg = 0;

  void AddTag(std::uint64_t key, std::uint64_t value, MapTags& tags) const {
    if (key >= texts.size() || value >= texts.size()) throw io_error("no such text");
    tags.emplace(texts[key], texts[value]);
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

/// A node, a way or a relation.
struct PbfElement {
  std::int64_t id{};
  MapTags tags;
  bool is_deleted = false;
  std::vector<std::int64_t> nodes;
  std::vector<std::int64_t> longitudes;  ///< A node's, or those of a way's nodes.
  std::vector<std::int64_t> latitudes;
};

/// The fields of a group.
constexpr std::uint32_t kNode = 1;
constexpr std::uint32_t kDenseNodes = 2;
constexpr std::uint32_t kWay = 3;
constexpr std::uint32_t kRelation = 4;

PbfElement ElementOf(const PbfBlock& block, data_view message, std::uint32_t kind) {
  PbfElement element;
  std::vector<std::uint64_t> keys;
  std::vector<std::uint64_t> values;
  VisitFields(message, [&](const PbfField& field) {
    const std::int64_t number = protozero::decode_zigzag64(field.value);
    if (field.number == 1) {
      element.id = kind == kNode ? number : static_cast<std::int64_t>(field.value);
    } else if (field.number == 2) {
      keys = Numbers(field.bytes);
    } else if (field.number == 3) {
      values = Numbers(field.bytes);
    } else if (field.number == 4) {
      VisitFields(field.bytes, [&](const PbfField& info) {
        if (info.number == 6) element.is_deleted = info.value == 0;
      });
    } else if (kind == kNode && field.number == 8) {
      element.latitudes = {number};
    } else if (kind == kNode && field.number == 9) {
      element.longitudes = {number};
    } else if (kind == kWay && field.number == 8) {
      element.nodes = Sums(field.bytes);
    } else if (kind == kWay && field.number == 9) {
      element.latitudes = Sums(field.bytes);
    } else if (kind == kWay && field.number == 10) {
      element.longitudes = Sums(field.bytes);
    }
  });
  if (keys.size() != values.size()) throw io_error("keys without values");
  if (element.latitudes.size() != element.longitudes.size()) throw io_error("half a place");
  for (std::size_t i = 0; i < keys.size(); ++i) block.AddTag(keys[i], values[i], element.tags);
  return element;
}

OsmWay WayOf(const PbfBlock& block, PbfElement& element) {
  OsmWay way{element.id, std::move(element.nodes), {}, std::move(element.tags)};
  if (element.latitudes.size() != way.nodes.size()) return way;
  for (std::size_t i = 0; i < way.nodes.size(); ++i) {
    way.drawn_deg.emplace_back(block.Place_deg(element.longitudes[i], element.latitudes[i]));
  }
  return way;
}

void RefuseFault(const char* kind, std::int64_t id, const std::optional<Fault>& fault) {
  if (!fault) return;
  throw InputError(
      {Fault{std::string(kind) + " " + std::to_string(id), fault->rule, fault->value}});
}

/// Visits the fields of a block's groups of elements.
template <class Visit>
void VisitGroups(data_view data, const Visit& visit) {
  PbfBlock block;
  std::vector<data_view> groups;
  VisitFields(data, [&](const PbfField& field) {
    const auto number = static_cast<std::int64_t>(field.value);
    if (field.number == 1) {
      VisitFields(field.bytes, [&](const PbfField& text) { block.texts.push_back(text.bytes); });
    } else if (field.number == 2) {
      groups.push_back(field.bytes);
    } else if (field.number == 17) {
      block.granularity_ndeg = number;
    } else if (field.number == 19) {
      block.latitude_ndeg = number;
    } else if (field.number == 20) {
      block.longitude_ndeg = number;
    }
  });
  for (const data_view group : groups) {
    VisitFields(group, [&](const PbfField& field) { visit(block, field); });
  }
}

/// Reads a file's ways first, then the nodes that they need: most of a map are others.
class OsmPbfReader {
 public:
  void ReadWays(data_view data) {
    VisitGroups(data, [&](const PbfBlock& block, const PbfField& field) {
      if (field.number != kWay && field.number != kRelation) return;
      const bool is_way = field.number == kWay;
      PbfElement element = ElementOf(block, field.bytes, field.number);
      if (element.is_deleted) {
        const char* kind = is_way ? "way" : "relation";
        RefuseFault(kind, element.id, maker_.AddDeleted(kind, element.id, element.tags));
      } else if (is_way) {
        RefuseFault("way", element.id, maker_.AddWay(WayOf(block, element)));
      } else {
        maker_.AddRelation(element.id, element.tags);
      }
    });
  }

  void ReadNodes(data_view data) {
    VisitGroups(data, [&](const PbfBlock& block, const PbfField& field) {
      if (field.number == kDenseNodes) ReadDense(block, field.bytes);
      if (field.number != kNode) return;
      PbfElement node = ElementOf(block, field.bytes, kNode);
      if (node.is_deleted) {
        RefuseFault("node", node.id, maker_.AddDeleted("node", node.id, node.tags));
      } else if (node.latitudes.empty()) {
        throw io_error("a node without place");
      } else {
        AddNode(node.id, block.Place_deg(node.longitudes[0], node.latitudes[0]),
                std::move(node.tags));
      }
    });
  }

  [[nodiscard]] OsmMapMaker& maker() { return maker_; }

 private:
  void AddNode(std::int64_t id, const Eigen::Vector2d& place_deg, MapTags tags) {
    if (!maker_.Needs(id) && !IsThing(tags)) return;
    RefuseFault("node", id, maker_.AddNode(id, place_deg, std::move(tags)));
  }

  void ReadDense(const PbfBlock& block, data_view message) {
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
    if (latitudes.size() != ids.size() || longitudes.size() != ids.size()) {
      throw io_error("nodes without places");
    }
    std::size_t word = 0;  // Keys and values in turn; 0 ends those of a node.
    for (std::size_t i = 0; i < ids.size(); ++i) {
      MapTags tags;
      for (; word < words.size() && words[word] != 0; word += 2) {
        if (word + 1 == words.size()) throw io_error("a key without a value");
        block.AddTag(words[word], words[word + 1], tags);
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

/// What a file needs of its reader, by its header.
void CheckFeatures(data_view header) {
  constexpr auto kKnown =
      std::to_array<std::string_view>({"OsmSchema-V0.6", "DenseNodes", "LocationsOnWays"});
  VisitFields(header, [&](const PbfField& field) {
    const std::string feature(field.bytes);
    if (field.number != 4 || std::ranges::find(kKnown, feature) != kKnown.end()) return;
    throw InputError(
        "must need no features but OsmSchema-V0.6, DenseNodes and LocationsOnWays (got " +
        Quoted(feature) + ")");
  });
}

/// The type of blocks that hold elements.
constexpr std::string_view kElements = "OSMData";

/// Takes a block's type, and its data if these are elements.
using TakeBlock = std::function<void(const std::string& type, data_view data)>;

void ReadBlock(std::istream& stream, const TakeBlock& take) {
  const auto read = [&](std::uint64_t num, std::uint64_t most) {
    if (num > most) throw io_error("larger than the format allows");
    std::string bytes(num, '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(num));
    if (!stream) throw io_error("the file ends");
    return bytes;
  };
  std::uint64_t header_size = 0;
  for (const char byte : read(4, 4))
    header_size = header_size << 8U | static_cast<unsigned char>(byte);
  const std::string header = read(header_size, osmium::io::detail::max_blob_header_size);
  std::string type;
  std::uint64_t blob_size = 0;
  VisitFields(header, [&](const PbfField& field) {
    if (field.number == 1) type = std::string(field.bytes);
    if (field.number == 3) blob_size = field.value;
  });
  const std::string blob = read(blob_size, osmium::io::detail::max_uncompressed_blob_size);
  std::string room;
  if (type == "OSMHeader") {
    CheckFeatures(osmium::io::detail::decode_blob(blob, room));
  } else if (type == kElements) {
    take(type, osmium::io::detail::decode_blob(blob, room));
  } else {
    take(type, {});
  }
}

/// Takes the blocks behind the header.
void TakeBlocks(const std::filesystem::path& file, const TakeBlock& take) {
  const std::unique_ptr<std::istream> stream = OpenMap(file);
  for (int block = 1; stream->peek() != std::istream::traits_type::eof(); ++block) {
    const auto refuse = [&](const char* rule, const std::exception& error) {
      throw InputError({Fault{"", rule, ShownText(error.what())}});
    };
    AtPlace("block " + std::to_string(block) + ": ", [&] {
      try {
        ReadBlock(*stream, take);
      } catch (const osmium::pbf_error& error) {
        refuse("must be zlib, lz4 or plain (osmium cat IN.pbf -o OUT.pbf makes it so)", error);
      } catch (const osmium::io_error& error) {
        refuse("must be whole", error);
      } catch (const protozero::exception& error) {
        refuse("must be whole", error);
      }
    });
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
    TakeBlocks(file, [&](const std::string& type, data_view data) {
      if (type == kElements) {
        reader.ReadWays(data);
      } else {
        ++unread[type];
      }
    });
    TakeBlocks(file, [&](const std::string& type, data_view data) {
      if (type == kElements) reader.ReadNodes(data);
    });
    for (const auto& [type, number] : unread) {
      reader.maker().Tell(RemarkKind::kExtensionUnread, "", number, "block " + Quoted(type));
    }
    return reader.maker().Make();
  });
}

}  // namespace railcast
