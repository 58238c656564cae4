#include "core/io/cloud/text_cloud.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/base/text_number.h"
#include "core/io/cloud/cloud_file.h"

namespace railcast {
namespace {

constexpr auto kFrameEndings = std::to_array<std::string_view>({".xyz", ".pts", ".asc", ".pc"});
constexpr auto kTableEndings = std::to_array<std::string_view>({".txt", ".csv"});

using WordList = std::vector<std::string_view>;

bool EndsInOne(const std::filesystem::path& file, const auto& endings) {
  return std::ranges::count(endings, LowerCase(file.extension().string())) > 0;
}

/// A word without the blanks around it, and without quotes.
std::string_view Bare(std::string_view word) {
  const std::size_t begin = word.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  word = word.substr(begin, word.find_last_not_of(" \t") - begin + 1);
  const bool is_quoted = word.size() > 1 && word.front() == '"' && word.back() == '"';
  return is_quoted ? word.substr(1, word.size() - 2) : word;
}

/// What stands between the words of a line; a blank stands for any number of them and of tabs.
char SeparatorOf(std::string_view line) {
  for (const char separator : {';', ','}) {
    if (line.find(separator) != std::string_view::npos) return separator;
  }
  return ' ';
}

void SplitInto(std::string_view line, char separator, WordList& words) {
  words.clear();
  if (separator != ' ') {
    for (std::size_t end = 0; end != std::string_view::npos; line.remove_prefix(end + 1)) {
      end = line.find(separator);
      words.push_back(Bare(line.substr(0, end)));
      if (end == std::string_view::npos) return;
    }
  }
  const auto is_blank = [](char letter) { return letter == ' ' || letter == '\t'; };
  for (auto place = line.begin(); place != line.end();) {
    const auto begin = std::find_if_not(place, line.end(), is_blank);
    place = std::find_if(begin, line.end(), is_blank);
    if (begin != place) words.push_back(Bare({begin, place}));
  }
}

bool IsAbsent(std::string_view word) {
  return word.empty() || word == "-";
}

bool IsNumber(std::string_view word) {
  return ParseTextNumber<double>(word).has_value();
}

/// Whether a word is a number with a comma between its digits.
bool HasDecimalComma(std::string_view word) {
  const std::size_t comma = word.find(',');
  return comma != std::string_view::npos && comma > 0 && comma + 1 < word.size() &&
         IsDigit(word[comma - 1]) && IsDigit(word[comma + 1]) &&
         word.find(',', comma + 1) == std::string_view::npos;
}

/// Whether the numbers of a line have decimal commas, between semicolons or blanks.
bool HasDecimalCommas(std::string_view line, const WordList& words) {
  if (std::ranges::any_of(words, HasDecimalComma)) return true;
  const WordList parts = Words(line);
  return parts.size() > 2 && std::ranges::any_of(parts, HasDecimalComma) &&
         std::ranges::none_of(parts, [](auto part) { return part.ends_with(','); });
}

/// A column as a header names it.
struct NamedColumn {
  std::string name;  ///< In lower case, without blanks.
  std::string_view unit;
};

bool HasName(const std::vector<NamedColumn>& columns, std::string_view name) {
  return std::ranges::count(columns, name, &NamedColumn::name) == 1;
}

bool HavePosition(const std::vector<NamedColumn>& columns) {
  return HasName(columns, "x") && HasName(columns, "y") && HasName(columns, "z");
}

/// The columns that a line names: "x y z", "X [m];Y [m];Z [m]", "//X Y Z R G B".
std::vector<NamedColumn> ColumnsNamedIn(std::string_view line) {
  line.remove_prefix(std::min(line.find_first_not_of("#/ \t"), line.size()));
  WordList words;
  SplitInto(line, SeparatorOf(line), words);
  // A separator at the end of the line begins no column.
  if (!words.empty() && words.back().empty()) words.pop_back();
  std::vector<NamedColumn> columns;
  for (const std::string_view word : words) {
    const std::size_t bracket = std::min(word.find_first_of("[("), word.size());
    const std::string_view unit = word.substr(bracket, word.find_last_of("])") - bracket);
    std::string name = LowerCase(Bare(word.substr(0, bracket)));
    std::ranges::replace(name, ' ', '_');
    const bool is_unit = bracket == 0 && !word.empty() && !columns.empty();
    if (name.empty()) name = kPaddingField;
    if (!is_unit) columns.push_back({.name = std::move(name), .unit = {}});
    if (!unit.empty()) columns.back().unit = Bare(unit.substr(1));
  }
  if (!HasName(columns, "r") || !HasName(columns, "g") || !HasName(columns, "b")) return columns;
  for (NamedColumn& column : columns) {
    if (column.name == "r") column.name = "red";
    if (column.name == "g") column.name = "green";
    if (column.name == "b") column.name = "blue";
  }
  return columns;
}

class TextCloudReader {
 public:
  TextCloudReader(const std::string& file, std::string_view text, const std::string& chosen)
      : file_(file), rest_(text), has_chosen_(!chosen.empty()), columns_(ColumnsNamedIn(chosen)) {}

