//===- Print.h - the text of the C++ tree ---------------------------------===//
//
// The only place with the syntax of C++. The text is clang-format's to lay out
// (codegen/cpp/Format.h), so white space matters only where a comment or a directive ends a line.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/tree/Declaration.h"

namespace rtsl::cpp {

/// The text of an expression, in parentheses if it binds less tightly than `atLeast`.
std::string print(const Code &code, Binding atLeast = Binding::Comma);
std::string print(const std::vector<Code> &codes); // a, b, c
std::string print(const Statement &statement);
std::string print(const Statements &statements);
std::string print(const Declaration &declaration);
std::string print(const Declarations &declarations);
/// `#line 7 "file"`, and the end of the line.
std::string print(const SourcePlace &place);
/// Adds a comment to the end of the last line; its further lines begin in the same column, so that
/// clang-format does not take them for comments of what follows.
void addComment(std::string &text, const std::string &comment);
/// `name = value`, `name{...}` or `name(...)`, in a declaration of this type.
std::string print(const Declarator &declarator, const std::string &type);

} // namespace rtsl::cpp
