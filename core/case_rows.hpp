#pragma once
#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/case_schema.hpp"

// What the rows of the schema are written with.
namespace layerloop {

using D = Dimension;
inline constexpr auto open = Range::End::open;

/// `at<&Case::laser, &LaserSettings::power>` reaches that member in a case.
template <auto... path>
inline constexpr auto at = [](Case& into) -> auto& {
  return (into.*....*path);
};

template <auto... path>
Choice choice(std::vector<std::string> words) {
  return {std::move(words), [](Case const& from) { return static_cast<std::size_t>((from.*....*path)); },
          [](Case& into, std::size_t index) {
            auto& member = (into.*....*path);
            member = static_cast<std::remove_reference_t<decltype(member)>>(index);
          }};
}

template <auto... path>
Choice word(std::vector<std::string> const& words) {
  return {words,
          [words](Case const& from) {
            return static_cast<std::size_t>(std::find(words.begin(), words.end(), (from.*....*path)) - words.begin());
          },
          [words](Case& into, std::size_t index) { (into.*....*path) = words.at(index); }};
}

/// [laser], [optics] and [scan]; [absorb]; [melt].
std::vector<CaseKey> laser_rows();
std::vector<CaseKey> absorb_rows();
std::vector<CaseKey> melt_rows();

}  // namespace layerloop
