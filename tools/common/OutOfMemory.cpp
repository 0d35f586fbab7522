//===- OutOfMemory.cpp - reporting that memory is exhausted ---------------===//
#include "OutOfMemory.h"

#include "support/Error.h"

#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <unistd.h>

namespace rtsl::tool {

namespace {

const char *name = "";

/// Ends a process that an uncaught exception would abort.
[[noreturn]] void endOutOfMemory() {
  if (const std::exception_ptr current = std::current_exception())
    try {
      std::rethrow_exception(current);
    } catch (const std::exception &error) {
      if (isOutOfMemory(error)) {
        sayOutOfMemory(name);
        ::_exit(1);
      }
      std::fprintf(stderr, "%s: internal error: %s\n", name, error.what());
    } catch (...) {
    }
  std::abort();
}

} // namespace

bool isOutOfMemory(const std::exception &error) {
  if (dynamic_cast<const std::bad_alloc *>(&error) ||
      dynamic_cast<const std::length_error *>(&error))
    return true;
  if (const auto *ours = dynamic_cast<const Error *>(&error))
    return ours->code == ErrorCode::OutOfMemory;
  const auto *system = dynamic_cast<const std::system_error *>(&error);
  return system && (system->code() == std::errc::not_enough_memory ||
                    system->code() == std::errc::resource_unavailable_try_again);
}

void sayOutOfMemory(const char *program) {
  std::fprintf(stderr, "%s: not enough memory\n", program); // needs none
}

void nameOutOfMemory(const char *program) {
  name = program;
  std::set_terminate(endOutOfMemory);
}

} // namespace rtsl::tool
