//===- Costs.h - about how many instructions an operation takes -----------===//
//
// The one place with these numbers. A unit is one scalar instruction of a GPU. They decide what is
// recomputed after a trace instead of saved, and where both sides of a condition are computed
// instead of branching; a factor of two seldom changes a decision.
//
//===----------------------------------------------------------------------===//
#pragma once

namespace rtsl::cost {

// Arithmetic, for each component. IEEE division and square root are a short sequence and a rarely
// taken branch, so neither is computed in place of a branch; elementary functions are polynomials.
inline constexpr unsigned arithmetic = 1; // addition, comparison, selection, ...
inline constexpr unsigned conversionToInt = 4;
inline constexpr unsigned integerDivision = 12;
inline constexpr unsigned division = 8;
inline constexpr unsigned squareRoot = 8;
inline constexpr unsigned elementary = 40; // sin, exp, log, ...
inline constexpr unsigned power = 100;     // pow, and atan of two arguments
inline constexpr unsigned refraction = 60; // of a vector

// Calls: of a built-in function of more than a few instructions, of an author's function that is
// not inlined, of trace()
inline constexpr unsigned builtinCall = 20;
inline constexpr unsigned functionCall = 50;
inline constexpr unsigned trace = 1000;

// Memory, for each word
inline constexpr unsigned memberLoad = 2; // of the object or the scene: likely in a cache
inline constexpr unsigned load = 4;       // of the ray's state or a variable
inline constexpr unsigned bufferLoad = 16;
inline constexpr unsigned atomic = 64; // one element may have many lanes waiting for it
// Addresses and sizes
inline constexpr unsigned elementAddress = 2;
inline constexpr unsigned bufferElementAddress = 6;
inline constexpr unsigned sizeQuery = 2; // of a buffer, of the lights; the class of an object
inline constexpr unsigned dynamicComponent = 4;

// A word of the frame lies in the memory of one ray among many: on a GPU it is loaded from and
// stored to the second level cache at best. Recomputing a few arithmetic operations is cheaper.
inline constexpr unsigned frameLoad = 8;
inline constexpr unsigned frameStore = 4;
inline constexpr unsigned frameWord = 4; // a larger frame leaves room for fewer rays
inline constexpr unsigned frameBool = 6; // one bit of a word: load and extract

/// An operand of `?:`, `&&` and `||` that costs no more than this is computed without a branch.
inline constexpr unsigned withoutBranch = 12;

/// An expression of constants and members that costs no more than this is repeated in printed C++,
/// where the state of a shader uses it, instead of getting a variable.
inline constexpr unsigned withoutVariable = 6;

} // namespace rtsl::cost
