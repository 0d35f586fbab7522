#include "codegen/cpp/cleanup/CleanUp.h"

#include "codegen/cpp/cleanup/Braces.h"
#include "codegen/cpp/cleanup/ConditionalAssignments.h"
#include "codegen/cpp/cleanup/CountedLoops.h"
#include "codegen/cpp/cleanup/FieldAssignments.h"
#include "codegen/cpp/cleanup/FlagConditions.h"
#include "codegen/cpp/cleanup/JoinDeclarations.h"
#include "codegen/cpp/cleanup/OverwrittenZeros.h"

namespace rtsl::cpp {

namespace {
/// A function body while it is cleaned up. Its statements stay in place, so that rewrites of a
/// block can count uses in all of it.
struct Body {
  Statements &statements;
  const std::string &frame;

  void cleanUp(Statements &block);
};
} // namespace

void Body::cleanUp(Statements &block) {
  for (std::size_t at = 0; at < block.size(); ++at) {
    cleanUp(block[at].body);
    cleanUp(block[at].otherwise);
    for (Arm &arm : block[at].arms)
      cleanUp(arm.body);
    setBraces(block[at]);
    removeOverwrittenZero(block, at);
    joinFieldAssignments(block, at);
    inlineFlag(block, at, statements, frame);
    joinConditionalAssignments(block, at, statements);
    joinFlagUpdate(block, at);
    makeCountedLoop(block, at, statements);
  }
  joinDeclarations(block);
}

void cleanUp(Statements &body, const std::string &frame) {
  Body{body, frame}.cleanUp(body);
}

} // namespace rtsl::cpp
