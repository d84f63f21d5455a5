#include "core/case_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "core/case_checks.hpp"
#include "core/case_schema.hpp"
#include "core/case_values.hpp"
#include "core/error.hpp"
#include "core/optical_constants.hpp"
#include "core/spelling.hpp"
#include "core/toml_entries.hpp"
#include "core/write_file.hpp"

namespace layerloop {
namespace {

bool is_material(std::string const& table) { return table.starts_with("material."); }

/// Tables about many cases, that sweep and learn read: one case is the rest of the file.
bool is_of_many_cases(std::string const& table) {
  return table == "sweep" || table == "sweep.vary" || table == "learn";
}

bool is_table(std::string const& name) {
  std::string const family = family_of(name);
  return is_of_many_cases(name) || is_material(name) || name == "material" || name == "effects" ||
         name == "modifiers" || family != name ||
         std::find(case_tables().begin(), case_tables().end(), name) != case_tables().end();
}

/// Tables that hold a key of this name: "[scan]", "[laser] or [optics]".
std::string tables_with(std::string const& key) {
  std::string list;
  for (CaseKey const& row : case_schema()) {
    if (row.key != key || row.table.starts_with("effects.") || is_of_names(row)) continue;
    list += (list.empty() ? "[" : " or [") + (row.table == "material" ? "material.NAME" : row.table) + "]";
  }
  return list;
}

std::vector<std::string> keys_of(std::string const& table) {
  std::vector<std::string> keys;
  for (CaseKey const& row : case_schema()) {
    if (row.table == family_of(table)) keys.push_back(row.key);
  }
  return keys;
}

/// Turns entries into a case and collects every fault on the way.
class CaseReader {
 public:
  CaseReader(TomlContent content, std::vector<TomlEntry> overrides) : tables_(std::move(content.tables)) {
    for (TomlEntry& entry : content.entries) take(std::move(entry));
    for (TomlEntry& entry : overrides) take(std::move(entry));
  }

  Case read(std::optional<Process> process) {
    case_.process = process.value_or(tables_.contains("laser") ? Process::melting : Process::spreading);
    report_unknown();
    for (CaseKey const& row : case_schema()) {
      if (row.table != "material" && !is_of_names(row)) fill(row, row.table, case_);
    }
    if (case_.melt.bed == MeltedBed::automatic)
      case_.melt.bed = tables_.contains("machine") ? MeltedBed::spread : MeltedBed::plate;
    read_mixture();
    read_modifiers();
    read_materials();
    report_missing();
    check_case(case_, {[this](std::string const& key) { return !unsound_.contains(key); },
                       [this](std::string const& key, std::string const& message) { report(place_of(key), message); }});
    return case_;
  }

  std::vector<Fault> const& faults() const { return faults_; }

 private:
  void take(TomlEntry entry) {
    std::string const name = entry.table + "." + entry.key;
    if (!entry.place.option.empty()) tables_.emplace(entry.table, entry.place);
    written_.insert_or_assign(name, std::move(entry));
  }

  void report(Place const& place, std::string const& message) { faults_.push_back({place, message}); }

  /// Where the user has to look: the key itself, else its table, else the top of the file.
  Place place_of(std::string const& name) const {
    std::string full = name;
    if (name.starts_with("material.")) full = "material." + case_.powder.material + name.substr(8);
    if (auto const entry = written_.find(full); entry != written_.end()) return entry->second.place;
    if (auto const table = tables_.find(full); table != tables_.end()) return table->second;
    auto const table = tables_.find(full.substr(0, full.rfind('.')));
    return table != tables_.end() ? table->second : Place{};
  }

  void report_unknown() {
    for (auto const& [table, place] : tables_) {
      if (is_table(table)) continue;
      if (table.starts_with("effects.")) {
        report_unknown_effect(table, place);
      } else {
        report(place, fmt::format("unknown table [{}]{}", table, did_you_mean(table, case_tables())));
        meant_tables_.insert(likely_name(table, case_tables()).value_or(""));
      }
    }
    for (auto const& [name, entry] : written_) {
      if (entry.table.empty()) {
        report_outside(entry);
      } else if (is_table(entry.table) && !is_of_many_cases(entry.table) && !find_key(entry.table, entry.key)) {
        report_unknown_key(entry);
      }
    }
  }

  void report_unknown_effect(std::string const& table, Place const& place) {
    std::vector<std::string> names;
    for (std::string const& known : case_tables()) {
      if (known.starts_with("effects.")) names.push_back(known.substr(8));
    }
    report(place, fmt::format("unknown effect \"{}\" (known: {}){}", table.substr(8), fmt::join(names, ", "),
                              did_you_mean(table.substr(8), names)));
  }

