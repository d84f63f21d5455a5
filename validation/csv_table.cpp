#include "validation/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace layerloop::validation {
namespace {

/// "um" with a micro sign (U+00B5, the Greek letter U+03BC, or Latin-1) becomes plain.
std::string with_plain_micro(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string_view const two = text.substr(i, 2);
    bool const pair = two == "\xC2\xB5" || two == "\xCE\xBC";
    bool const lone = text[i] == '\xB5' && (i == 0 || static_cast<unsigned char>(text[i - 1]) < 0x80);
    plain += pair || lone ? 'u' : text[i];
    if (pair) ++i;
  }
  return plain;
}

std::string_view trimmed(std::string_view text) {
  std::size_t const from = text.find_first_not_of(" \t\r");
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(" \t\r") - from + 1);
}

class Reader {
 public:
  Reader(std::string_view text, std::vector<Fault>& faults) : text_(text), faults_(faults) {}

  CsvTable read() {
    CsvTable table;
    while (at_ < text_.size()) {
      std::string_view const line = trimmed(text_.substr(at_, text_.find('\n', at_) - at_));
      if (line.empty() || line.front() == '#') {
        skip_line();
        continue;
      }
      std::vector<CsvField> row = read_row();
      if (table.header.empty()) {
        table.header = std::move(row);
        if (has_other_separators(table.header)) return {};
      } else if (row.size() == table.header.size()) {
        table.rows.push_back(std::move(row));
      } else {
        faults_.push_back({row.front().place,
                           fmt::format("{} fields (the header has {}) a blank field still needs its comma; a comma "
                                       "inside a field needs quotation marks around it; decimals take a point",
                                       row.size(), table.header.size())});
      }
    }
    if (table.header.empty()) faults_.push_back({{}, "the file is empty (its first line names the columns)"});
    return table;
  }

 private:
  void skip_line() {
    at_ = std::min(text_.find('\n', at_), text_.size() - 1) + 1;
    ++line_, line_begin_ = at_;
  }

  Place here() const { return {line_, static_cast<std::uint32_t>(at_ - line_begin_ + 1), {}}; }

  std::vector<CsvField> read_row() {
    std::vector<CsvField> row;
    while (true) {
      while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
      row.push_back(at_ < text_.size() && text_[at_] == '"' ? quoted() : plain());
      if (at_ < text_.size() && text_[at_] == ',') {
        ++at_;
        continue;
      }
      if (at_ < text_.size()) skip_line();
      return row;
    }
  }

  CsvField plain() {
    Place const place = here();
    std::size_t const end = std::min(text_.find_first_of(",\n", at_), text_.size());
    CsvField field{with_plain_micro(trimmed(text_.substr(at_, end - at_))), place};
    at_ = end;
    return field;
  }

  CsvField quoted() {
    Place const place = here();
    std::string inside;
    for (++at_; at_ < text_.size(); ++at_) {
      if (text_[at_] == '"' && text_.substr(at_ + 1, 1) != "\"") break;
      if (text_[at_] == '"') ++at_;  // two stand for one
      inside += text_[at_];
      if (text_[at_] == '\n') ++line_, line_begin_ = at_ + 1;
    }
    if (at_ == text_.size()) {
      faults_.push_back({place, "quotation marks that are never closed"});
    } else {
      ++at_;
    }
    std::size_t const end = std::min(text_.find_first_of(",\n", at_), text_.size());
    if (!trimmed(text_.substr(at_, end - at_)).empty())
      faults_.push_back({here(), "text after the closing quotation mark (a mark inside is written twice)"});
    at_ = end;
    return {with_plain_micro(trimmed(inside)), place};
  }

  bool has_other_separators(std::vector<CsvField> const& header) {
    if (header.size() > 1) return false;
    std::size_t const mark = header.front().text.find_first_of(";\t");
    if (mark == std::string::npos) return false;
    faults_.push_back({header.front().place, fmt::format("fields apart by {} (must be commas)",
                                                         header.front().text[mark] == ';' ? "semicolons" : "tabs")});
    return true;
  }

  std::string_view text_;
  std::vector<Fault>& faults_;
  std::size_t at_ = 0, line_begin_ = 0;
  std::uint32_t line_ = 1;
};

}  // namespace

CsvTable parse_csv(std::string_view text, std::vector<Fault>& faults) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return Reader(text, faults).read();
}

}  // namespace layerloop::validation
