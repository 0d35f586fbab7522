//===- Shared.cpp - what both targets share -------------------------------===//
#include "Target.h"

#include <cstdio>
#include <cstdlib>

void rtsl::fuzz::require(bool holds, const char *what) {
  if (holds)
    return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

/// LLVM's allocators mark their memory themselves, in headers: the part of them that lies in
/// Debian's library was built without a sanitizer and would never clear the marks again.
extern "C" const char *__asan_default_options() {
  return "allow_user_poisoning=0";
}
