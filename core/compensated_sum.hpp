#pragma once
#include <cmath>

namespace layerloop {

/// Neumaier's compensated sum: error of one rounding whatever the number of terms (ZAMM 54 (1974) 39).
class CompensatedSum {
 public:
  void add(double term) {
    double const sum = sum_ + term;
    lost_ += std::abs(sum_) >= std::abs(term) ? (sum_ - sum) + term : (term - sum) + sum_;
    sum_ = sum;
  }
  double value() const { return sum_ + lost_; }

 private:
  double sum_ = 0;
  double lost_ = 0;
};

}  // namespace layerloop
