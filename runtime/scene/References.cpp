#include "runtime/scene/References.h"

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
  std::size_t count = 1, size = type.size;
  if (type.bufferRank != 0) {
    RtslBuffer buffer;
    std::memcpy(&buffer, bytes, sizeof buffer);
    for (std::uint8_t i = 0; i < type.bufferRank; ++i)
      count *= buffer.size[i];
    const std::uint64_t address = std::uint64_t(buffer.addressHigh) << 32 | buffer.addressLow;
    bytes = reinterpret_cast<const std::uint8_t *>(address);
    size = count * type.elementSize;
  }
  for (std::uint32_t length : type.arraySizes)
    count *= length;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t *element = bytes + i * (size / count);
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
