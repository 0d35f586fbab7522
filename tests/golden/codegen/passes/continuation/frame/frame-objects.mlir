// RUN: rtsl-opt %s --rtsl-insert-suspends --rtsl-frame-objects | FileCheck %s

// Indexed at run time after the trace: it lives in the frame, and is zero when control comes there, as a variable is.
// CHECK-LABEL: func.func @table
// CHECK-NEXT:   %table = rtsl.frame_object "table"[0] : !rtsl.ptr<!rtsl.array<4 x f32>>
// CHECK-NEXT:   rtsl.clear %table
// CHECK:        rtsl.suspend
// CHECK:        rtsl.element %table[%arg1]
func.func @table(%o: vector<3xf32>, %i: i32) -> f32 {
  %table = rtsl.var "table" : !rtsl.ptr<!rtsl.array<4 x f32>>
  %c = rtsl.trace %o, %o : vector<3xf32>
  %e = rtsl.element %table[%i] : !rtsl.ptr<!rtsl.array<4 x f32>> -> !rtsl.ptr<f32>
  %v = rtsl.load %e : !rtsl.ptr<f32>
  return %v : f32
}

// An address inside of it that was computed before the trace counts too.
// CHECK-LABEL: func.func @element
// CHECK:        rtsl.frame_object "table"
// CHECK-NOT:    rtsl.var
func.func @element(%o: vector<3xf32>, %i: i32) -> f32 {
  %table = rtsl.var "table" : !rtsl.ptr<!rtsl.array<4 x f32>>
  %e = rtsl.element %table[%i] : !rtsl.ptr<!rtsl.array<4 x f32>> -> !rtsl.ptr<f32>
  %c = rtsl.trace %o, %o : vector<3xf32>
  %v = rtsl.load %e : !rtsl.ptr<f32>
  return %v : f32
}

// Used on one side only: it stays where it is.
// CHECK-LABEL: func.func @local
// CHECK:        rtsl.var "before"
// CHECK:        rtsl.suspend
// CHECK:        rtsl.var "after"
// CHECK-NOT:    rtsl.frame_object
func.func @local(%o: vector<3xf32>, %i: i32) -> f32 {
  %before = rtsl.var "before" : !rtsl.ptr<!rtsl.array<4 x f32>>
  rtsl.clear %before : !rtsl.ptr<!rtsl.array<4 x f32>>
  %c = rtsl.trace %o, %o : vector<3xf32>
  %after = rtsl.var "after" : !rtsl.ptr<!rtsl.array<4 x f32>>
  %e = rtsl.element %after[%i] : !rtsl.ptr<!rtsl.array<4 x f32>> -> !rtsl.ptr<f32>
  %v = rtsl.load %e : !rtsl.ptr<f32>
  return %v : f32
}

// Moved to the entry, and cleared where it is declared, in the loop after the trace: it goes back there.
// CHECK-LABEL: func.func @declaredAfter
// CHECK-NOT:    rtsl.var
// CHECK:        rtsl.suspend
// CHECK:        %declared = rtsl.var "declared"
// CHECK-NOT:    rtsl.clear
// CHECK:        rtsl.element %declared
func.func @declaredAfter(%o: vector<3xf32>, %i: i32, %again: i1) -> f32 {
  %declared = rtsl.var "declared" : !rtsl.ptr<!rtsl.array<4 x f32>>
  cf.br ^loop
^loop:
  %c = rtsl.trace %o, %o : vector<3xf32>
  cf.br ^after
^after:
  rtsl.clear %declared : !rtsl.ptr<!rtsl.array<4 x f32>>
  %e = rtsl.element %declared[%i] : !rtsl.ptr<!rtsl.array<4 x f32>> -> !rtsl.ptr<f32>
  %v = rtsl.load %e : !rtsl.ptr<f32>
  cf.cond_br %again, ^loop, ^end
^end:
  return %v : f32
}

// Used before it is cleared, in the next round: it is live across the trace.
// CHECK-LABEL: func.func @clearedLater
// CHECK:        rtsl.frame_object "kept"
// CHECK-NOT:    rtsl.var
func.func @clearedLater(%o: vector<3xf32>, %i: i32, %again: i1) -> f32 {
  %kept = rtsl.var "kept" : !rtsl.ptr<!rtsl.array<4 x f32>>
  cf.br ^loop
^loop:
  %c = rtsl.trace %o, %o : vector<3xf32>
  %e = rtsl.element %kept[%i] : !rtsl.ptr<!rtsl.array<4 x f32>> -> !rtsl.ptr<f32>
  %v = rtsl.load %e : !rtsl.ptr<f32>
  rtsl.clear %kept : !rtsl.ptr<!rtsl.array<4 x f32>>
  cf.cond_br %again, ^loop, ^end
^end:
  return %v : f32
}

// MUTATION frame-objects of frame/FrameObjects.cpp: a variable in the frame begins with what lay there
// -     ir::ClearOp::create(builder, variable.getLoc(), object);

// MUTATION declarations of frame/FrameObjects.cpp: a variable goes back to a clear that does not precede all its uses
// - return other != clear && !dominance.properlyDominates(clear, other);
// + return false;
