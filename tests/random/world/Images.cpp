//===- Images.cpp - small images in a world -------------------------------===//
#include "Numbers.h"
#include "World.h"

#include "runtime/scene/Samplers.h"

#include <cstring>

namespace rtsl::random {

using runtime::ClassInfo;
using runtime::MemberInfo;

static constexpr std::uint32_t imageCount = 3;

void World::addImages() {
  if (const ClassInfo *info = hasImages(program.seed) ? code.find("sampler2D") : nullptr)
    for (std::uint32_t i = 0; i != imageCount; ++i)
      addImage(*info, i);
}

/// The members that a scene gives an image, as bytes of a record.
void World::addImage(const ClassInfo &info, std::uint32_t number) {
  const std::uint32_t key = mix(program.seed, number);
  runtime::Texels texels;
  texels.format = number == 0 ? runtime::TexelFormat::Float32 : runtime::TexelFormat::Srgb8;
  texels.width = 1 + key % 9;
  texels.height = number == 2 ? 1 : 1 + key / 9 % 7;
  std::vector<std::uint32_t> bytes(std::size_t(4) * texels.width * texels.height);
  for (std::uint32_t i = 0; i != bytes.size(); ++i)
    bytes[i] = number == 0 ? bitsOf(static_cast<float>(mix(key, i) % 512) / 256) : mix(key, i);
  texels = runtime::texelsOfBytes(bytes.data(), std::move(texels));
  runtime::addLevels(texels);
  runtime::Sampling sampling;
  sampling.filter = static_cast<runtime::Filter>(3 - number);
  sampling.wrap[0] = static_cast<runtime::Wrap>(key / 64 % 4);
  sampling.wrap[1] = static_cast<runtime::Wrap>(key / 256 % 4);
  sampling.anisotropy = 1 + key / 1024 % 5;

  const auto reference = static_cast<RtslRef>(4 * used);
  used += (info.recordSize + 15) / 16 * 4;
  auto *record = reinterpret_cast<std::uint8_t *>(records.data()) + reference;
  std::memcpy(record, &info.id, 4);
  RtslState state{};
  state.launch = &launch;
  if (info.initialize)
    info.initialize(&state, reference);
  for (const auto &[name, value, place] :
       runtime::samplerValues(std::move(texels), sampling, false, false).members)
    for (const MemberInfo &member : info.members)
      if (member.name == name && value.words)
        putBuffer(record + member.offset, *value.words);
      else if (member.name == name) {
        const auto whole = static_cast<std::int32_t>(value.number);
        std::memcpy(record + member.offset, &whole, 4);
      }
  objects.push_back({reference, &info});
}

/// A buffer of one dimension with these elements.
void World::putBuffer(std::uint8_t *to, const runtime::Words &words) {
  buffers.emplace_back(words.data(), words.data() + words.size());
  RtslBuffer buffer{};
  buffer.size[0] = static_cast<std::uint32_t>(words.size());
  const auto address = reinterpret_cast<std::uint64_t>(buffers.back().data());
  buffer.addressLow = static_cast<std::uint32_t>(address);
  buffer.addressHigh = static_cast<std::uint32_t>(address >> 32);
  std::memcpy(to, &buffer, sizeof buffer);
}

std::size_t World::wordsOfImages() const {
  const ClassInfo *info = hasImages(program.seed) ? code.find("sampler2D") : nullptr;
  return info ? imageCount * ((info->recordSize + 15) / 16 * 4) : 0;
}

} // namespace rtsl::random
