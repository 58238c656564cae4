#include "analysis/report/html_text.h"

#include <cstdlib>

#include "analysis/report/joined.h"

namespace railcast {
namespace {

bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}

}  // namespace

std::string EscapedHtml(const std::string& text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

std::string Element(const std::string& tag, const std::string& text) {
  return Joined({"<", tag, ">", EscapedHtml(text), "</", tag.substr(0, tag.find(' ')), ">"});
}

std::string NumberHtml(const std::string& numbers) {
  std::string html;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] == '-') {
      html += "−";
    } else if (numbers[i] == 'e' && i > 0 && IsDigit(numbers[i - 1])) {
      std::size_t length = 0;
      const int power = std::stoi(numbers.substr(i + 1), &length);
      html += Joined({"\u202f×\u202f10<sup>", power < 0 ? "−" : "", std::to_string(std::abs(power)),
                      "</sup>"});
      i += length;
    } else {
      html += EscapedHtml(std::string(1, numbers[i]));
    }
  }
  return html;
}

std::string UnitHtml(const std::string& unit) {
  if (unit.empty()) return {};
  return Joined({" <span class=\"unit\">", EscapedHtml(unit), "</span>"});
}

}  // namespace railcast
