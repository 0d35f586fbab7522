//===- OwnLibrary.h - parts that are loaded when they are needed ----------===//
#pragma once

#include <string>

namespace rtsl {

/// The address of `symbol` in our library `file`. The library is beside the library that this
/// function is in, or where the programs have theirs, and is never closed: libraries that it loads
/// start threads of their own. Null, with the reason in `why`, if it cannot be loaded.
void *findInOwnLibrary(const char *file, const char *symbol, std::string &why);

} // namespace rtsl
