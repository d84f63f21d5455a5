#pragma once
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace layerloop::coupling {

/// Rows of numbers under one header line; what is not finite stays blank.
class CsvTable {
 public:
  explicit CsvTable(std::string_view header) : text_(header) { text_ += '\n'; }
  void row(std::initializer_list<double> values) { row(std::span<double const>(values.begin(), values.size())); }
  void row(std::span<double const> values);
  void write(std::filesystem::path const& path) const;  ///< \throws FileError

 private:
  std::string text_;
};

}  // namespace layerloop::coupling
