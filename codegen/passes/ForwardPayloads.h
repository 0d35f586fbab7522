//===- ForwardPayloads.h - rays that carry the payload of their parent ----===//
//
// A shader that continues a path sends a ray with its own payload. The argument is copied, and
// copied back after the trace; only the methods of the ray that waits could tell the copy from its
// own payload, and none of them runs meanwhile:
//
//     %own = rtsl.payload                          %own = rtsl.payload
//     %x = rtsl.field %own["x"]                    rtsl.trace_payload ... carries %own
//     %copy = rtsl.var "payload"                   return
//     %there = rtsl.field %copy["x"]
//     %sent = rtsl.load %x
//     rtsl.store %sent, %there             ==>
//     rtsl.trace_payload ... carries %copy
//     %back = rtsl.load %there
//     rtsl.store %back, %x
//     return
//
// What else is stored to the copy, such as its first value, is overwritten before the trace.
//
// For traces that remain calls; those that are split have TailTraces.cpp.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <memory>

namespace mlir {
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// `rtsl-forward-payloads`, on a function of level 2.
std::unique_ptr<mlir::Pass> createForwardPayloadsPass();

} // namespace rtsl::codegen
