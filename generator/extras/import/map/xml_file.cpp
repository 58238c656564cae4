#include "generator/extras/import/map/xml_file.h"

#include <expat.h>
#include <iconv.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <sstream>
#include <type_traits>

#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "generator/extras/import/map/map_formats.h"

namespace railcast {
namespace {

using XmlParser = std::unique_ptr<std::remove_pointer_t<XML_Parser>, decltype(&XML_ParserFree)>;

std::string_view LocalName(std::string_view name) {
  return name.substr(name.find(':') + 1);
}

/// Fills in the letters of an encoding; returns whether each is one byte, and the first are ASCII.
bool TakeLetters(const char* name, XML_Encoding& encoding) {
  const iconv_t letters = iconv_open("UTF-32LE", name);
  if (letters == iconv_t(-1)) return false;  // NOLINT(performance-no-int-to-ptr): as POSIX has it.
  bool is_taken = true;
  for (int byte = 0; byte < 256; ++byte) {
    std::array<char, 1> in = {static_cast<char>(byte)};
    std::array<unsigned char, 4> out{};
    char* from = in.data();
    char* to = reinterpret_cast<char*>(out.data());
    std::size_t num_in = in.size();
    std::size_t num_out = out.size();
    const bool is_letter = iconv(letters, &from, &num_in, &to, &num_out) != std::size_t(-1);
    if (!is_letter && errno != EILSEQ) is_taken = false;  // The first byte of several.
    constexpr int kReplacement = 0xFFFD;
    encoding.map[byte] = is_letter ? out[0] | out[1] << 8 | out[2] << 16 : kReplacement;
    if (byte < 0x80 && encoding.map[byte] != byte) is_taken = false;
  }
  iconv_close(letters);
  encoding.data = nullptr;
  encoding.convert = nullptr;
  encoding.release = nullptr;
  return is_taken;
}

/// Hands the elements of a file to the reader of its root element. What that throws waits until the
/// parser, which is in C, has returned.
class XmlVisit {
 public:
  explicit XmlVisit(XML_Parser parser) : parser_(parser) {
    XML_SetUserData(parser, this);
    XML_SetElementHandler(
        parser,
        [](void* data, const char* name, const char** attributes) {
          static_cast<XmlVisit*>(data)->Begin(name, attributes);
        },
        [](void* data, const char* name) { static_cast<XmlVisit*>(data)->End(name); });
    XML_SetCharacterDataHandler(parser, [](void* data, const char* text, int length) {
      static_cast<XmlVisit*>(data)->text_.append(text, static_cast<std::size_t>(length));
    });
    XML_SetUnknownEncodingHandler(
        parser,
        [](void* data, const char* name, XML_Encoding* encoding) -> int {
          const bool is_taken = TakeLetters(name, *encoding);
          if (!is_taken) static_cast<XmlVisit*>(data)->other_encoding_ = name;
          return is_taken ? XML_STATUS_OK : XML_STATUS_ERROR;
        },
        this);
  }

  /// Parses a part of the file; returns whether to go on.
  bool Parse(const std::string& part, bool is_last) {
    const auto status = XML_Parse(parser_, part.data(), static_cast<int>(part.size()), is_last);
    if (thrown_) std::rethrow_exception(thrown_);
    if (status != XML_STATUS_ERROR) return true;
    if (!other_encoding_.empty()) {
      throw InputError("encoding: must be UTF-8, UTF-16 or one with a byte for each letter (got " +
                       Quoted(other_encoding_) + ")");
    }
    faults_.list().Add({"line " + std::to_string(line()), "must be XML to its end",
                        XML_ErrorString(XML_GetErrorCode(parser_))});
    return false;
  }
  RailMap Make() {
    faults_.list().ThrowIfAny();
    return reader_->Make();
  }

 private:
  [[nodiscard]] std::uint64_t line() const { return XML_GetCurrentLineNumber(parser_); }

