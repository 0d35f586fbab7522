//===- CodeCache.h - machine code of earlier programs ---------------------===//
//
// Frames of a sequence, and pictures that are rendered again after a change, often have the same
// code, or parts of it: what moves is in tables that the code reads. So machine code is kept by the
// module that it was made of, from one program to the next, and in files from one run to the next.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace rtsl {

namespace codegen {
struct ObjectCode;
} // namespace codegen

class CodeFiles;

/// May be used by several threads at once.
class CodeCache {
public:
  /// `files`: of earlier runs, or null.
  explicit CodeCache(std::unique_ptr<const CodeFiles> files);
  ~CodeCache();

  /// A new program begins: forgets code that the programs of the previous picture did not use.
  void beginProgram();

  /// The code of a module, which `identity` names with all that decides what code it gets. Calls
  /// `make` if it is not known.
  codegen::ObjectCode codeOf(const std::string &identity,
                             const std::function<codegen::ObjectCode()> &make);

  /// How many modules of the program were found because an earlier program of this run had them.
  std::uint64_t reused() const;

  /// How many were found in files.
  std::uint64_t read() const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> self;
};

} // namespace rtsl
