//===- CodeCache.h - code of earlier programs -----------------------------===//
//
// Frames of a sequence, and pictures that are rendered again after a change, often have the same
// code, or parts of it: what moves is in tables that the code reads. So machine code and PTX are
// kept by the module that they were made of, from one program to the next, and in files from one
// run to the next.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace rtsl {

class CodeFiles;

/// May be used by several threads at once.
class CodeCache {
public:
  /// `files`: of earlier runs, or null.
  explicit CodeCache(std::unique_ptr<const CodeFiles> files);
  ~CodeCache();

  /// A new program begins: forgets code that the programs of the previous picture did not use.
  void beginProgram();

  /// What is made of a module, as bytes; `identity` names the module with all that decides what
  /// that is. Calls `make` if it is not known.
  std::string codeOf(const std::string &identity, const std::function<std::string()> &make);

  /// How many modules of the program were found because an earlier program of this run had them.
  std::uint64_t reused() const;

  /// How many were found in files.
  std::uint64_t read() const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> self;
};

} // namespace rtsl
