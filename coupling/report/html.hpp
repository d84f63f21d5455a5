#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

namespace layerloop::coupling {

/// Text that may stand between tags and inside quoted attributes.
std::string escape(std::string_view text);

std::string base64(std::string_view bytes);

/// JSON that may stand inside <script type="application/json">: no '<' is left in it.
std::string script_json(nlohmann::json const& value);

/// Replaces every {{name}} once; what is filled in is not searched again. \pre every name of the text is in `parts`
std::string fill_in(std::string_view text, std::map<std::string, std::string> const& parts);

/// Decimals with so many significant digits, for people: 0.0412, 1830, 2.1 &times; 10^-9 as HTML. A dash when not
/// finite.
std::string significant(double value, int digits = 3);

/// A value that someone chose: as short as it can be, "60" or "0.8".
std::string chosen(double value);

/// "960 000"
std::string count(std::int64_t number);

/// "0.612 &plusmn; 0.004": as many digits as the uncertainty carries. Without one, three significant digits.
std::string with_uncertainty(double value, double uncertainty);

/// One of the figures to look at first, with its name and a word on it, all HTML; they stand in a <div class="cards">.
std::string card(std::string_view label_html, std::string_view value_html, std::string_view note_html);

/// A plot or picture with its words, and the file that holds its numbers.
std::string figure(std::string_view content, std::string_view caption_html, std::string_view csv_name = {});

}  // namespace layerloop::coupling
