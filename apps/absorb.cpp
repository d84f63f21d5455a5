#include <fmt/format.h>

#include <memory>
#include <optional>

#include "apps/verbs.hpp"
#include "core/case_file.hpp"
#include "core/communicator.hpp"
#include "core/error.hpp"
#include "core/units.hpp"
#include "coupling/absorption_study.hpp"

namespace layerloop::apps {
namespace {

struct AbsorbArguments {
  CaseOptions from;
  coupling::AbsorbOptions to;
  std::vector<std::string> beds, wavelengths, temperatures;
  std::string mesh, periodic_x, periodic_y, floor_z, refractive_index;
  std::optional<double> target_standard_error;
};

/// For beds that come without a case: even light of a fibre laser on 316L.
constexpr char const* bare_case = R"(
[case]
name = "bed"
[powder]
material = "316L"
[laser]
wavelength = "1070 nm"
[optics]
uniform_beam = true
)";

std::vector<std::string> overrides_of(AbsorbArguments const& arguments) {
  std::vector<std::string> all;
  if (!arguments.beds.empty()) all.push_back("absorb.bed=file");
  if (arguments.target_standard_error)
    all.push_back(fmt::format("absorb.target_standard_error={}", *arguments.target_standard_error));
  if (!arguments.refractive_index.empty())
    all.push_back(fmt::format("optics.refractive_index=[{}]", arguments.refractive_index));
  return all;
}

Case case_of(AbsorbArguments const& arguments) {
  CaseOptions from = arguments.from;
  std::vector<std::string> const own = overrides_of(arguments);
  from.overrides.insert(from.overrides.begin(), own.begin(), own.end());
  if (!from.case_file.empty()) return read_case(from, Process::absorbing);
  if (arguments.beds.empty())
    throw InputError("neither a case nor a bed (what is to be lit?) name FILE.toml or --bed FILE");
  return case_of_text(from, bare_case, Process::absorbing);
}

std::vector<coupling::BedSource> bed_sources(AbsorbArguments const& arguments) {
  auto const length = [](std::string const& text) {
    return text.empty() ? std::nullopt : std::optional(parse_quantity(text, Dimension::length));
  };
  std::vector<coupling::BedSource> sources;
  for (std::string const& bed : arguments.beds)
    sources.push_back(
        {bed, arguments.mesh, length(arguments.periodic_x), length(arguments.periodic_y), length(arguments.floor_z)});
  return sources;
}

void absorb(AbsorbArguments const& arguments) {
  Case const checked = case_of(arguments);
  if (checked.absorb.bed == AbsorbingBed::file && arguments.beds.empty())
    throw InputError("absorb.bed = \"file\" (no file is named) add --bed FILE");
  coupling::AbsorbOptions options = arguments.to;
  options.beds = bed_sources(arguments);
  for (std::string const& text : arguments.wavelengths)
    options.wavelengths.push_back(parse_quantity(text, Dimension::length));
  for (std::string const& text : arguments.temperatures)
    options.temperatures.push_back(parse_quantity(text, Dimension::temperature));
  Communicator const comm;
  coupling::AbsorptionStudy const study = coupling::run_absorption(checked, options, comm);
  if (!comm.is_root() || options.quiet) return;
  for (std::size_t k = 0; k < study.sets.size(); ++k) {
    coupling::AbsorptionFigure const a = study.absorptivity(k);
    fmt::print("{:<24} absorptivity {:.4f} +- {:.4f} (rays)", study.sets[k].name, a.value, a.standard_error);
    if (a.n > 1) fmt::print(", +- {:.4f} (95 %, {} beds), {:.4f} from bed to bed", a.u_bed, a.n, a.sd_bed);
    fmt::print("\n");
  }
  fmt::print("{}\n", (options.folder / "report.html").string());
}

}  // namespace

void add_absorb(CLI::App& program, Action& chosen) {
  CLI::App* verb = program.add_subcommand("absorb", "how much light a bed absorbs, and where");
  auto const a = std::make_shared<AbsorbArguments>();
  add_case_options(*verb, a->from);
  verb->get_option("case")->required(false);
  verb->add_option("-o,--output", a->to.folder, "folder for the results")->required()->type_name("DIR");
  verb->add_option("--bed", a->beds, "the bed: csv, dump, extxyz or h5 (repeated: independent beds)")
      ->type_name("FILE");
  verb->add_option("--mesh", a->mesh, "triangles that lie with the grains, in metres")->type_name("FILE.stl");
  verb->add_option("--periodic-x", a->periodic_x, "period along x, if not that of the file")->type_name("LENGTH");
  verb->add_option("--periodic-y", a->periodic_y, "period along y, if not that of the file")->type_name("LENGTH");
  verb->add_option("--floor-z", a->floor_z, "level of a flat floor, if not that of the file")->type_name("LENGTH");
  verb->add_option("--refractive-index", a->refractive_index, "of the powder: n,k")->type_name("N,K");
  verb->add_option("--materials", a->to.materials, "further metals or optical constants, in the same trace")
      ->delimiter(',');
  verb->add_option("--wavelengths", a->wavelengths, "further wavelengths, in the same trace")->delimiter(',');
  verb->add_option("--temperatures", a->temperatures, "further temperatures of the metal")->delimiter(',');
  verb->add_option("--target-se", a->target_standard_error, "standard error of the absorptivity to be reached");
  verb->add_flag("--derivatives", a->to.derivatives, "also how the absorptivity changes with n and k");
  verb->add_flag("--quiet", a->to.quiet, "no progress and no words");
  verb->callback([=, &chosen] { chosen = [=] { absorb(*a); }; });
}

}  // namespace layerloop::apps
