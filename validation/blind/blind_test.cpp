#include "validation/blind/blind_test.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <functional>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/json_number.hpp"
#include "core/progress.hpp"
#include "core/write_file.hpp"
#include "validation/blind/seal.hpp"
#include "validation/blind/study_writer.hpp"
#include "validation/digest.hpp"
#include "validation/study_file.hpp"

namespace layerloop::validation {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string id_of(std::size_t number) { return fmt::format("s{:03}", number + 1); }

/// Calls for every number below `count`, on all cores, or one after another where a call is itself the stages at work;
/// the first error goes on to the caller.
void for_all(std::size_t count, Effort effort, std::function<void(std::size_t)> const& action) {
  std::exception_ptr failure;
  Progress progress("scenarios", static_cast<double>(count), effort == Effort::dear);
#pragma omp parallel for schedule(dynamic, 1) if (effort == Effort::free)
  for (std::size_t i = 0; i < count; ++i) {
    try {
      if (!failure) action(i);
      if (effort == Effort::dear) progress.update(static_cast<double>(i + 1));
    } catch (...) {
#pragma omp critical
      if (!failure) failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

json read_json(fs::path const& file, std::string const& why) {
  if (!fs::is_regular_file(file)) throw InputError(fmt::format("no {} ({})", file.string(), why));
  try {
    return json::parse(read_file(file));
  } catch (json::exception const&) {
    throw InputError(
        fmt::format("{} is not what this program wrote (it does not parse) make the set anew", file.string()));
  }
}

void write_json(fs::path const& file, json const& content) { write_file(file, content.dump(1) + "\n"); }

json manifest_of(fs::path const& folder) {
  return read_json(folder / "manifest.json", "not a blind test: layerloop blind make comes first");
}

struct Listed {
  std::string id;
  std::vector<std::string> withheld;
  std::string sealed;  ///< sha256
};

std::vector<Listed> scenarios_of(json const& manifest) {
  std::vector<Listed> all;
  for (json const& one : manifest.at("scenarios"))
    all.push_back({one.at("id"), one.at("withheld"), one.at("sealed_sha256")});
  return all;
}

std::string checked_box(fs::path const& folder, Listed const& listed) {
  std::string const box = read_file(folder / listed.id / "answer.sealed");
  if (sha256(box) != listed.sealed)
    throw InputError(
        fmt::format("{}: the sealed answer is not the one that was published (its sha256 differs from manifest.json) "
                    "make the set anew",
                    listed.id));
  return box;
}

struct Ablation {
  std::string name;
  bool Thresholds::*off;
};

std::array<Ablation, 4> const ablations{{{"without projection", &Thresholds::projects},
                                         {"without gate", &Thresholds::gates},
                                         {"without refit", &Thresholds::refits},
                                         {"without scale and outliers", &Thresholds::scales}}};

std::vector<std::string> methods_of(Also also) {
  std::vector<std::string> names;
  if (also != Also::nothing)
    for (int b = 0; b < baselines; ++b) names.push_back(name_of(static_cast<Baseline>(b)));
  if (also == Also::baselines_and_ablations)
    for (Ablation const& ablation : ablations) names.push_back(ablation.name);
  return names;
}

json verdict_of(World const& world, fs::path const& folder, Listed const& listed, Also also, std::uint64_t seed) {
  Study const training = read_study(folder / listed.id);
  json verdict{{"judgement", judge(world, training, listed.withheld, {}, seed)}, {"others", json::array()}};
  if (also != Also::nothing)
    for (Judgement const& other : judge_by_baselines(world, training, listed.withheld))
      verdict["others"].push_back(other);
  if (also == Also::baselines_and_ablations) {
    for (Ablation const& ablation : ablations) {
      Thresholds thresholds;
      thresholds.*ablation.off = false;
      verdict["others"].push_back(judge(world, training, listed.withheld, thresholds, seed));
    }
  }
  return verdict;
}

}  // namespace

std::string const& name_of(BlindSet set) {
  static std::array<std::string, 2> const names{"development", "scored"};
  return names.at(static_cast<std::size_t>(set));
}

std::string text_of(Thresholds const& t) {
  return fmt::format(
      "family error {}, adequate p {}, rival gap {}, drop z {}, outlier z {}, outlier share {}, noisy scale {}, large "
      "pull {}, whole {}, structure p {}, several p {}, twin cosine {}, most effects {}, refitted candidates {}",
      t.family_error, t.adequate_p, t.rival_gap, t.drop_z, t.outlier_z, t.outlier_share, t.noisy_scale, t.large_pull,
      t.whole, t.structure_p, t.several_p, t.twin_cosine, t.most_effects, t.refitted_candidates);
}

void make_blind_test(fs::path const& folder, std::string const& world_name, std::size_t scenarios, std::uint64_t seed,
                     BlindSet set) {
  if (fs::exists(folder / "manifest.json"))
    throw InputError(
        fmt::format("{} holds a blind test already (a set is drawn once) give another folder", folder.string()));
  auto const world = world_of(world_name, folder);
  std::vector<ScenarioClass> const classes = world->classes();
  std::vector<json> listed(scenarios);
  for_all(scenarios, world->effort(), [&](std::size_t i) {
    std::string const id = id_of(i);
    Scenario const scenario = draw_scenario(*world, classes[i % classes.size()], id, secret_of(seed, name_of(set), id));
    write_study(scenario.study, world->case_text(), folder / id);
    std::string const box = seal(json(scenario.answer).dump(), seed, name_of(set), id);
    write_file(folder / id / "answer.sealed", box);
    listed[i] = {{"id", id}, {"withheld", scenario.withheld}, {"sealed_sha256", sha256(box)}};
  });
  write_json(folder / "manifest.json",
             {{"world", world->name()}, {"set", name_of(set)}, {"scenarios", listed}, {"version", LAYERLOOP_VERSION}});
}

void run_blind_test(fs::path const& folder, Also also) {
  if (fs::exists(folder / "verdicts.json"))
    throw InputError(
        fmt::format("{} has its verdicts already (they are given once) draw another set", folder.string()));
  json const manifest = manifest_of(folder);
  std::vector<Listed> const all = scenarios_of(manifest);
  auto const world = world_of(manifest.at("world"), folder);
  std::vector<std::string> hashes(all.size());
  for_all(all.size(), world->effort(), [&](std::size_t i) {
    checked_box(folder, all[i]);
    fs::path const verdict = folder / all[i].id / "verdict.json";
    if (!fs::exists(verdict)) write_json(verdict, verdict_of(*world, folder, all[i], also, i));
    hashes[i] = sha256(read_file(verdict));
  });
  json verdicts{{"thresholds", text_of({})}, {"thresholds_sha256", sha256(text_of({}))}, {"methods", methods_of(also)}};
  for (std::size_t i = 0; i < all.size(); ++i) verdicts["sha256"][all[i].id] = hashes[i];
  write_json(folder / "verdicts.json", verdicts);
}

std::vector<Opened> open_blind_test(fs::path const& folder, std::uint64_t seed) {
  json const manifest = manifest_of(folder);
  json const verdicts = read_json(folder / "verdicts.json", "layerloop blind run comes before blind open");
  std::vector<Listed> const all = scenarios_of(manifest);
  auto const world = world_of(manifest.at("world"), folder);
  for_all(all.size(), world->effort(), [&](std::size_t i) {
    fs::path const at = folder / all[i].id;
    if (sha256(read_file(at / "verdict.json")) != verdicts.at("sha256").at(all[i].id))
      throw InputError(
          fmt::format("{}: the verdict was changed after it was given (its sha256 differs from "
                      "verdicts.json) the set is worthless now",
                      all[i].id));
    Answer const answer = json::parse(unseal(checked_box(folder, all[i]), seed, manifest.at("set"), all[i].id));
    Judgement const judgement = json::parse(read_file(at / "verdict.json")).at("judgement");
    Study const training = read_study(at), holdout = read_study(at, Role::holdout);
    Forecast const forecast = forecast_of(*world, training, holdout, all[i].withheld, answer.truth, judgement);
    json opened = answer;
    opened["forecast"] = {{"calibrated", forecast.calibrated},
                          {"named", forecast.named},
                          {"smooth", forecast.smooth},
                          {"whitened", forecast.whitened}};
    write_json(at / "answer.json", opened);
  });
  return opened_blind_test(folder);
}

std::vector<Opened> opened_blind_test(fs::path const& folder) {
  std::vector<Opened> opened;
  for (Listed const& listed : scenarios_of(manifest_of(folder))) {
    json const answer = read_json(folder / listed.id / "answer.json", "layerloop blind open comes before blind score");
    json const verdict = read_json(folder / listed.id / "verdict.json", "layerloop blind run comes first");
    auto const forecast = [&](char const* name) { return number_or_nan(answer.at("forecast").at(name)); };
    opened.push_back({answer.get<Answer>(),
                      verdict.at("judgement").get<Judgement>(),
                      {forecast("calibrated"), forecast("named"), forecast("smooth"), forecast("whitened")},
                      verdict.at("others").get<std::vector<Judgement>>()});
  }
  return opened;
}

std::vector<std::string> other_methods(fs::path const& folder) {
  return read_json(folder / "verdicts.json", "layerloop blind run comes first").at("methods");
}

}  // namespace layerloop::validation
