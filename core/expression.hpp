#pragma once
#include <memory>
#include <string>
#include <vector>

namespace layerloop {

/// A formula of named numbers, "k*(1 + s*(T - 300)/1000)", with the operators and functions of muParser (+ - * / ^,
/// comparisons, a ? b : c, sin, exp, ln, sqrt, min, max ...). Not for several threads at a time.
class Expression {
 public:
  /// \throws InputError  it cannot be read, or names a variable that is not there
  Expression(std::string const& text, std::vector<std::string> const& variables);
  ~Expression();
  Expression(Expression&&) noexcept;

  /// \param values  in the order of the variables \throws InputError  the result is not finite
  double operator()(std::vector<double> const& values) const;

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace layerloop
