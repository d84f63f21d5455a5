#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/bed_file.hpp"
#include "core/error.hpp"

namespace layerloop {

/// A text file line by line, for the readers of beds.
class BedText {
 public:
  BedText(std::filesystem::path path, std::string text) : path_(std::move(path)), text_(std::move(text)) {}

  /// The next line without its end; nothing at the end of the file.
  std::optional<std::string_view> next();
  /// The next line. \throws InputError the file ends before `what`
  std::string_view require(std::string_view what);
  std::int64_t line() const { return line_; }  ///< of what next() gave last, from 1

  /// \throws InputError "file:line: ..." with this text
  template <class... Values>
  [[noreturn]] void refuse(fmt::format_string<Values...> text, Values&&... values) const {
    throw InputError(
        fmt::format("{}:{}: {}", path_.string(), line_, fmt::format(text, std::forward<Values>(values)...)));
  }

  double number(std::string_view word, std::string_view what) const;  ///< finite \throws InputError
  std::int64_t whole_number(std::string_view word, std::string_view what) const;

 private:
  std::filesystem::path path_;
  std::string text_;
  std::size_t at_ = 0;
  std::int64_t line_ = 0;
};

/// Words between blanks or, with a separator, the trimmed pieces between separators.
std::vector<std::string_view> words_of(std::string_view line, char separator = ' ');

/// Value of key=value or key="value with blanks" in a line; nothing without it.
std::optional<std::string_view> value_of(std::string_view line, std::string_view key);

/// One grain as a file gives it.
struct GrainRow {
  std::int64_t id = 0;
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero(), spin = Vec3::Zero();
  double radius = 0;
  std::int32_t material = 0;
  std::int64_t line = 0;
};

/// Checks a row of the current line: a radius from 10 nm to 5 mm. \throws InputError
void check_row(BedText const& text, GrainRow const& row);

/// The rows by ascending id. \throws InputError an id twice
PowderBed bed_of(BedText const& text, std::vector<GrainRow> rows);

BedFile read_bed_csv(BedText text);
BedFile read_bed_dump(BedText text, std::optional<std::int64_t> frame);
BedFile read_bed_extxyz(BedText text, std::optional<std::int64_t> frame);
std::string bed_as_csv(BedFile const& file);
std::string bed_as_dump(BedFile const& file);
std::string bed_as_extxyz(BedFile const& file);

/// Box of a bed for formats that need one: periods from 0, elsewhere around the grains.
struct BedBox {
  Vec3 low, high;
};
BedBox box_of(BedFile const& file);

}  // namespace layerloop
