#include "codegen/cpp/cleanup/JoinDeclarations.h"

#include <algorithm>

namespace rtsl::cpp {

void joinDeclarations(Statements &block) {
  for (std::size_t i = 0; i < block.size(); ++i) {
    if (!block[i].isOpen)
      continue;
    const auto open = block.begin() + static_cast<std::ptrdiff_t>(i);
    const std::string own = open->declarators.front().name;
    const auto first = std::find_if(open + 1, block.end(),
                                    [&](const Statement &one) { return mentions(one, own); });
    if (first != block.end() && assignedVariable(*first) != open->written.identity) {
      open->isOpen = false;
      continue;
    }
    if (first != block.end()) {
      Statement joined = declaration(open->type, own, assignedValue(*first));
      joined.comment = first->comment;
      joined.place = first->place;
      joined.hasSpace = first->hasSpace;
      joined.written = first->written;
      *first = std::move(joined);
    }
    block.erase(open);
    --i;
  }
}

} // namespace rtsl::cpp
