//===- IntRanges.h - the values that an int can have ---------------------===//
#pragma once

#include "codegen/cpp/functions/FunctionPart.h"

#include <optional>

namespace rtsl::cpp {

/// Values that an int can have, ends included.
struct Interval {
  std::int64_t low = 0, high = 0;
};

class IntRanges : FunctionPart {
public:
  using FunctionPart::FunctionPart;

  /// Nothing: any value, or the result may overflow.
  std::optional<Interval> range(const typed::Expr &expr);
  std::optional<Interval> range(ast::BinaryOp op, const typed::Expr &left,
                                const typed::Expr &right);
};

} // namespace rtsl::cpp
