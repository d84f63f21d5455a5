#include "coupling/report/page.hpp"

#include <fmt/format.h>

#include "coupling/report/html.hpp"
#include "report_assets.hpp"

namespace layerloop::coupling {
namespace {

/// Only our own style and script run, known by their digests; nothing is fetched from anywhere.
std::string content_security_policy() {
  auto const digest = [](std::string_view hex) {
    std::string bytes;
    for (std::size_t i = 0; i < hex.size(); i += 2)
      bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
    return base64(bytes);
  };
  return fmt::format("default-src 'none'; img-src data:; style-src 'sha256-{}'; script-src 'sha256-{}'",
                     digest(report_css_sha256), digest(viewer_js_sha256));
}

}  // namespace

void Page::add(std::string_view id, std::string_view heading, std::string const& content) {
  if (content.empty()) return;
  contents += fmt::format("<a href=\"#{}\">{}</a>", id, heading);
  body += fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", id, heading, content);
}

std::string Page::html() const {
  return fill_in(report_html, {{"policy", content_security_policy()},
                               {"title", escape(title)},
                               {"style", std::string(report_css)},
                               {"script", std::string(viewer_js)},
                               {"version", escape(version)},
                               {"seed", std::to_string(seed)},
                               {"headline", headline},
                               {"cards", cards},
                               {"contents", contents},
                               {"body", body},
                               {"bed_data", bed_data},
                               {"files", escape(files)}});
}

}  // namespace layerloop::coupling
