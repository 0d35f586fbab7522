//===- KnownLights.h - lights that are looked for before a surface is shaded -===//
//
// A step of a wavefront (Wavefront.h) that shades surfaces also sends rays to lights. The warps of
// a multiprocessor then run different parts of a large kernel, some shading and some in a
// traversal, and wait for instructions, which the cache cannot hold. So a kernel of its own looks
// for the lights first: it runs the same state, but stores only what was found, so that LLVM
// removes all but the rays and what they depend on. The kernel that shades takes the answers.
//
// While lights are looked for, `illuminate` returns false. A shader that asks other questions after
// another answer asks those when it is shaded: an answer is taken only if it belongs to the same
// question, bit by bit, and otherwise the light is looked for then. So pictures have the same bits
// with and without.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Vector.h"

/// Of functions that only programs call which know lights. Others have the code that they had
/// without them: it is optimised before this is known.
#define RTSL_WHERE_LIGHTS_ARE_KNOWN __attribute__((cold, noinline))

namespace rtsl::device {

/// So many questions of a state have a place for their answers.
constexpr uint32_t mostKnownLights = 4;
/// While lights are wanted, a state that has asked so often may be waiting for one: from then on it
/// gets answers.
constexpr uint32_t mostWantedLights = 64;

/// RtslState::lightPhase.
enum LightPhase : uint32_t {
  lightsNotKnown, // each is looked for when a shader asks
  lightsWanted,   // answers are stored, and the shader gets none
  lightsKnown     // answers are taken
};

/// Is anything of this file in use? A constant.
inline bool mayKnowLights() {
#ifdef RTSL_IN_PROGRAM
  return __builtin_expect(rtsl_knows_lights() != 0, 0);
#else
  return false;
#endif
}

/// Lights are looked for when the state's shader asks.
inline void knowNoLights(RtslState &state) {
  if (mayKnowLights())
    state.lightPhase = lightsNotKnown;
}

/// Does the state run for its rays to lights alone? It then counts nothing that it counts again.
inline bool wantsLights(const RtslState &state) {
  return mayKnowLights() && state.lightPhase == lightsWanted;
}

/// What `illuminate` looks for, as words. Whatever else the answer depends on is the same during a
/// state.
class LightQuestion {
public:
  /// None: there is no question, and so no answer.
  enum Kind : uint32_t { None, Light, Surface };
  static constexpr uint32_t size = 13;

  LightQuestion(Kind kind, Vec3 origin, Vec3 other, const uint32_t key[2]) {
    add(kind);
    add(key[0]);
    add(key[1]);
    add(origin);
    add(other);
  }
  void add(uint32_t word) { words[count++] = word; }
  void add(float number) { add(bitsOf(number)); }
  void add(Vec3 v) {
    add(v.x);
    add(v.y);
    add(v.z);
  }

  /// Calls visit(i, word i) for its words, unrolled.
  template <typename Visit>
  void forEachWord(Visit visit) const {
#ifdef __clang__
#pragma clang loop unroll(full)
#endif
    for (uint32_t i = 0; i < size; ++i)
      visit(i, words[i]);
  }

private:
  uint32_t words[size] = {}, count = 0;
};

/// The most words of an answer: of an EmittedLight.
constexpr uint32_t answerWords(uint32_t colorComponents) {
  return 5 + colorComponents;
}

/// Words of a slot.
constexpr uint32_t knownLightWords(uint32_t colorComponents) {
  return mostKnownLights * (LightQuestion::size + answerWords(colorComponents));
}

/// The answers to the questions of one slot: words that are `stride` apart, so that neighbouring
/// slots are next to each other.
class KnownLights {
public:
  explicit KnownLights(const RtslState &state)
      : first(state.lights), stride(state.lightStride),
        words(knownLightWords(rtsl_color_components(state.launch)) / mostKnownLights) {}

  /// The answers of a state that is about to run.
  static void begin(RtslState &state, LightPhase phase, uint32_t *first, uint32_t stride) {
    state.lights = first;
    state.lightStride = stride;
    state.lightCalls = 0;
    state.lightPhase = phase;
    if (phase != lightsWanted)
      return;
    const KnownLights lights(state);
    for (uint32_t call = 0; call < mostKnownLights; ++call)
      lights.word(call, 0) = LightQuestion::None; // the answers of an earlier state
  }

  bool isOf(uint32_t call, const LightQuestion &question) const {
    bool isSame = true;
    question.forEachWord([&](uint32_t i, uint32_t asked) { isSame &= word(call, i) == asked; });
    return isSame;
  }
  void storeQuestion(uint32_t call, const LightQuestion &question) const {
    question.forEachWord([&](uint32_t i, uint32_t asked) { word(call, i) = asked; });
  }
  /// The words of the answer in their order.
  uint32_t &answer(uint32_t call, uint32_t i) const { return word(call, LightQuestion::size + i); }

private:
  uint32_t &word(uint32_t call, uint32_t i) const {
    return first[uint64_t(call * words + i) * stride];
  }

  uint32_t *first, stride, words;
};

/// answer = search(), now or before. False while lights are wanted. forEachWord(answer, visit)
/// calls visit(i, pointer to word i) for the words of an answer.
template <typename Answer, typename Search, typename ForEachWord>
bool lookForLight(RtslState &state, const LightQuestion &question, Answer &answer, Search search,
                  ForEachWord forEachWord) {
  const KnownLights lights(state);
  const uint32_t call = state.lightPhase == lightsNotKnown ? mostKnownLights : state.lightCalls++;
  const bool hasPlace = call < mostKnownLights;
  if (state.lightPhase == lightsWanted && call < mostWantedLights) {
    if (hasPlace) {
      answer = search();
      lights.storeQuestion(call, question);
      forEachWord(answer, [&](uint32_t i, const void *word) {
        __builtin_memcpy(&lights.answer(call, i), word, sizeof(uint32_t));
      });
    }
    return false;
  }
  if (!hasPlace || !lights.isOf(call, question)) {
    answer = search();
    return true;
  }
  forEachWord(answer, [&](uint32_t i, void *word) {
    __builtin_memcpy(word, &lights.answer(call, i), sizeof(uint32_t));
  });
  return true;
}

} // namespace rtsl::device
