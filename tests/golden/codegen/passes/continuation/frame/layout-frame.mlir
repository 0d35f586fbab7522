// RUN: rtsl-opt %s --rtsl-insert-suspends --rtsl-frame-objects --rtsl-rematerialise --rtsl-save-live --rtsl-layout-frame | FileCheck %s

// "a" and "b" are never saved at the same trace, so they share words; "w" keeps its place from trace to trace.
// CHECK-LABEL: func.func @share
// CHECK-SAME:    rtsl.frame_size = 16 : i32
// CHECK:        rtsl.frame_store %{{.*}}, "w"[0] : f32
// CHECK:        rtsl.frame_store %{{.*}}, "a"[4] : vector<3xf32>
// CHECK-NEXT:   rtsl.suspend %{{.*}}, %{{.*}}, ^bb1{{$}}
// CHECK-NEXT: ^bb1:
// CHECK-NEXT:   %[[A:.*]] = rtsl.trace_result
// CHECK-DAG:    rtsl.frame_load "a"[4] : vector<3xf32>
// CHECK-DAG:    rtsl.frame_load "w"[0] : f32
// CHECK:        rtsl.frame_store %{{.*}}, "w"[0] : f32
// CHECK:        rtsl.frame_store %{{.*}}, "b"[4] : vector<3xf32>
func.func @share(%o: vector<3xf32>, %w: f32 loc("w"), %a: vector<3xf32> loc("a")) -> (vector<3xf32>, f32) {
  %c = rtsl.trace %o, %o : vector<3xf32>
  %b = arith.mulf %a, %c : vector<3xf32> loc("b")
  %d = rtsl.trace %c, %c : vector<3xf32>
  %e = arith.addf %b, %d : vector<3xf32>
  return %e, %w : vector<3xf32>, f32
}

// Bools are bits of one word.
// CHECK-LABEL: func.func @bools
// CHECK-SAME:    rtsl.frame_size = 4 : i32
// CHECK:        rtsl.frame_store %{{.*}}, "p"[0] bit 0 : i1
// CHECK-NEXT:   rtsl.frame_store %{{.*}}, "q"[0] bit 1 : i1
// CHECK:        rtsl.frame_load "p"[0] bit 0 : i1
// CHECK-NEXT:   rtsl.frame_load "q"[0] bit 1 : i1
func.func @bools(%o: vector<3xf32>, %p: i1 loc("p"), %q: i1 loc("q")) -> (i1, i1) {
  %c = rtsl.trace %o, %o : vector<3xf32>
  return %p, %q : i1, i1
}

// A variable in the frame shares its words with no other.
// CHECK-LABEL: func.func @object
// CHECK-SAME:    rtsl.frame_size = 24 : i32
// CHECK:        rtsl.frame_object "table"[8]
func.func @object(%o: vector<3xf32>, %i: i32 loc("i"), %w: f32 loc("w")) -> (f32, f32) {
  %table = rtsl.var "table" : !rtsl.ptr<!rtsl.array<4 x f32>>
  %c = rtsl.trace %o, %o : vector<3xf32>
  %e = rtsl.element %table[%i] : !rtsl.ptr<!rtsl.array<4 x f32>> -> !rtsl.ptr<f32>
  %v = rtsl.load %e : !rtsl.ptr<f32>
  return %v, %w : f32, f32
}

// MUTATION layout-frame of frame/FrameLayout.cpp: bools that live at the same time share a bit
// -     while (taken.test(bit))
// -       ++bit;
