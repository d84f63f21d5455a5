#include "validation/blind/blind_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/write_file.hpp"
#include "coupling/report/html.hpp"
#include "coupling/report/page.hpp"
#include "coupling/report/svg_scatter.hpp"
#include "validation/blind/blind_test.hpp"

namespace layerloop::validation {
namespace {

using coupling::escape;
using nlohmann::json;

std::string percent(double share) { return std::isfinite(share) ? fmt::format("{:.1f} %", 100 * share) : "-"; }

std::string shown(Score const& score, double value) {
  return score.is_share ? percent(value) : std::isfinite(value) ? fmt::format("{:.3g}", value) : "-";
}

std::string interval_of(Score const& score) {
  return score.is_share ? fmt::format("{:.1f} to {:.1f} %", 100 * score.interval.low, 100 * score.interval.high) : "";
}

/// "yes": by the bound of the interval; "value": the value alone is beyond the minimum.
std::string passed(Score const& score) {
  if (score.n == 0) return "none drawn";
  if (std::isnan(score.minimum)) return "no bar";
  return score.passes_for_sure() ? "yes" : score.passes() ? "value only" : "no";
}

std::string verdict_words(Opened const& one) {
  std::string words = one.judgement.verdict;
  for (Judgement::Named const& named : one.judgement.named) {
    words += fmt::format(" {} {:.3g} +- {:.2g}", named.name, named.strength, named.u_strength);
    if (!named.group.empty()) words += fmt::format(" (or {})", fmt::join(named.group, ", "));
  }
  return words;
}

std::string score_table(std::vector<Score> const& scores) {
  std::string rows;
  for (Score const& s : scores)
    rows += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{} {}</td><td>{}</td><td>{}</td></tr>\n",
        s.name, escape(s.of), s.is_share ? fmt::format("{} of {}", s.hits, s.n) : fmt::format("{} scenarios", s.n),
        shown(s, s.value), interval_of(s), s.high_is_good ? "&ge;" : "&le;", shown(s, s.minimum), shown(s, s.target),
        passed(s));
  return "<div class=\"scroll\"><table>\n<tr><th>Score</th><th>Among</th><th>Count</th><th>Value</th><th>95 % "
         "interval</th>"
         "<th>To ship</th><th>Target</th><th>Passes by the bound</th></tr>\n" +
         rows + "</table></div>\n";
}

/// Shares that are compared between methods, one row a score.
std::string method_table(std::vector<Opened> const& all, std::vector<std::string> const& methods) {
  if (methods.empty()) return "";
  std::vector<std::vector<Score>> columns{scores_of(all)};
  for (std::size_t m = 0; m < methods.size(); ++m) columns.push_back(scores_of(all, m));
  std::string head = "<tr><th>Score</th><th>Among</th><th>this program</th>", rows;
  for (std::string const& method : methods) head += fmt::format("<th>{}</th>", method);
  for (std::size_t i = 0; i < columns[1].size(); ++i) {
    if (!columns[1][i].is_share) continue;
    rows += fmt::format("<tr><td>{}</td><td>{}</td>", columns[0][i].name, escape(columns[0][i].of));
    for (auto const& column : columns) rows += fmt::format("<td>{}</td>", percent(column[i].value));
    rows += "</tr>\n";
  }
  return "<div class=\"scroll\"><table>\n" + head + "</tr>\n" + rows + "</table></div>\n";
}

std::string curve_plot(std::vector<CurvePoint> const& curve, std::string const& x_label) {
  coupling::PointSeries series{.name = "named right", .x = {}, .y = {}};
  for (CurvePoint const& point : curve) {
    if (point.n == 0) continue;
    Interval const bounds = wilson(point.hits, point.n);
    series.x.push_back(0.5 * (point.from + point.to));
    series.y.push_back(50 * (bounds.low + bounds.high));  // the middle of the interval, so that the bar is the interval
    series.y_error.push_back(50 * (bounds.high - bounds.low));
    series.x_error.push_back(0.5 * (point.to - point.from));
    series.words.push_back(fmt::format("{} of {}", point.hits, point.n));
  }
  return coupling::scatter_plot(
      {.x_label = x_label, .y_label = "named right at once [%], 95 % interval", .series = {series}, .levels = {90}});
}

/// What was wrong, by score; a scenario may fail several.
std::string failure_table(std::vector<Opened> const& all, std::vector<Score> const& scores) {
  std::map<std::string, Opened const*> by_id;
  for (Opened const& one : all) by_id[one.answer.id] = &one;
  std::string rows;
  for (Score const& score : scores)
    for (std::string const& id : score.failures)
      rows +=
          fmt::format("<tr><td>{}</td><td>{}: {}</td><td>{}</td><td>{:.2f} {}</td><td>{}</td></tr>\n", id, score.name,
                      escape(score.of), escape(by_id.at(id)->answer.text), by_id.at(id)->answer.largest_cosine,
                      escape(by_id.at(id)->answer.nearest), escape(verdict_words(*by_id.at(id))));
  return "<div class=\"scroll\"><table>\n<tr><th>Scenario</th><th>Score</th><th>What was hidden</th><th>Nearest "
         "other</th>"
         "<th>What was said</th></tr>\n" +
         rows + "</table></div>\n";
}

std::string class_table(std::vector<Opened> const& all) {
  std::map<std::string, std::map<std::string, int>> counts;
  std::map<std::string, int> verdicts;
  for (Opened const& one : all)
    ++counts[letter_of(one.answer.kind)][one.judgement.verdict], ++verdicts[one.judgement.verdict];
  std::string head = "<tr><th>Class</th>", rows;
  for (auto const& [verdict, n] : verdicts) head += fmt::format("<th>{}</th>", verdict);
  for (auto const& [letter, row] : counts) {
    rows += fmt::format("<tr><td>{}</td>", letter);
    for (auto const& [verdict, n] : verdicts)
      rows += fmt::format("<td>{}</td>", row.contains(verdict) ? row.at(verdict) : 0);
    rows += "</tr>\n";
  }
  return "<div class=\"scroll\"><table>\n" + head + "</tr>\n" + rows +
         "</table></div>\n<p>a: one effect; c1: an effect that was taken off the list of candidates; c2: a cause that "
         "no "
         "catalogue holds; d: nothing; e: wrong calibration; f: two effects; g: an effect with a twin; h: bad noise; "
         "i: "
         "cells, offsets, scales; r: what real data carry.</p>\n";
}

std::string markdown_row(std::vector<std::string> const& cells) {
  return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

/// The same tables for documents.
std::string markdown(std::vector<Opened> const& all, std::vector<std::string> const& methods) {
  std::vector<Score> const scores = scores_of(all);
  std::string text =
      markdown_row({"score", "among", "count", "value", "95 % interval", "to ship", "target", "passes by the bound"}) +
      "|---|---|---|---|---|---|---|---|\n";
  for (Score const& s : scores)
    text += markdown_row({s.name, s.of, s.is_share ? fmt::format("{} of {}", s.hits, s.n) : fmt::format("{}", s.n),
                          shown(s, s.value), interval_of(s), (s.high_is_good ? ">= " : "<= ") + shown(s, s.minimum),
                          shown(s, s.target), passed(s)});
  if (!methods.empty()) {
    std::vector<std::string> head{"score", "among", "this program"};
    head.insert(head.end(), methods.begin(), methods.end());
    text += "\n" + markdown_row(head) + markdown_row(std::vector<std::string>(head.size(), "---"));
    std::vector<std::vector<Score>> columns;
    for (std::size_t m = 0; m < methods.size(); ++m) columns.push_back(scores_of(all, m));
    for (std::size_t i = 0; i < columns.front().size(); ++i) {
      if (!columns.front()[i].is_share) continue;
      std::vector<std::string> row{scores[i].name, scores[i].of, percent(scores[i].value)};
      for (auto const& column : columns) row.push_back(percent(column[i].value));
      text += markdown_row(row);
    }
  }
  text += "\n" + markdown_row({"failed", "score", "hidden", "nearest other", "said"}) + "|---|---|---|---|---|\n";
  std::map<std::string, Opened const*> by_id;
  for (Opened const& one : all) by_id[one.answer.id] = &one;
  for (Score const& score : scores)
    for (std::string const& id : score.failures)
      text += markdown_row({id, score.name, by_id[id]->answer.text,
                            fmt::format("{} {:.2f}", by_id[id]->answer.nearest, by_id[id]->answer.largest_cosine),
                            verdict_words(*by_id[id])});
  return text;
}

std::string csv_field(std::string const& text) { return "\"" + text + "\""; }

std::string scenarios_csv(std::vector<Opened> const& all) {
  std::string text =
      "id,class,hidden,lambda,largest_cosine,nearest,verdict,named,strength,u_strength,true_strength,sigma2,model_runs,"
      "rms_calibrated,rms_named,rms_smooth,whitened_rms_named\n";
  for (Opened const& one : all) {
    Answer const& a = one.answer;
    Judgement const& j = one.judgement;
    std::string names;
    for (auto const& named : j.named) names += (names.empty() ? "" : " + ") + named.name;
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", a.id, letter_of(a.kind),
                        csv_field(a.text), a.visibility(), a.largest_cosine, a.nearest, j.verdict, csv_field(names),
                        j.named.empty() ? NAN : j.named.front().strength,
                        j.named.empty() ? NAN : j.named.front().u_strength,
                        a.strengths.empty() ? NAN : a.strengths.front(), j.sigma2, j.passes, one.forecast.calibrated,
                        one.forecast.named, one.forecast.smooth, one.forecast.whitened);
  }
  return text;
}

std::string score_csv(std::vector<Score> const& scores) {
  std::string text = "score,among,hits,n,value,low,high,to_ship,target,passes\n";
  for (Score const& s : scores)
    text += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", csv_field(s.name), csv_field(s.of), s.hits, s.n, s.value,
                        s.is_share ? s.interval.low : NAN, s.is_share ? s.interval.high : NAN, s.minimum, s.target,
                        passed(s));
  return text;
}

