//===- Print.h - print -----------------------------------------------------===//
#pragma once

#include "rtsl/shader/Describe.h"
#include "runtime/program/PrintLog.h"

namespace rtsl {
inline namespace RTSL_VARIANT {

namespace detail {

inline void appendItem(runtime::PrintFormat &format, std::vector<std::uint32_t> &,
                       const char *text) {
  format.push_back({text});
}
template <typename T>
inline void appendItem(runtime::PrintFormat &format, std::vector<std::uint32_t> &words,
                       const T &value) {
  const StoredAs<T> stored(value);
  const runtime::ValueType type = valueType<StoredAs<T>>();
  constexpr std::size_t count = sizeof stored / 4;
  words.resize(words.size() + count);
  std::memcpy(words.data() + (words.size() - count), &stored, 4 * count);
  format.push_back({type.name, type.kind, static_cast<std::uint32_t>(count)});
}
template <int N>
inline void appendItem(runtime::PrintFormat &format, std::vector<std::uint32_t> &words,
                       const StateColor<N> &value) {
  appendItem(format, words, static_cast<const Color<N> &>(value));
}

} // namespace detail

/// A line of texts and values, shown after the image (runtime::takePrintLog).
template <int N, typename... Item>
inline void print(State<N> &rt, const Item &...items) {
  runtime::PrintFormat format;
  std::vector<std::uint32_t> words;
  (detail::appendItem(format, words, items), ...);
  runtime::print(rawState(rt), format, words);
}

} // namespace RTSL_VARIANT
} // namespace rtsl
