//===- OutOfMemory.h - reporting that memory is exhausted -----------------===//
//
// It is no fault of the program, wherever it happens: in our code, in a thread of a library, or in
// code that was compiled without exceptions.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <exception>

namespace rtsl::tool {

/// Does an exception mean that memory, or threads, ran out?
bool isOutOfMemory(const std::exception &error);

/// Reports that on standard error.
void sayOutOfMemory(const char *program);

/// From now on the process reports it and ends with status 1 where memory runs out and no exception
/// can be caught.
void nameOutOfMemory(const char *program);

} // namespace rtsl::tool