  void report_outside(TomlEntry const& entry) {
    std::string const belongs = tables_with(entry.key);
    if (is_table(entry.key)) {
      report(entry.place, fmt::format("\"{0}\" is a table (write [{0}] on a line of its own)", entry.key));
      meant_tables_.insert(entry.key);
    } else {
      report(entry.place, fmt::format("unknown key \"{}\" outside of any table{}", entry.key,
                                      belongs.empty() ? "" : "; it belongs in " + belongs));
    }
  }

  void report_unknown_key(TomlEntry const& entry) {
    std::string hint = did_you_mean(entry.key, keys_of(entry.table));
    if (hint.empty() && !tables_with(entry.key).empty()) hint = "; it belongs in " + tables_with(entry.key);
    if (entry.table == "effects" || entry.table == "material") {
      hint = fmt::format("; write a table [{}.{}]", entry.table, entry.table == "effects" ? entry.key : "NAME");
    }
    report(entry.place, fmt::format("unknown key \"{}\" in [{}]{}", entry.key, entry.table, hint));
    meant_keys_.insert(entry.table + "." + likely_name(entry.key, keys_of(entry.table)).value_or(""));
  }

  /// Puts the written value of a row, or its default, into `into`; `table` is the row's own or that of one material.
  void fill(CaseKey const& row, std::string const& table, Case& into) {
    if (auto const entry = written_.find(table + "." + row.key); entry != written_.end()) {
      try {
        store(row, entry->second.value, into);
      } catch (InputError const& fault) {
        report(entry->second.place, fault.what());
        unsound_.insert(name_of(row));
      }
      return;
    }
    std::string const preset = preset_value(case_.preset, table, row.key);
    std::string const& value = preset.empty() ? row.fallback : preset;
    if (value.starts_with('=')) {
      std::string const other = value.substr(1);
      std::size_t const dot = other.find('.');
      CaseKey const& source = *find_key(other.substr(0, dot), other.substr(dot + 1));
      std::get<Member<double>>(row.target)(into) = std::get<Member<double>>(source.target)(into);
      if (unsound_.contains(other)) unsound_.insert(name_of(row));
    } else if (!value.empty()) {
      store(row, parse_value(value), into);
    } else if (row.need != Need::never) {
      absent_.push_back({&row, table});
    }
  }

  void read_mixture() {
    for (auto const& [name, entry] : written_) {
      if (entry.table != "powder.mixture") continue;
      fill(mixture_row(entry.key), entry.table, case_);
      if (unsound_.contains(name)) unsound_.insert("powder.mixture");
    }
  }

  void read_modifiers() {
    for (auto const& [table, place] : tables_) {
      if (!table.starts_with("modifiers.")) continue;
      for (CaseKey const& row : modifier_rows(table.substr(10))) {
        fill(row, table, case_);
        if (unsound_.contains(name_of(row)) || row.need != Need::always || written_.contains(name_of(row))) continue;
        absent_.pop_back();  // the row is not of the schema
        unsound_.insert(name_of(row));
        report(place, fmt::format("missing key \"{}\" in [{}] ({})", row.key, table, row.sentence));
      }
    }
  }

  /// Built-in metals, changed and joined by the [material.NAME] tables; the powder's becomes that of the case.
  void read_materials() {
    std::map<std::string, Material> metals = built_in_materials();
    std::set<std::string> names;
    for (auto const& [table, place] : tables_) {
      if (is_material(table)) names.insert(table.substr(9));
    }
    std::string const& chosen = case_.powder.material;
    if (metals.contains(chosen)) names.insert(chosen);  // a preset may change it
    for (auto const& [name, share] : case_.powder.mixture)
      if (metals.contains(name)) names.insert(name);
    if (names.contains(walls_name))
      report(tables_.at("material.wall"), "no material can have the name \"wall\" (it stands for the walls) rename it");
    for (std::string const& name : names) {
      bool const is_new = !metals.contains(name);
      Case holder;
      holder.preset = case_.preset;
      holder.material = metals[name];
      holder.material.name = name;
      std::size_t const absent_before = absent_.size();
      std::set<std::string> const unsound_before = unsound_;
      for (CaseKey const& row : case_schema()) {
        if (row.table == "material") fill(row, "material." + name, holder);
      }
      if (!is_new) absent_.resize(absent_before);
      if (name != chosen) unsound_ = unsound_before;
      metals[name] = holder.material;
    }
    choose_material(metals);
    choose_admixtures(metals);
    choose_floor(metals);
    choose_optics();
    read_contact_tables(metals);
  }

