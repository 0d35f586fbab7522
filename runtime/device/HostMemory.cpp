//===- HostMemory.cpp - memory functions for code without a C library -----===//
//
// Code generation inserts calls of these. They are linked into the host machine code of a package,
// which has no external references; in a process that compiles, the C library's are used. The
// compiler recognises these names and does not turn a loop into a call of the function itself.
//
//===----------------------------------------------------------------------===//
#include <stddef.h>

extern "C" {

void *memcpy(void *to, const void *from, size_t size) {
  for (size_t i = 0; i < size; ++i)
    static_cast<char *>(to)[i] = static_cast<const char *>(from)[i];
  return to;
}

void *memset(void *to, int value, size_t size) {
  for (size_t i = 0; i < size; ++i)
    static_cast<char *>(to)[i] = char(value);
  return to;
}

void *memmove(void *to, const void *from, size_t size) {
  if (to <= from)
    return memcpy(to, from, size);
  for (size_t i = size; i > 0; --i)
    static_cast<char *>(to)[i - 1] = static_cast<const char *>(from)[i - 1];
  return to;
}

} // extern "C"
