//===- Values.cpp - the members of a world's objects ----------------------===//
#include "Numbers.h"
#include "World.h"

#include <cmath>
#include <cstring>

namespace rtsl::random {

using runtime::ClassInfo;
using runtime::MemberInfo;
using runtime::ValueType;

std::uint32_t someFloat(std::uint32_t key) {
  static const std::uint32_t extremes[] = {0x7f800000u, 0xff800000u, 0x7fc00000u, 0x80000000u, 1u,
                                           0x00800000u, 0x7f7fffffu, 0x4b000001u, 0xcf000000u, 0u};
  if (key % 16 == 0)
    return extremes[(key >> 8) % 10];
  const float small = static_cast<float>(static_cast<std::int32_t>(key) >> 16);
  return bitsOf(small / static_cast<float>(1 << (key & 15)));
}

static std::uint32_t someInteger(std::uint32_t key) {
  static const std::uint32_t extremes[] = {0x80000000u, 0x7fffffffu, 0xffffffffu, 32u, 0u};
  if (key % 12 == 0)
    return extremes[(key >> 8) % 5];
  return (key >> 8) % 9 - (key & 1 ? 4u : 0u);
}

/// A number of a range of the generator, often one of its bounds.
static double someInside(const Range &range, std::uint32_t key) {
  const double low = std::isfinite(range.low)    ? range.low
                     : std::isfinite(range.high) ? range.high - 2
                                                 : 0,
               high = std::isfinite(range.high) ? range.high : low + 2;
  for (const double value : {key & 1 ? low : high, key & 2 ? high : low})
    if (range.contains(value))
      return value;
  const double middle = 0.5 * (low + high);
  return std::floor(middle) > low ? std::floor(middle) : middle; // a whole one for integers
}

void World::fillElement(const ValueType &type, const std::optional<Range> &range, std::uint8_t *to,
                        std::uint32_t key) {
  auto put = [&](unsigned word, std::uint32_t value) { std::memcpy(to + 4 * word, &value, 4); };
  const unsigned scalars = type.rows * type.columns;
  auto putFloat = [&](unsigned i) {
    const std::uint32_t bits = someFloat(mix(key, i));
    float value;
    std::memcpy(&value, &bits, 4);
    put(i, range && !range->contains(value) ? bitsOf(float(someInside(*range, bits))) : bits);
  };
  switch (type.kind) {
  case ValueType::Kind::Float:
    for (unsigned i = 0; i != scalars; ++i)
      putFloat(i);
    break;
  case ValueType::Kind::Color:
    for (unsigned i = 0; i != code.colorComponents; ++i)
      putFloat(i);
    break;
  case ValueType::Kind::Int:
  case ValueType::Kind::UInt:
    for (unsigned i = 0; i != scalars; ++i) {
      const std::uint32_t word = someInteger(mix(key, i));
      const double value =
          type.kind == ValueType::Kind::Int ? double(std::int32_t(word)) : double(word);
      put(i, range && !range->contains(value)
                 ? std::uint32_t(std::int32_t(someInside(*range, word)))
                 : word);
    }
    break;
  case ValueType::Kind::Bool:
    for (unsigned i = 0; i != scalars; ++i)
      put(i, mix(key, i) & 1);
    break;
  case ValueType::Kind::Reference:
    put(0, choose(type.className, key));
    break;
  case ValueType::Kind::Struct:
    for (const MemberInfo &field : type.fields)
      fill(field, to + field.offset, mix(key, hashOf(field.name)));
    break;
  }
}

void World::fill(const MemberInfo &member, std::uint8_t *to, std::uint32_t key) {
  const ValueType &type = member.type;
  if (type.bufferRank != 0) {
    RtslBuffer buffer{};
    std::size_t count = 1;
    // Where an index out of range ends the sample, few are empty, or hardly any ray would be sent.
    const bool isFilled =
        program.inRange || !mayBeEmpty || (program.raises && (key >> 12 & 3) != 0);
    for (unsigned i = 0; i != type.bufferRank; ++i) {
      buffer.size[i] = (key >> 4 * i) % 3 + (isFilled ? 1 : 0);
      count *= buffer.size[i];
    }
    buffers.emplace_back(count * type.elementSize / 4 + 1);
    if (type.isOutput)
      outputs.push_back(&buffers.back());
    auto *elements = reinterpret_cast<std::uint8_t *>(buffers.back().data());
    for (std::size_t i = 0; i != count; ++i)
      fillElement(type, member.values, elements + i * type.elementSize,
                  mix(key, static_cast<std::uint32_t>(i)));
    const auto address = reinterpret_cast<std::uint64_t>(elements);
    buffer.addressLow = static_cast<std::uint32_t>(address);
    buffer.addressHigh = static_cast<std::uint32_t>(address >> 32);
    std::memcpy(to, &buffer, sizeof buffer);
    return;
  }
  std::uint32_t count = 1;
  for (std::uint32_t size : type.arraySizes)
    count *= size;
  for (std::uint32_t i = 0; i != count; ++i)
    fillElement(type, member.values, to + i * (type.size / count), mix(key, i));
}

bool World::derivesFrom(const ClassInfo &info, const std::string &base) const {
  for (const ClassInfo *at = &info; at; at = code.find(at->base))
    if (at->name == base || at->root == base)
      return true;
  return false;
}

RtslRef World::choose(const std::string &className, std::uint32_t key) const {
  std::vector<RtslRef> candidates;
  for (const Object &object : objects)
    if (derivesFrom(*object.info, className))
      candidates.push_back(object.reference);
  return candidates.empty() ? 0 : candidates[key % candidates.size()];
}

} // namespace rtsl::random
