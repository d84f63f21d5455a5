#include "raytrace/radial_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/bed_text.hpp"
#include "core/error.hpp"
#include "core/units.hpp"
#include "core/write_file.hpp"

namespace layerloop::raytrace {
namespace {

/// Integral of (a + b s) s^power over s from r0 to r, where a + b s runs through (r0, i0) and (r1, i1).
double moment(double r0, double i0, double r1, double i1, double r, int power) {
  double const b = (i1 - i0) / (r1 - r0), a = i0 - b * r0;
  auto const primitive = [&](double s) {
    return a * std::pow(s, power + 1) / (power + 1) + b * std::pow(s, power + 2) / (power + 2);
  };
  return primitive(r) - primitive(r0);
}

}  // namespace

RadialProfile::RadialProfile(std::vector<double> radius, std::vector<double> intensity)
    : radius_(std::move(radius)), intensity_(std::move(intensity)) {
  auto const refuse = [](std::string_view why) {
    throw InputError(
        fmt::format("a beam's profile cannot be used ({}) give radii that ascend from 0 or more, and "
                    "intensities of at least 0",
                    why));
  };
  if (radius_.size() < 2 || radius_.size() != intensity_.size()) refuse("it needs two points at least");
  for (std::size_t i = 0; i < radius_.size(); ++i) {
    bool const ascends = i == 0 ? radius_[0] >= 0 : radius_[i] > radius_[i - 1];
    if (!(ascends && std::isfinite(radius_[i]))) refuse(fmt::format("radius {} does not ascend", i + 1));
    if (!(intensity_[i] >= 0 && std::isfinite(intensity_[i]))) refuse(fmt::format("intensity {} is below 0", i + 1));
  }
  if (radius_.front() > 0) {
    radius_.insert(radius_.begin(), 0.0);
    intensity_.insert(intensity_.begin(), intensity_.front());
  }
  power_.assign(1, 0.0);
  for (std::size_t i = 0; i + 1 < radius_.size(); ++i) power_.push_back(power_.back() + power_to(i, radius_[i + 1]));
  double const total = power_.back();
  if (!(total > 0)) refuse("it holds no power");
  for (double& i : intensity_) i /= total;
  for (double& p : power_) p /= total;
}

/// From the start of an interval, without the factor 2 pi.
double RadialProfile::power_to(std::size_t i, double r) const {
  return moment(radius_[i], intensity_[i], radius_[i + 1], intensity_[i + 1], r, 1);
}

double RadialProfile::power_inside(double r) const {
  if (r >= radius_.back()) return 1;
  auto const above = std::upper_bound(radius_.begin(), radius_.end(), std::max(r, 0.0));
  auto const i = static_cast<std::size_t>(above - radius_.begin()) - 1;
  return power_[i] + power_to(i, std::max(r, 0.0));
}

double RadialProfile::radius_holding(double share) const {
  auto const above = std::upper_bound(power_.begin(), power_.end() - 1, share);
  std::size_t const i = static_cast<std::size_t>(above - power_.begin()) - 1;
  double low = radius_[i], high = radius_[i + 1], r = 0.5 * (low + high);
  for (int step = 0; step < 60; ++step) {  // Newton's steps, and halving where they would leave the interval
    double const excess = power_[i] + power_to(i, r) - share;
    (excess > 0 ? high : low) = r;
    double const along = (r - radius_[i]) / (radius_[i + 1] - radius_[i]);
    double const next = r - excess / (r * std::lerp(intensity_[i], intensity_[i + 1], along));
    double const before = r;
    r = next > low && next < high ? next : 0.5 * (low + high);
    if (std::abs(r - before) <= 1e-13 * radius_.back()) break;
  }
  return r;
}

double RadialProfile::second_moment_diameter() const {
  double squares = 0;  // of r; half of it along one axis
  for (std::size_t i = 0; i + 1 < radius_.size(); ++i)
    squares += moment(radius_[i], intensity_[i], radius_[i + 1], intensity_[i + 1], radius_[i + 1], 3);
  return 4 * std::sqrt(0.5 * squares);
}

RadialProfile ring_profile(double crest, double half_width) {
  constexpr int points = 1000;
  constexpr double reach = 3;  // half widths; 2e-8 of the crest is left there
  double const from = std::max(0.0, crest - reach * half_width), to = crest + reach * half_width;
  std::vector<double> radius, intensity;
  for (int p = 0; p <= points; ++p) {
    double const r = std::lerp(from, to, static_cast<double>(p) / points), x = (r - crest) / half_width;
    radius.push_back(r);
    intensity.push_back(std::exp(-2 * x * x));
  }
  return {std::move(radius), std::move(intensity)};
}

RadialProfile read_radial_profile(std::filesystem::path const& path) {
  BedText text(path, read_file(path));
  std::string_view const header = text.require("the header r [UNIT],intensity [...]");
  std::vector<std::string_view> const names = words_of(header, ',');
  std::size_t const open = header.find('['), close = header.find(']');
  if (names.size() != 2 || !names[0].starts_with("r ") || !names[1].starts_with("intensity") || close == header.npos ||
      close < open)
    text.refuse("the header is \"{}\" (columns and the unit of r are not clear) write r [um],intensity [W/m2]", header);
  double const unit = parse_quantity("1 " + std::string(header.substr(open + 1, close - open - 1)), Dimension::length);
  std::vector<double> radius, intensity;
  while (auto const line = text.next()) {
    if (line->empty() || line->starts_with('#')) continue;
    std::vector<std::string_view> const words = words_of(*line, ',');
    if (words.size() != 2) text.refuse("{} values in a row (there must be 2) write r,intensity", words.size());
    radius.push_back(unit * text.number(words[0], "r"));
    intensity.push_back(text.number(words[1], "intensity"));
  }
  try {
    return {std::move(radius), std::move(intensity)};
  } catch (InputError const& fault) {
    throw InputError(fmt::format("{}: {}", path.string(), fault.what()));
  }
}

}  // namespace layerloop::raytrace
