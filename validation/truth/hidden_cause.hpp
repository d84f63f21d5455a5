#pragma once
#include <string>
#include <vector>

namespace layerloop::validation {

/// What the world does and the model may lack.
struct HiddenCause {
  std::string name;
  double strength = 0;
  double from = 0;          ///< of a jump: share of the conditions that come before it
  std::string label = {};   ///< of a biased input: the machine that it is of; empty: all
  bool other_form = false;  ///< not that of the catalogue, where the world knows both
};

/// A cause that no catalogue holds, and what a diagnosis may rightly say of it.
struct ForeignCause {
  std::string name;
  double largest;                       ///< strength
  std::vector<std::string> variables;   ///< one of which the pattern must run over
  std::vector<std::string> quantities;  ///< one of which it must be seen in
};

}  // namespace layerloop::validation