  template <class Work>
  void Try(const Work& work) {
    if (thrown_) return;
    try {
      work();
    } catch (...) {
      thrown_ = std::current_exception();
      XML_StopParser(parser_, XML_FALSE);
    }
  }
  void Begin(const char* name, const char** attributes) {
    Try([&] {
      if (!reader_) Choose(name);
      reader_->Begin({LocalName(name), attributes, line()});
      text_.clear();
    });
  }
  void End(const char* name) {
    Try([&] {
      reader_->End(LocalName(name), text_, line());
      text_.clear();
    });
  }
  void Choose(std::string_view root) {
    if (LocalName(root) == "osm") reader_ = MakeOsmXmlReader(faults_);
    if (LocalName(root) == "gpx") reader_ = MakeGpxReader(faults_);
    if (LocalName(root) == "kml") reader_ = MakeKmlReader(faults_);
    // Version 2 has small letters.
    if (LocalName(root) == "railML" || LocalName(root) == "railml") {
      reader_ = MakeRailMlReader(faults_);
    }
    if (reader_) return;
    throw InputError("must be a map: of OpenStreetMap (<osm>), GPX, KML or railML 3 (got <" +
                     ShownText(root) + ">)");
  }

  XML_Parser parser_;
  XmlFaults faults_;
  std::unique_ptr<XmlMapReader> reader_;
  std::string text_;
  std::string other_encoding_;  ///< An encoding that is not read.
  std::exception_ptr thrown_;
};

}  // namespace

const char* XmlElement::ValueOf(std::string_view attribute) const {
  for (const char* const* at = attributes; *at != nullptr; at += 2) {
    if (attribute == *at) return at[1];
  }
  return nullptr;
}

std::string_view XmlTrimmed(std::string_view text) {
  constexpr std::string_view kXmlBlanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kXmlBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kXmlBlanks) - first + 1);
}

std::optional<double> XmlNumber(std::string_view text) {
  text = XmlTrimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  return NumberIn(text);
}

std::optional<Eigen::Vector2d> XmlPlace_deg(const XmlElement& element, XmlFaults& faults) {
  const auto degrees_of = [&](const char* key, double most_deg) {
    const char* value = element.ValueOf(key);
    const std::optional<double> value_deg = value == nullptr ? std::nullopt : XmlNumber(value);
    if (value_deg && std::abs(*value_deg) <= most_deg) return value_deg;
    faults.Add(element.line, std::string(element.name) + "/" + key, DegreesRule(most_deg),
               value == nullptr ? "none" : Quoted(value));
    return std::optional<double>();
  };
  const auto longitude_deg = degrees_of("lon", kMostLongitude_deg);
  const auto latitude_deg = degrees_of("lat", kMostLatitude_deg);
  if (!longitude_deg || !latitude_deg) return std::nullopt;
  return Eigen::Vector2d(*longitude_deg, *latitude_deg);
}

RailMap ReadXmlMap(const std::filesystem::path& file) {
  constexpr std::size_t kBlock = 1 << 16;
  const std::unique_ptr<std::istream> stream = OpenMap(file);
  std::string block(kBlock, '\0');
  const auto read = [&](std::istream& in) {
    block.resize(kBlock);
    in.read(block.data(), kBlock);
    block.resize(static_cast<std::size_t>(in.gcount()));
    return !in;
  };
  bool is_last = read(*stream);
  // A file that was saved anew in UTF-16 may still say that it is UTF-8.
  const bool is_utf16 = IsUtf16(block);
  std::istringstream text;
  if (is_utf16) {
    text.str(ReadMapText(file));
    is_last = read(text);
  }
  const XmlParser parser(XML_ParserCreate(is_utf16 ? "UTF-8" : nullptr), &XML_ParserFree);
  XmlVisit visit(parser.get());
  return AtPlace(ShownPath(file) + ": ", [&] {
    while (visit.Parse(block, is_last) && !is_last) {
      is_last = is_utf16 ? read(text) : read(*stream);
    }
    return visit.Make();
  });
}

}  // namespace railcast
