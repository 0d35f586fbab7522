//===- Names.h - what the author's names are in C++ -----------------------===//
//
// A name stays as it is unless C++ gives it another meaning: a keyword, a macro, what generated
// code itself uses, or another thing of the author's that C++ would confuse with it. Then it gets
// an underscore after it, and a number after that if the result is taken.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "sema/typed/TypedAst.h"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace rtsl::cpp {

class Names {
public:
  explicit Names(const typed::Module &module);

  const std::string &
  of(const void *entity) const; // Variable, Member, Function, Struct, Class, Field
  /// The type of references to a class ("Checker", "rt_Texture"): `CheckerRef`, `TextureRef`.
  std::string reference(const std::string &className) const;

  /// What was renamed: the author's name, `Class.member` or `function.variable` where it is not at
  /// file level, and the name in C++. In the order of the source.
  const std::vector<std::pair<std::string, std::string>> &renamed() const { return changes; }

private:
  void nameFileLevel(const typed::Module &module);
  void nameClass(const typed::Class &definition);
  void nameLocals(const typed::Function &function);
  /// Sets of names that are not copied, for there may be thousands at file level.
  using Avoided = std::vector<const std::set<std::string> *>;
  void give(const void *entity, const std::string &name, const std::string &shown,
            const Avoided &avoided, const std::set<std::string> &all);

  std::map<const void *, std::string> names;
  std::map<std::string, std::string> references;
  std::vector<std::pair<std::string, std::string>> changes;
  std::set<std::string> fileLevel; // names in C++ of what stands at file level
  std::set<std::string> typeNames;
  std::set<std::string> memberNames; // of all classes, methods too
};

/// The name, or the name with a number after it, so that it is none of `taken` and `around`; it is
/// added to `taken`. Without two underscores in a row, which C++ keeps for itself.
std::string unique(std::string name, std::set<std::string> &taken,
                   const std::set<std::string> &around = {});

/// The class of include/rtsl/shader that an `rt_` base is, or that of none: `rt_Texture` is
/// rtsl::Texture.
std::string nameOfRoot(const std::string &root);

/// An identifier made of a file's name: "my-glass.cpp" gives "my_glass".
std::string identifierOf(const std::string &path);

/// Is the name C++'s own, a macro's, or one that generated code uses?
bool isReserved(const std::string &word);

} // namespace rtsl::cpp
