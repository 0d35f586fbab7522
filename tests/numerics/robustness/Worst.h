//===- Worst.h - keeps the worst of many cases ----------------------------===//
#pragma once

#include "Row.h"

#include <limits>

namespace rtsl::numerics {

class Worst {
public:
  /// One case with its error; `describe` gives a text and is only called for a new worst one.
  template <typename Describe>
  void add(double error, Describe describe) {
    ++result.cases;
    if (error > result.worst) {
      result.worst = error;
      result.where = describe();
    }
  }
  /// A case that is right or wrong: the error is the number of wrong ones.
  template <typename Describe>
  void count(bool isWrong, Describe describe) {
    ++result.cases;
    if (isWrong && result.worst++ == 0)
      result.where = describe();
  }
  /// An answer that no bound excuses.
  void wrong(const std::string &where) {
    add(std::numeric_limits<double>::infinity(), [&] { return where; });
  }

  Outcome outcome() const { return result; }

private:
  Outcome result;
};

} // namespace rtsl::numerics
