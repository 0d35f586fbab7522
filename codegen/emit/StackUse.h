//===- StackUse.h - how much stack machine code takes ----------------------===//
//
// The code generator says how large each function's frame is; who calls whom stands in the LLVM IR
// that it was made of. Shaders recurse by `trace`, once for each ray that another one sends, and by
// methods that call themselves on what their members refer to: both have a limit, so the stack has
// one.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstdint>
#include <memory>

namespace llvm {
class Module;
} // namespace llvm

namespace rtsl::codegen {

class StackUse {
public:
  /// Notes the calls in a module that is about to become machine code, and frames as they are laid
  /// out. This object must live until the code is made.
  explicit StackUse(llvm::Module &module);
  StackUse(StackUse &&) noexcept;
  ~StackUse();

  /// Adds what another module of the same program has. Functions of one name are copies of one
  /// another.
  void add(const StackUse &other);

  /// Bytes of stack that functions of the module take at most, their callees in it included, where
  /// so many rays are under way and objects refer to one another in chains of `referenceChain`.
  std::uint64_t bytes(std::uint64_t rays, std::uint64_t referenceChain) const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> self;
};

} // namespace rtsl::codegen