json json_of(std::vector<Score> const& scores) {
  json list = json::array();
  for (Score const& s : scores)
    list.push_back({{"score", s.name},
                    {"among", s.of},
                    {"hits", s.hits},
                    {"n", s.n},
                    {"value", s.value},
                    {"ci95", {s.interval.low, s.interval.high}},
                    {"to_ship", s.minimum},
                    {"target", s.target},
                    {"passes", passed(s)},
                    {"failures", s.failures}});
  return list;
}

}  // namespace

std::string text_of(std::vector<Score> const& scores) {
  std::string text = fmt::format("{:42s} {:62s} {:>11s} {:>9s} {:>18s} {:>10s} {:>9s}  {}\n", "score", "among", "count",
                                 "value", "95 % interval", "to ship", "target", "passes");
  for (Score const& s : scores)
    text += fmt::format("{:42s} {:62s} {:>11s} {:>9s} {:>18s} {:>10s} {:>9s}  {}\n", s.name, s.of,
                        s.is_share ? fmt::format("{} of {}", s.hits, s.n) : fmt::format("{}", s.n), shown(s, s.value),
                        interval_of(s), (s.high_is_good ? ">= " : "<= ") + shown(s, s.minimum), shown(s, s.target),
                        passed(s));
  return text;
}

std::string write_blind_report(std::vector<std::filesystem::path> const& folders, std::filesystem::path const& out) {
  std::vector<Opened> all;
  std::set<std::string> worlds;
  std::vector<std::string> methods = other_methods(folders.front());
  for (std::filesystem::path const& folder : folders) {
    json const manifest = json::parse(read_file(folder / "manifest.json"));
    worlds.insert(manifest.at("world").get<std::string>());
    if (other_methods(folder) != methods) methods.clear();
    std::filesystem::path const set = folder.has_filename() ? folder.filename() : folder.parent_path().filename();
    for (Opened& one : opened_blind_test(folder)) {
      if (folders.size() > 1) one.answer.id = fmt::format("{} {}", set.string(), one.answer.id);
      all.push_back(std::move(one));
    }
  }
  std::vector<Score> const scores = scores_of(all);
  json const verdicts = json::parse(read_file(folders.front() / "verdicts.json"));
  json const manifest = json::parse(read_file(folders.front() / "manifest.json"));
  json summary{{"set", manifest.at("set")},
               {"scenarios", all.size()},
               {"thresholds", verdicts.at("thresholds")},
               {"thresholds_sha256", verdicts.at("thresholds_sha256")},
               {"scores", json_of(scores)}};
  for (std::size_t m = 0; m < methods.size(); ++m) summary["others"][methods[m]] = json_of(scores_of(all, m));
  std::filesystem::create_directories(out);
  write_file(out / "score.json", summary.dump(1) + "\n");
  write_file(out / "score.csv", score_csv(scores));
  write_file(out / "score.md", markdown(all, methods));
  write_file(out / "scenarios.csv", scenarios_csv(all));

  std::string const set = manifest.at("set"), hash = verdicts.at("thresholds_sha256");
  auto const missed = std::ranges::count_if(scores, [](Score const& s) { return !s.passes_for_sure(); });
  coupling::Page page{
      .title = "Blind test",
      .version = LAYERLOOP_VERSION,
      .headline = fmt::format("{} sealed scenarios of the {} set (world: {}): {} of {} scores pass by the "
                              "bound of their interval.",
                              all.size(), set, fmt::join(worlds, ", "),
                              static_cast<std::ptrdiff_t>(scores.size()) - missed, scores.size()),
      .cards = ""};
  page.files = "; scores in score.csv, every scenario in scenarios.csv";
  page.add("scores", "Scores", score_table(scores));
  page.add(
      "visibility", "Named right over visibility",
      curve_plot(named_over_visibility(all), "lambda: size of the effect in standard deviations, after calibration") +
          curve_plot(named_over_cosine(all), "largest cosine with another candidate (lambda >= 8)"));
  page.add("verdicts", "Verdicts by class", class_table(all));
  page.add("others", "Other methods on the same data", method_table(all, methods));
  page.add("failures", "Failures", failure_table(all, scores));
  page.add("thresholds", "Thresholds",
           fmt::format("<p>{}</p>\n<p>sha256 {}</p>\n", escape(std::string(verdicts.at("thresholds"))), hash));
  write_file(out / "report.html", page.html());
  return text_of(scores);
}

}  // namespace layerloop::validation
