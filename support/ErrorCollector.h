//===- ErrorCollector.h - all errors of an input, in one run --------------===//
//
//   ErrorCollector errors;
//   for (const Part &part : parts)
//     errors.attempt([&] { read(part); });
//   errors.throwIfAny();
//
//===----------------------------------------------------------------------===//
#pragma once

#include "support/Error.h"

#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

namespace rtsl {

/// Lets a reader continue after an error in its input. Other errors (memory, cancellation, internal
/// ones) are passed on at once.
class ErrorCollector {
public:
  /// More errors are not useful: the reader stops.
  static constexpr std::size_t limit = 100;

  /// Gives whether there was no error.
  template <typename Step>
  bool attempt(Step &&step) {
    try {
      std::forward<Step>(step)();
      return true;
    } catch (const Error &error) { // not moved: it may be thrown again, for another part
      if (!isOfInput(error.code))
        throw;
      add(error);
      return false;
    }
  }

  /// Keeps an error and those that it carries, unless it has the same one: several parts of an
  /// input may need what is missing. Throws when there are `limit`.
  void add(Error error) {
    std::vector<Error> further = std::move(error.further);
    error.further.clear();
    keep(std::move(error));
    for (Error &one : further)
      keep(std::move(one));
    if (errors.size() >= limit)
      throwIfAny();
  }

  std::size_t count() const { return errors.size(); }

  /// The first error, which carries the others.
  void throwIfAny() {
    if (errors.empty())
      return;
    Error first = std::move(errors.front());
    errors.erase(errors.begin());
    first.further = std::move(errors);
    throw first;
  }

private:
  static bool isOfInput(ErrorCode code) {
    return code != ErrorCode::OutOfMemory && code != ErrorCode::Cancelled &&
           code != ErrorCode::Internal;
  }

  static bool isSame(const Error &a, const Error &b) {
    return a.code == b.code && a.place == b.place && std::string_view(a.what()) == b.what();
  }

  void keep(Error error) {
    for (const Error &other : errors)
      if (isSame(other, error))
        return;
    errors.push_back(std::move(error));
  }

  std::vector<Error> errors;
};

} // namespace rtsl