  Cloud Read() {
    ReadHead();
    Cloud cloud{
        .height = 1, .width = 0, .fields = {}, .point_step = 0, .is_dense = false, .data = {}};
    for (const NamedColumn& column : columns_) {
      const bool is_time = column.name == "t" || column.name.find("time") != std::string::npos;
      cloud.AddField(column.name, is_time ? NumberType::kDouble : NumberType::kFloat);
    }
    AddRemark({.kind = RemarkKind::kFieldsLeftOut,
               .place = file_,
               .number = std::max(num_columns_, columns_.size()) - columns_.size(),
               .detail = "columns without names; --columns x,y,z,... names them"},
              cloud.remarks);
    ReadPoints(cloud);
    if (cloud.WidenRounded()) ReadPoints(cloud);
    return cloud;
  }

 private:
  [[noreturn]] void Fail(const std::string& rule) const {
    throw InputError(file_ + ": line " + NumberText(num_lines_) + ": " + rule);
  }

  /// The next line that is neither empty nor a comment.
  std::optional<std::string_view> NextLine() {
    line_begin_ = rest_;
    while (auto line = TakeLine(rest_)) {
      ++num_lines_;
      const std::size_t begin = line->find_first_not_of(" \t");
      line->remove_prefix(std::min(begin, line->size()));
      if (!line->empty() && !line->starts_with('#') && !line->starts_with("//")) return line;
      if (!line->empty()) TakeComment(*line);
      line_begin_ = rest_;
    }
    return std::nullopt;
  }

  /// The whole number that is alone in a line, although spreadsheets put separators behind it.
  [[nodiscard]] std::optional<std::uint64_t> NumberAlone() const {
    const std::string_view word = words_.front();
    const bool is_alone = std::ranges::count(words_, "") + 1 == std::ssize(words_);
    return is_alone ? ParseTextNumber<std::uint64_t>(word) : std::nullopt;
  }

  void TakeComment(std::string_view line) {
    CheckUnitComment(file_, line);
    std::vector<NamedColumn> columns = ColumnsNamedIn(line);
    if (!HavePosition(columns)) return;
    if (num_columns_ > 0 && columns.size() == num_columns_) {
      Fail("names columns behind points; a file must hold one cloud");
    }
    comment_ = std::move(columns);
  }

  void UseColumns(std::vector<NamedColumn> columns) {
    constexpr auto kMetres =
        std::to_array<std::string_view>({"", "m", "metre", "metres", "meter", "meters"});
    for (const auto& [name, unit] : columns) {
      if (name != "x" && name != "y" && name != "z") continue;
      if (std::ranges::count(kMetres, LowerCase(unit)) > 0) continue;
      throw InputError(file_ + ": positions must be in metres, but the unit of " + name + " is " +
                       Quoted(unit));
    }
    if (!has_chosen_) columns_ = std::move(columns);
  }

  /// Reads what stands before the points; `rest_` then begins with the line of the first.
  void ReadHead() {
    bool has_header = false;
    while (const auto line = NextLine()) {
      SplitInto(*line, SeparatorOf(*line), words_);
      if (HasDecimalCommas(*line, words_)) {
        Fail("numbers must have decimal points, not commas (got " + ShownText(*line) + ")");
      }
      if (const auto number = NumberAlone(); number && !num_points_) {
        num_points_ = number;
      } else if (!has_header && std::ranges::none_of(words_, IsNumber) &&
                 !std::ranges::all_of(words_, IsAbsent)) {
        has_header = true;
        TakeHeader(*line);
      } else {
        TakeFirst(*line);
        rest_ = line_begin_;
        --num_lines_;
        break;
      }
    }
    if (num_columns_ == 0 && !num_points_ && !has_header) {
      throw InputError(file_ + ": must have lines of numbers");
    }
    if (columns_.empty()) columns_ = {{"x", {}}, {"y", {}}, {"z", {}}};
  }

  /// Takes a line without numbers.
  void TakeHeader(std::string_view line) {
    std::vector<NamedColumn> columns = ColumnsNamedIn(line);
    if (!has_chosen_ && !HavePosition(columns)) {
      Fail(
          "must be numbers, or names of columns with x, y and z once each; --columns x,y,z,... "
          "names them (got " +
          ShownText(line) + ")");
    }
    UseColumns(std::move(columns));
  }