  static std::vector<std::string> names_of(std::map<std::string, Material> const& metals) {
    std::vector<std::string> names;
    for (auto const& [name, metal] : metals) names.push_back(name);
    return names;
  }

  void choose_admixtures(std::map<std::string, Material> const& metals) {
    std::vector<std::string> const names = names_of(metals);
    for (auto const& [name, share] : case_.powder.mixture) {
      if (name == case_.powder.material) continue;
      if (auto const metal = metals.find(name); metal != metals.end()) {
        case_.admixtures.push_back(metal->second);
      } else {
        report(
            place_of("powder.mixture." + name),
            fmt::format("[powder.mixture] names \"{}\", which is not known (known: {}; [material.{}] may define it){}",
                        name, fmt::join(names, ", "), name, did_you_mean(name, names)));
        unsound_.insert("powder.mixture");
      }
    }
  }

  /// [contact.A] and [contact.A.B], where A and B are metals or "wall".
  void read_contact_tables(std::map<std::string, Material> const& metals) {
    std::vector<std::string> names = names_of(metals);
    names.push_back(walls_name);
    for (auto const& [table, place] : tables_) {
      if (!table.starts_with("contact.")) continue;
      std::string const rest = table.substr(8);
      std::size_t const dot = rest.find('.');
      bool const is_pair = dot != std::string::npos;
      std::vector<std::string> bodies{rest.substr(0, dot)};
      if (is_pair) bodies.push_back(rest.substr(dot + 1));
      if (report_unknown_body(table, place, bodies, names)) continue;
      if (is_pair && bodies[0] > bodies[1] && tables_.contains("contact." + bodies[1] + "." + bodies[0]))
        report(place, fmt::format("[{}] is given twice (as [contact.{}.{}]; the order does not matter) join them",
                                  table, bodies[1], bodies[0]));
      for (CaseKey const& row : is_pair ? pair_rows(bodies[0], bodies[1]) : body_rows(bodies[0]))
        fill(row, table, case_);
    }
  }

  bool report_unknown_body(std::string const& table, Place const& place, std::vector<std::string> const& bodies,
                           std::vector<std::string> const& names) {
    for (std::string const& body : bodies) {
      if (std::ranges::find(names, body) != names.end()) continue;
      report(place, fmt::format("[{}] names \"{}\", which is not known (known: {}){}", table, body,
                                fmt::join(names, ", "), did_you_mean(body, names)));
      return true;
    }
    if (bodies.size() < 2 || bodies[0] != walls_name || bodies[1] != walls_name) return false;
    report(place, fmt::format("[{}] is a pair of walls (they do not touch one another) name a material", table));
    return true;
  }

  void choose_material(std::map<std::string, Material> const& metals) {
    std::string const& chosen = case_.powder.material;
    if (auto const metal = metals.find(chosen); metal != metals.end()) {
      case_.material = metal->second;
    } else {
      std::vector<std::string> const names = names_of(metals);
      if (!chosen.empty()) {
        report(place_of("powder.material"),
               fmt::format("powder.material = \"{}\" is not known (known: {}; [material.{}] may define it){}", chosen,
                           fmt::join(names, ", "), chosen, did_you_mean(chosen, names)));
      }
      for (std::string const& key : keys_of("material")) unsound_.insert("material." + key);
    }
    if (auto const& index = case_.optics.refractive_index)
      case_.material.refractive_index = {index->at(0), index->at(1)};
  }

  void choose_floor(std::map<std::string, Material> const& metals) {
    std::string const& floor = case_.optics.floor;
    if (floor.empty() || floor == "black" || floor == "none") return;
    if (auto const metal = metals.find(floor); metal != metals.end()) {
      case_.floor_material = metal->second;
      return;
    }
    std::vector<std::string> names = names_of(metals);
    names.insert(names.end(), {"black", "none"});
    report(place_of("optics.floor"), fmt::format("optics.floor = \"{}\" is not known (known: {}){}", floor,
                                                 fmt::join(names, ", "), did_you_mean(floor, names)));
  }

  /// Indices at the laser's wavelength, where none is given by hand.
  void choose_optics() {
    std::vector<Material*> metals{&case_.material};
    for (Material& metal : case_.admixtures) metals.push_back(&metal);
    if (case_.floor_material) metals.push_back(&*case_.floor_material);
    if (!case_.has_light() || case_.laser.absorptivity || case_.optics.grey_reflectance) return;
    for (Material* metal : metals) choose_index(*metal);
  }

