//===- LocalizeLookups.h - results of lookups as variables ----------------===//
//
// A texture stores its results in the ray's state, where its caller reads them. In a function that
// no lookup runs, nothing else reads them, and they are variables of the function, which become
// values. Calls of textures that were not inlined still store to the state:
//
//     rtsl.store %zero, %TextureColor              rtsl.store %zero, %variable
//     cf.switch %class ...                         cf.switch %class ...
//   ^checker:                                    ^checker:
//     rtsl.store %odd, %TextureColor               rtsl.store %odd, %variable
//     cf.br ^found                                 cf.br ^found
//   ^wood:                                  ==>  ^wood:
//     call @Wood.lookup(%texture)                  rtsl.store (rtsl.load %variable), %TextureColor
//     cf.br ^found                                 call @Wood.lookup(%texture)
//   ^found:                                        rtsl.store (rtsl.load %TextureColor), %variable
//     %color = rtsl.load %TextureColor             cf.br ^found
//                                                ^found:
//                                                  %color = rtsl.load %variable
//
// So two lookups of a method, and those of two methods, do not depend on one another.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <memory>

namespace mlir {
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// `rtsl-localize-lookups`, on a module of level 2.
std::unique_ptr<mlir::Pass> createLocalizeLookupsPass();

} // namespace rtsl::codegen
