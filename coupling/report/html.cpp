#include "coupling/report/html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace layerloop::coupling {

std::string escape(std::string_view text) {
  std::string safe;
  for (char const c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string base64(std::string_view bytes) {
  static constexpr char alphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::size_t const left = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t b = 0; b < 3; ++b) group = group << 8 | (b < left ? static_cast<std::uint8_t>(bytes[i + b]) : 0u);
    for (std::size_t c = 0; c < 4; ++c) text += c <= left ? alphabet[group >> (18 - 6 * c) & 63] : '=';
  }
  return text;
}

std::string script_json(nlohmann::json const& value) {
  std::string text = value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) text.replace(at, 1, "\\u003c");
  return text;
}

std::string fill_in(std::string_view text, std::map<std::string, std::string> const& parts) {
  std::string filled;
  for (;;) {
    std::size_t const begin = text.find("{{");
    filled += text.substr(0, begin);
    if (begin == std::string_view::npos) return filled;
    std::size_t const end = text.find("}}", begin);
    filled += parts.at(std::string(text.substr(begin + 2, end - begin - 2)));
    text.remove_prefix(end + 2);
  }
}

std::string significant(double value, int digits) {
  if (!std::isfinite(value)) return "&ndash;";
  if (value == 0) return "0";
  // The exponent after rounding: 9.996 with three digits is 10.0, not 10.00.
  std::string const rounded = fmt::format("{:.{}e}", value, digits - 1);
  int const exponent = std::stoi(rounded.substr(rounded.find('e') + 1));
  if (exponent < -4 || exponent > 6)
    return fmt::format("<span class=\"power\">{} &times; 10<sup>{}</sup></span>", rounded.substr(0, rounded.find('e')),
                       exponent);
  return fmt::format("{}{:.{}f}", value < 0 ? "&minus;" : "", std::abs(value), std::max(0, digits - 1 - exponent));
}

std::string chosen(double value) { return fmt::format("{}{:.6g}", value < 0 ? "&minus;" : "", std::abs(value)); }

std::string count(std::int64_t number) {
  std::string digits = std::to_string(number);
  for (int at = static_cast<int>(digits.size()) - 3; at > (number < 0 ? 1 : 0); at -= 3)
    digits.insert(static_cast<std::size_t>(at), "&#8239;");
  return digits;
}

std::string with_uncertainty(double value, double uncertainty) {
  if (!std::isfinite(uncertainty) || uncertainty <= 0 || !std::isfinite(value)) return significant(value);
  int const decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(uncertainty))), 0, 8);
  return fmt::format("{:.{}f} <span class=\"plus-minus\">&plusmn; {:.{}f}</span>", value, decimals, uncertainty,
                     decimals);
}

std::string card(std::string_view label_html, std::string_view value_html, std::string_view note_html) {
  return fmt::format("<div class=\"card\"><h3>{}</h3><p class=\"value\">{}</p><p class=\"note\">{}</p></div>\n",
                     label_html, value_html, note_html);
}

std::string figure(std::string_view content, std::string_view caption_html, std::string_view csv_name) {
  std::string const link = csv_name.empty() ? "" : fmt::format(" <a class=\"numbers\" href=\"{0}\">{0}</a>", csv_name);
  return fmt::format("<figure>{}<figcaption>{}{}</figcaption></figure>\n", content, caption_html, link);
}

}  // namespace layerloop::coupling