  void choose_index(Material& metal) {
    double const wavelength = case_.laser.wavelength;
    if (metal.optical_data.empty() || !(wavelength > 0)) return;
    bool const known = has_optical_data(metal.optical_data);
    bool const by_hand = metal.refractive_index != 0.0 || (&metal == &case_.material && case_.optics.refractive_index);
    try {
      std::complex<double> const index = optical_data(metal.optical_data)(wavelength);
      if (by_hand && metal.refractive_index != index) metal.optical_data.clear();
      if (!by_hand) metal.refractive_index = index;
    } catch (InputError const& fault) {
      if (by_hand) return metal.optical_data.clear();
      report(place_of(known ? "laser.wavelength" : "material.optical_data"),
             fmt::format("{}: {}", metal.name, fault.what()));
      unsound_.insert("material.refractive_index");
    }
  }

  /// What a misspelt preset or frozen zone would have supplied is not asked for.
  bool needed(CaseKey const& row) const {
    bool const of_laser = row.need == Need::with_laser || row.need == Need::with_light || row.need == Need::with_spot;
    bool const laser_unclear = of_laser && unsound_.contains("machine.frozen_zone");
    return is_needed(row, case_) && !laser_unclear && !unsound_.contains("case.preset");
  }

  void report_missing() {
    std::map<std::string, std::vector<std::string>> of_absent_table;
    for (auto const& [row, table] : absent_) {
      unsound_.insert(name_of(*row));
      if (!needed(*row) || meant_tables_.contains(table) || meant_keys_.contains(table + "." + row->key)) continue;
      if (!tables_.contains(table)) {
        of_absent_table[table].push_back(row->key);
        continue;
      }
      std::string const unit(si_unit(row->dimension));
      report(tables_.at(table), fmt::format("missing key \"{}\" in [{}] ({}{})", row->key, table, row->sentence,
                                            unit.empty() ? "" : " [" + unit + "]"));
    }
    for (auto const& [table, keys] : of_absent_table) {
      report({}, fmt::format("missing table [{}] (it must hold {})", table, fmt::join(keys, ", ")));
    }
  }

  struct Absent {
    CaseKey const* row;
    std::string table;
  };

  std::map<std::string, TomlEntry> written_;  // by "table.key"
  std::map<std::string, Place> tables_;
  Case case_;
  std::vector<Fault> faults_;
  std::set<std::string> unsound_;  // names of rows whose value must not be used in a check
  std::vector<Absent> absent_;
  std::set<std::string> meant_keys_, meant_tables_;  // misspelt, so not missing as well
};

/// Largest edge up to 5 um that divides the deposition zone along x and y, both in whole nanometres.
double common_cell(MachineSettings const& machine, std::filesystem::path const& path) {
  constexpr double nanometre = 1e-9;
  constexpr std::int64_t largest = 5000, smallest = 1000;
  std::int64_t const common =
      std::gcd(std::llround(machine.width / nanometre), std::llround(machine.deposition_length / nanometre));
  for (std::int64_t cell = largest; cell >= smallest; --cell) {
    if (common % cell == 0) return static_cast<double>(cell) * nanometre;
  }
  throw InputError(
      fmt::format("{}:1:1: missing key \"cell_size\" in [heat] (no edge from 1 to 5 um divides machine.width and "
                  "machine.deposition_length) round these lengths, or give it",
                  path.string()));
}

}  // namespace

Case read_case(std::filesystem::path const& path, std::vector<std::string> const& overrides,
               std::optional<Process> process) {
  if (!std::filesystem::is_regular_file(path)) {
    throw FileError(fmt::format("cannot read the case {} (not a file)", path.string()));
  }
  return case_of_text(read_file(path), path, overrides, process);
}

Case case_of_text(std::string const& text, std::filesystem::path const& path, std::vector<std::string> const& overrides,
                  std::optional<Process> process) {
  std::vector<Fault> syntax;
  TomlContent content;
  try {
    content = parse_toml(text);
  } catch (SyntaxFault const& fault) {
    syntax.push_back(fault.fault);
  }
  std::vector<TomlEntry> set;
  for (std::string const& option : overrides) {
    try {
      set.push_back(parse_override(option));
    } catch (SyntaxFault const& fault) {
      syntax.push_back(fault.fault);
    }
  }
  if (!syntax.empty()) throw_faults(syntax, path.string());
  CaseReader reader(std::move(content), std::move(set));
  Case result = reader.read(process);
  if (!reader.faults().empty()) throw_faults(reader.faults(), path.string());
  if (result.heat.cell_size == 0 && result.has_machine()) result.heat.cell_size = common_cell(result.machine, path);
  for (std::string* file : {&result.machine.substrate, &result.powder.bed, &result.laser.profile_file,
                            &result.scan.path}) {  // seen from the case
    if (!file->empty()) *file = (std::filesystem::absolute(path).parent_path() / *file).lexically_normal().string();
  }
  return result;
}

}  // namespace layerloop
