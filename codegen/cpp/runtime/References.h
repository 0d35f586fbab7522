//===- References.h - types of references, and calls through them ---------===//
//
//   struct TextureRef : rtsl::Reference {
//     Color lookup(State &rt) const;
//   };
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/Context.h"
#include "codegen/cpp/tree/Declaration.h"

namespace rtsl::cpp {

class References {
public:
  explicit References(Context &context);

  /// The types that `context.required` has.
  Declarations types();
  /// The methods of these types, which call those of the object's class.
  Declarations methods();

private:
  Function prototype(const ThroughReference &through);
  Statements lookUp(const std::string &className, bool isColor);
  Statements callMethod(const std::string &className, const typed::Function &function);

  Context &context;
  const bool mayReferToNothing; // some reference
  const bool lookupsNest;       // some texture looks up another
};

} // namespace rtsl::cpp