  /// Learns from the line of the first point how lines are written.
  void TakeFirst(std::string_view line) {
    separator_ = SeparatorOf(line);
    if (words_.back().empty() && words_.size() != columns_.size()) words_.pop_back();
    num_columns_ = words_.size();
    if (num_columns_ < 3) Fail("must have at least 3 numbers" + Got(num_columns_));
    if (columns_.empty() || has_chosen_) {
      if (comment_.size() == num_columns_) UseColumns(comment_);
    }
    if (columns_.empty() || columns_.size() == num_columns_) return;
    Fail("must have " + NumberText(columns_.size()) + " numbers, as many as columns are named" +
         Got(num_columns_));
  }

  void ReadPoints(Cloud& cloud) {
    constexpr std::size_t kMostBytes = std::numeric_limits<std::uint32_t>::max();
    const std::string_view points = rest_;
    const std::size_t num_before = num_lines_;
    const std::string file_line = file_ + ": line ";
    std::string place = file_line;
    cloud.width = 0;
    while (const auto line = NextLine()) {
      SplitInto(*line, separator_, words_);
      if (words_.size() != num_columns_) TakeOtherSize(*line);
      words_.resize(columns_.size());
      for (std::string_view& word : words_) {
        if (IsAbsent(word)) word = "nan";
      }
      place.replace(file_line.size(), std::string::npos, NumberText(num_lines_));
      (void)cloud.AppendWords(place, words_);
      ++cloud.width;
      // Maps are far from the first point on, and then need not be read twice.
      if (cloud.width == 1 && cloud.WidenRounded()) (void)cloud.AppendWords(place, words_);
      if (cloud.data.size() > kMostBytes) Fail("points must be less than 4 GiB");
    }
    rest_ = points;
    num_lines_ = num_before;
    if (!num_points_ || num_points_ == cloud.width) return;
    throw InputError(file_ + ": must have as many lines of points as it states, " +
                     NumberText(*num_points_) + Got(cloud.width));
  }

  /// Takes an empty word off the end of a line, or throws.
  void TakeOtherSize(std::string_view line) {
    if (words_.size() == num_columns_ + 1 && words_.back().empty()) return words_.pop_back();
    if (num_points_ && NumberAlone()) {
      Fail("begins another cloud; a file must hold one (got " + ShownText(line) + ")");
    }
    Fail("must have " + NumberText(num_columns_) + " numbers, as the first point has" +
         Got(words_.size()));
  }

  const std::string& file_;
  std::string_view rest_;
  std::string_view line_begin_;  ///< What is left of the text from the last line on.
  std::size_t num_lines_{};
  bool has_chosen_{};
  std::vector<NamedColumn> columns_;
  std::vector<NamedColumn> comment_;         ///< What the last comment names.
  std::optional<std::uint64_t> num_points_;  ///< As stated.
  std::size_t num_columns_{};                ///< In a line; 0 = not known yet.
  char separator_{};
  WordList words_;  ///< What stands in a line.
};

}  // namespace

std::vector<std::string> TextCloudEndings(bool with_tables) {
  std::vector<std::string> endings(kFrameEndings.begin(), kFrameEndings.end());
  if (with_tables) endings.insert(endings.end(), kTableEndings.begin(), kTableEndings.end());
  return endings;
}

bool IsTextTable(const std::filesystem::path& file) {
  return EndsInOne(file, kTableEndings);
}

bool IsTextCloud(const std::filesystem::path& file) {
  return EndsInOne(file, kFrameEndings) || IsTextTable(file);
}

bool IsTextColumns(std::string_view choice) {
  if (choice.find(',') == std::string_view::npos) return false;
  WordList words;
  SplitInto(choice, ',', words);
  const auto is_letter = [](char letter) {
    return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_' || letter == '.';
  };
  const bool are_names = std::ranges::all_of(words, [&](std::string_view word) {
    return !word.empty() && std::ranges::all_of(word, is_letter) &&
           (word == kPaddingField || std::ranges::count(words, word) == 1);
  });
  return are_names && HavePosition(ColumnsNamedIn(choice));
}

Cloud ParseTextCloud(const std::string& file, std::string bytes, const std::string& columns) {
  if (!columns.empty() && !IsTextColumns(columns)) {
    throw InputError(file + ": columns must be names, as in x,y,z,intensity (got " +
                     ShownText(columns) + ")");
  }
  const std::string text = AsUtf8(std::move(bytes));
  return TextCloudReader(file, text, columns).Read();
}

Cloud ReadTextCloud(const std::filesystem::path& file, const std::string& columns) {
  return ParseTextCloud(ShownPath(file), ReadFileWhole(file), columns);
}

}  // namespace railcast
