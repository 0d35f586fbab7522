//===- ErrorMessages.h - the messages of the runtime as functions ---------===//
//
//   throw Error(message::unknownKey(what, key), value.place());
//
//===----------------------------------------------------------------------===//
#pragma once

#include "support/Articles.h"
#include "support/Error.h"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace rtsl::message {

// The compiler checks that the arguments fit the text.
#define RTSL_MESSAGE(code, id, text)                                                               \
  template <typename... Arguments>                                                                 \
  Message id(Arguments &&...arguments) {                                                           \
    return {ErrorCode::code,                                                                       \
            withArticles(fmt::format(FMT_STRING(text), std::forward<Arguments>(arguments)...))};   \
  }
#include "support/ErrorMessages.def"
#include "support/SceneMessages.def"
#undef RTSL_MESSAGE

#define RTSL_MESSAGE(id, text)                                                                     \
  template <typename... Arguments>                                                                 \
  std::string id(Arguments &&...arguments) {                                                       \
    return withArticles(fmt::format(FMT_STRING(text), std::forward<Arguments>(arguments)...));     \
  }
#include "support/WarningMessages.def"

} // namespace rtsl::message
