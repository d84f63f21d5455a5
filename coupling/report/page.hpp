#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace layerloop::coupling {

/// A report as one page that needs no network.
struct Page {
  std::string title, version, headline, cards;
  std::uint64_t seed = 0;
  std::string contents = {}, body = {};
  std::string bed_data = "null";                                                    ///< for the interactive view
  std::string files = "; bed, grid and mesh of each layer lie in the same folder";  ///< what else the footer names

  /// A section with its entry in the list of contents; nothing when it has no content.
  void add(std::string_view id, std::string_view heading, std::string const& content);
  std::string html() const;
};

}  // namespace layerloop::coupling
