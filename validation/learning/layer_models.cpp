#include "validation/learning/layer_models.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/grain_size.hpp"
#include "coupling/report/shown_quantity.hpp"

namespace layerloop::validation {
namespace {

constexpr double gravity = 9.81;
constexpr std::array models{LayerModel::layer_wise, LayerModel::steady, LayerModel::settings,
                            LayerModel::settings_and_layer};

struct Row {
  std::size_t point;
  bool is_last;
  double number, roughness_below, thickness_below, void_layer, speed;
  std::vector<double> settings;
  nlohmann::json const* figures;
};

/// The groups that gravity, cohesion and the size of the grains make of what was set.
std::vector<double> settings_of(LayeredRun const& run) {
  Case const& of = *run.checked;
  double const d = std::cbrt(6 / std::numbers::pi * mean_grain_volume(of.powder));
  std::vector<double> settings{of.machine.layer_thickness / d, of.machine.recoating_speed / std::sqrt(gravity * d),
                               of.machine.dose_factor, coupling::figure_in(run.layers->front(), "bond_number")};
  settings.insert(settings.end(), run.others.begin(), run.others.end());
  return settings;
}

std::vector<Row> rows_of(std::vector<LayeredRun> const& runs) {
  std::vector<Row> rows;
  for (LayeredRun const& run : runs) {
    double roughness = 0, thickness = 0;  // of the plate
    double number = 1;
    for (nlohmann::json const& layer : *run.layers) {
      rows.push_back({run.point, &layer == &run.layers->back(), number++, roughness, thickness,
                      coupling::figure_in(layer, "void_layer"), run.checked->machine.recoating_speed, settings_of(run),
                      &layer});
      roughness = coupling::figure_in(layer, "roughness_sa");
      thickness = coupling::figure_in(layer, "effective_thickness");
    }
  }
  return rows;
}

std::vector<double> inputs_of(LayerModel model, Row const& row) {
  if (model == LayerModel::layer_wise) return {row.roughness_below, row.void_layer};
  if (model == LayerModel::steady) return {row.roughness_below, row.thickness_below, row.speed};
  std::vector<double> inputs = row.settings;
  if (model == LayerModel::settings_and_layer) inputs.push_back(row.number);
  return inputs;
}

bool learns_all_layers(LayerModel model) {
  return model == LayerModel::layer_wise || model == LayerModel::settings_and_layer;
}

Eigen::VectorXd some(Eigen::VectorXd const& of, std::vector<Eigen::Index> const& rows) { return of(rows); }

/// \param rows  that have the output and every input
LayerSkill skill_of_model(LayerModel model, std::string const& output, std::vector<Row const*> const& rows) {
  auto const n = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd places(n, static_cast<Eigen::Index>(inputs_of(model, *rows.front()).size()));
  Eigen::VectorXd values(n);
  std::vector<std::size_t> points;
  std::vector<Eigen::Index> last;
  for (Eigen::Index i = 0; i < n; ++i) {
    Row const& row = *rows[static_cast<std::size_t>(i)];
    std::vector<double> const inputs = inputs_of(model, row);
    places.row(i) = Eigen::Map<Eigen::RowVectorXd const>(inputs.data(), places.cols());
    values[i] = coupling::figure_in(*row.figures, output);
    points.push_back(row.point);
    if (row.is_last) last.push_back(i);
  }
  LeftOut const predicted = Surrogate(places, values).left_out(points);
  LayerSkill found{
      model, output, skill_of(some(values, last), {some(predicted.mean, last), some(predicted.sd, last)}), {}};
  if (learns_all_layers(model)) found.all = skill_of(values, predicted);
  return found;
}

bool varies(std::string const& output, std::vector<Row const*> const& rows) {
  for (Row const* row : rows)
    if (coupling::figure_in(*row->figures, output) != coupling::figure_in(*rows.front()->figures, output)) return true;
  return false;
}

}  // namespace

std::string const& words_of(LayerModel model) {
  static std::array<std::string, 4> const words{
      "layer-wise: roughness below, void layer", "steady: roughness and effective thickness below, speed",
      "settings: thickness, speed, dose, Bond number", "settings and number of the layer"};
  return words.at(static_cast<std::size_t>(model));
}

std::vector<LayerSkill> compare_layer_models(std::vector<LayeredRun> const& runs,
                                             std::vector<std::string> const& outputs) {
  std::vector<Row> const rows = rows_of(runs);
  std::vector<LayerSkill> all;
  for (std::string const& output : outputs) {
    for (LayerModel const model : models) {
      std::vector<Row const*> used;
      for (Row const& row : rows) {
        bool finite = std::isfinite(coupling::figure_in(*row.figures, output));
        for (double const input : inputs_of(model, row)) finite = finite && std::isfinite(input);
        if (finite && (row.is_last || learns_all_layers(model))) used.push_back(&row);
      }
      if (used.size() > 2 && varies(output, used)) all.push_back(skill_of_model(model, output, used));
    }
  }
  return all;
}

}  // namespace layerloop::validation
