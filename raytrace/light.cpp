#include "raytrace/light.hpp"

#include <algorithm>
#include <cmath>

namespace layerloop::raytrace {

AveragedLight::AveragedLight(std::span<OpticalSet const> sets, Slopes slopes)
    : sets_(sets),
      materials_(sets[0].surface.size()),
      power_(sets.size()),
      absorbed_(sets.size()),
      slope_(slopes == Slopes::with ? sets.size() * materials_ : 0) {}

void AveragedLight::start(Beam const& /*beam*/, Vec3 const& /*direction*/) {
  std::ranges::fill(power_, 1.0);
  std::ranges::fill(slope_, IndexSlope{});
}

void AveragedLight::reflect(Reflection const& hit) {
  double const cosine = -hit.in.dot(hit.normal);
  for (std::size_t k = 0; k < sets_.size(); ++k) {
    absorbed_[k] = 0;
    if (power_[k] == 0) continue;
    Surface const& surface = sets_[k].surface[hit.material];
    double const share = reflectance(surface, sets_[k].wavelength, cosine);
    if (!slope_.empty()) {
      IndexSlope const here = reflectance_slope(surface, sets_[k].wavelength, cosine);
      for (std::size_t m = 0; m < materials_; ++m) {
        IndexSlope& slope = slope_[k * materials_ + m];
        slope = {share * slope.n, share * slope.k};
      }
      IndexSlope& own = slope_[k * materials_ + hit.material];
      own = {own.n + power_[k] * here.n, own.k + power_[k] * here.k};
    }
    double const after = power_[k] * share;
    absorbed_[k] = power_[k] - after;
    power_[k] = after;
  }
}

void AveragedLight::end(std::size_t set) { power_[set] = 0; }

TrackedLight::TrackedLight(std::span<OpticalSet const> sets, Slopes slopes)
    : sets_(sets),
      materials_(sets[0].surface.size()),
      power_(sets.size()),
      absorbed_(sets.size()),
      field_(sets.size() * parts),
      slope_(slopes == Slopes::with ? sets.size() * parts * materials_ : 0) {}

void TrackedLight::start(Beam const& beam, Vec3 const& direction) {
  std::array<Field, parts> const fields = ray_fields(beam, direction);
  std::ranges::fill(power_, 1.0);
  for (std::size_t f = 0; f < field_.size(); ++f) field_[f] = fields[f % parts];
  std::ranges::fill(slope_, Field(Field::Zero()));
}

void TrackedLight::reflect(Reflection const& hit) {
  Vec3 const across = hit.in.cross(hit.normal);
  // At normal incidence every direction across the ray will do.
  Vec3 const s = across.norm() > 1e-9 ? Vec3(across.normalized()) : Vec3(hit.in.unitOrthogonal());
  Vec3 const p_in = s.cross(hit.in), p_out = s.cross(hit.out);
  auto const turn = [&](FresnelAmplitudes const& ratio, Field const& e) -> Field {
    return (ratio.s * s.cast<std::complex<double>>().dot(e)) * s +
           (ratio.p * p_in.cast<std::complex<double>>().dot(e)) * p_out;
  };
  double const cosine = -hit.in.dot(hit.normal);
  for (std::size_t k = 0; k < sets_.size(); ++k) {
    absorbed_[k] = 0;
    if (power_[k] == 0) continue;
    Surface const& surface = sets_[k].surface[hit.material];
    FresnelAmplitudes const ratio = amplitudes(surface, sets_[k].wavelength, cosine);
    double after = 0;
    for (std::size_t f = k * parts; f < (k + 1) * parts; ++f) {
      if (!slope_.empty()) {
        Field* const slope = &slope_[f * materials_];
        for (std::size_t m = 0; m < materials_; ++m) slope[m] = turn(ratio, slope[m]);
        slope[hit.material] += turn(amplitude_slopes(surface, sets_[k].wavelength, cosine), field_[f]);
      }
      field_[f] = turn(ratio, field_[f]);
      after += field_[f].squaredNorm();
    }
    absorbed_[k] = power_[k] - after;
    power_[k] = after;
  }
}

void TrackedLight::scatter(Vec3 const& out) {
  Vec3 const x = out.unitOrthogonal(), y = out.cross(x);
  for (std::size_t k = 0; k < sets_.size(); ++k) {
    if (power_[k] == 0) continue;
    double const amplitude = std::sqrt(0.5 * power_[k]);
    for (std::size_t m = 0; m < materials_ && !slope_.empty(); ++m) {
      // So that slope() gives the same before and after.
      IndexSlope const change = slope(k, m);
      std::complex<double> const each = std::complex<double>(change.n, -change.k) / (4 * amplitude);
      slope_[k * parts * materials_ + m] = each * x;
      slope_[(k * parts + 1) * materials_ + m] = each * y;
    }
    field_[k * parts] = amplitude * x;
    field_[k * parts + 1] = amplitude * y;
  }
}

void TrackedLight::end(std::size_t set) { power_[set] = 0; }

IndexSlope TrackedLight::slope(std::size_t set, std::size_t material) const {
  std::complex<double> change = 0;  // conj(e) de/dN; the field is an analytic function of N
  for (std::size_t f = set * parts; f < (set + 1) * parts; ++f)
    change += field_[f].dot(slope_[f * materials_ + material]);
  return {2 * change.real(), -2 * change.imag()};
}

}  // namespace layerloop::raytrace
