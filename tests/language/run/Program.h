//===- Program.h - RTSL programs that say what they should compute --------===//
//
// A program is the text of some files, and its tests:
//
//   int name(int zero)       a function at file level; it gives 0, or the number of what went
//                            wrong. `zero` is 0, which no compiler can derive.
//   //! material: {...}      an object of a material, as a scene file has it, in front of the
//                            camera; it gives color 0 or the number of what went wrong
//   //! object: {...}        the same with a primitive; $X stands for the left edge of the unit
//                            square in front of the camera
//   //! texture name: {...}  and `light: {...}`: what the materials refer to
//
// All tests of a program are compiled together, and run as the pixels of one picture. The material
// that calls the functions traces before and after them, so that they are part of a state where
// `trace` is split. A line `// unchecked: no` in front of a function leaves it out where indices
// are not checked, `// fast: no` where arithmetic need not be as it is written, `// double: no`
// where it is double.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "Configurations.h"

#include <string>
#include <vector>

namespace rtsl::test {

struct ProgramFile {
  std::string name; // "04-numbers/run.rtsl"
  std::string text;
};

/// What is wrong, a line each; empty if all tests passed. `count` becomes the number of tests.
std::string runProgram(const std::vector<ProgramFile> &files, const Configuration &configuration,
                       std::size_t &count);

} // namespace rtsl::test
