//===- StackUse.h - the stack size of machine code ------------------------===//
//
// The code generator reports the size of each function's frame; the call graph is taken from the
// LLVM IR. Shaders recurse by `trace`, once for each ray that another one sends, and by methods
// that call themselves on objects that their members refer to: both have a limit, so the stack has
// one.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "llvm/ADT/StringRef.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace llvm {
class Module;
} // namespace llvm

namespace rtsl::codegen {

class StackUse {
public:
  /// Records the calls in a module that is about to be compiled, and the frames when they are laid
  /// out. This object must exist until the code is generated.
  explicit StackUse(llvm::Module &module);
  StackUse(StackUse &&) noexcept;
  /// A copy, for code that has been generated.
  StackUse(const StackUse &other);
  ~StackUse();

  /// Adds another module of the same program. Functions with the same name are copies.
  void add(const StackUse &other);

  /// A line for each function of the modules: its name, its frame or -1 if no module defines it,
  /// and the numbers of the lines of what it calls. Names have no spaces.
  std::string text() const;

  /// What `text` has written, up to an empty line; `text` is what follows. Nothing if it is
  /// something else.
  static std::optional<StackUse> fromText(llvm::StringRef &text);

  /// The most bytes of stack that functions of the module use, including their callees in it, with
  /// this number of rays in flight and objects that refer to one another in chains of
  /// `referenceChain`.
  std::uint64_t bytes(std::uint64_t rays, std::uint64_t referenceChain) const;

private:
  StackUse();

  struct Implementation;
  std::unique_ptr<Implementation> self;
};

} // namespace rtsl::codegen
