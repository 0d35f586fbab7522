// What the report says is moved between registers and frame at a trace. In the loop `w` lies in its slot after the first round, and is
// read after the last alone; `i` is written and read each time.
// RUN: rtsl-opt %s --rtsl-split="no-dispatch report=text" 2>&1 >/dev/null | FileCheck %s
// RUN: rtsl-opt %s --rtsl-split="no-dispatch no-clean-up report=text" 2>&1 >/dev/null | FileCheck %s --check-prefix=UNCLEAN
// RUN: rtsl-opt %s --rtsl-split="no-dispatch report=json" 2>&1 >/dev/null | FileCheck %s --check-prefix=STEPS

func.func @f(%o: !rtsl.ref<"object">) {
  %zero = arith.constant 0 : i32
  %one = arith.constant 1 : i32
  %end = arith.constant 3 : i32
  %r = rtsl.rand loc("w")
  cf.br ^loop(%zero : i32)
^loop(%i: i32 loc("i")):
  %d = arith.constant dense<[0.0, 0.0, 1.0]> : vector<3xf32>
  %c = rtsl.trace %d, %d : vector<3xf32>
  %next = arith.addi %i, %one : i32
  %again = arith.cmpi ne, %next, %end : i32
  cf.cond_br %again, ^loop(%next : i32), ^done
^done:
  %b = vector.broadcast %r : f32 to vector<3xf32>
  %color = rtsl.state "SampleColor" : !rtsl.ptr<vector<3xf32>>
  rtsl.store %b, %color : !rtsl.ptr<vector<3xf32>>
  return
}

// CHECK:      saved          8 bytes: w, i
// CHECK-NEXT: stored         4 to 8 bytes
// CHECK-NEXT: restored       4 to 8 bytes
// CHECK-NEXT: extra          2 stores, 2 loads, cost 24; of plain liveness

// UNCLEAN:      saved          8 bytes: w, i
// UNCLEAN-NEXT: stored         8 bytes
// UNCLEAN-NEXT: restored       8 bytes

// STEPS:      "after": "liveness"
// STEPS:      "after": "trim-vectors"
// STEPS:      "after": "rematerialise",
// STEPS-NEXT: "savedBytes": 8,
// STEPS-NEXT: "storedBytes": 8,
// STEPS-NEXT: "storedBytesLeast": 8,
// STEPS:      "after": "clean-stores",
// STEPS-NEXT: "savedBytes": 8,
// STEPS-NEXT: "storedBytes": 8,
// STEPS-NEXT: "storedBytesLeast": 4,
// STEPS-NEXT: "restoredBytes": 8,
// STEPS-NEXT: "restoredBytesLeast": 8
// STEPS:      "after": "sink-loads",
// STEPS:      "restoredBytes": 8,
// STEPS-NEXT: "restoredBytesLeast": 4

// MUTATION frame-traffic of FrameTraffic.cpp: the way that loads least loads most
// - std::min(range.least, before->second.least)
// + std::max(range.least, before->second.least)
