//===- Lvalues.h - variables, members, elements, parts of vectors --------===//
#pragma once

#include "codegen/cpp/functions/FunctionPart.h"

#include <optional>

namespace rtsl::cpp {

class Lvalues : FunctionPart {
public:
  using FunctionPart::FunctionPart;

  /// `storeIndices`: indices go into variables, for the lvalue is evaluated later, or twice.
  Code of(const typed::Expr &expr, bool storeIndices = false);
  Code element(const typed::IndexExpr &expr, const Code &base, bool storeIndices);
  Code length(const typed::LengthExpr &expr);
  /// Can the expression stand in the text more than once, at no cost?
  bool isSimple(const typed::Expr &expr) const;
  /// The components of a vector that an lvalue stands for, and the vector; empty: not a part.
  std::vector<std::uint8_t> components(const typed::Expr &lvalue, const typed::Expr *&vector) const;
  /// The effects of evaluating the indices of an lvalue.
  typed::Effects indexEffects(const typed::Expr &lvalue);
  /// Can a C++ reference to its type refer to it? Not to several components of a vector, and not
  /// to a bool that lies in memory as 32 bits.
  bool canBind(const typed::Expr &lvalue) const;

  /// The index of an element, with a check if exceptions are on. The last one of `buffer[i][j]`.
  Code index(const typed::IndexExpr &expr, bool storeIndices = false);

private:
  /// Does an index out of range end the sample here?
  bool raises() const;
  /// With --exceptions: the index, which is reported to the state if it is out of range.
  Code checked(Code index, Code count) const;
  /// The number of elements that the index chooses from.
  Code countOf(const typed::IndexExpr &expr);
  Code bufferElement(const typed::IndexExpr &expr, bool storeIndices);
  Code lengthOf(const Code &buffer, std::optional<std::size_t> dimension);
};

} // namespace rtsl::cpp
