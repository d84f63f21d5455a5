#include "core/expression.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace layerloop {

struct Expression::Parser {
  std::string text;
  std::vector<std::string> names;
  std::vector<double> values;
  mu::Parser parser = {};
};

Expression::Expression(std::string const& text, std::vector<std::string> const& variables)
    : parser_(new Parser{text, variables, std::vector<double>(variables.size(), 0.0)}) {
  try {
    for (std::size_t v = 0; v < variables.size(); ++v) parser_->parser.DefineVar(variables[v], &parser_->values[v]);
    parser_->parser.SetExpr(text);
    for (auto const& [name, value] : parser_->parser.GetUsedVar())
      if (std::ranges::find(variables, name) == variables.end())
        throw InputError(fmt::format("\"{}\" names \"{}\" (known here: {})", text, name, fmt::join(variables, ", ")));
    parser_->parser.Eval();
  } catch (mu::ParserError const& error) {
    throw InputError(fmt::format("\"{}\" cannot be read as a formula ({})", text, error.GetMsg()));
  }
}
Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;

double Expression::operator()(std::vector<double> const& values) const {
  std::ranges::copy(values, parser_->values.begin());
  double const result = parser_->parser.Eval();
  if (std::isfinite(result)) return result;
  std::string at;
  for (std::size_t v = 0; v < values.size(); ++v) at += fmt::format(" {} = {:g}", parser_->names[v], values[v]);
  throw InputError(fmt::format("\"{}\" is not finite at{}", parser_->text, at));
}

}  // namespace layerloop
