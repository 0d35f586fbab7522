#include "runtime/scene/References.h"

#include "runtime/scene/Elements.h"

#include <algorithm>
#include <cstring>

namespace rtsl::runtime {

bool holdsReferences(const ValueType &type) {
  return type.kind == ValueType::Kind::Reference ||
         std::any_of(type.fields.begin(), type.fields.end(),
                     [](const MemberInfo &field) { return holdsReferences(field.type); });
}

void forEachReference(const ValueType &type, const std::uint8_t *bytes,
                      const std::function<void(RtslRef)> &visit) {
  if (type.kind != ValueType::Kind::Reference && type.kind != ValueType::Kind::Struct)
    return;
  const Elements elements = elementsOf(type, bytes);
  for (std::size_t i = 0; i < elements.count; ++i) {
    const std::uint8_t *element = elements[i];
    if (type.kind == ValueType::Kind::Reference) {
      RtslRef reference;
      std::memcpy(&reference, element, sizeof reference);
      if (reference != 0)
        visit(reference);
      continue;
    }
    for (const MemberInfo &field : type.fields)
      forEachReference(field.type, element + field.offset, visit);
  }
}

} // namespace rtsl::runtime
