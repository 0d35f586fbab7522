// RUN: rtsl-opt %s --rtsl-insert-suspends --rtsl-rematerialise --rtsl-save-live --canonicalize --split-input-file | FileCheck %s

rtsl.class @M root "rt_Material" {
  rtsl.member_decl @eta : f32 access "public"
  rtsl.member_decl @table : !rtsl.buffer<vector<3xf32>, 1> access "public"
}

// Members are constant for a launch: a cheap chain from them is computed again.
// CHECK-LABEL: func.func @members
// CHECK:        rtsl.suspend %{{.*}}, %{{.*}}, ^bb1
// CHECK-NEXT: ^bb1:
// CHECK-NEXT:   rtsl.trace_result
// CHECK-NEXT:   %[[P:.*]] = rtsl.member %arg0["eta"]
// CHECK-NEXT:   %[[ETA:.*]] = rtsl.load %[[P]]
// CHECK-NEXT:   %[[SQUARE:.*]] = arith.mulf %[[ETA]], %[[ETA]]
// CHECK-NEXT:   return %[[SQUARE]]
func.func @members(%self: !rtsl.ref<"M">, %o: vector<3xf32>) -> f32 {
  %p = rtsl.member %self["eta"] : !rtsl.ref<"M"> -> !rtsl.ptr<f32>
  %eta = rtsl.load %p : !rtsl.ptr<f32>
  %square = arith.mulf %eta, %eta : f32
  %c = rtsl.trace %o, %o : vector<3xf32>
  return %square : f32
}

// What lies in a table is read again where its index is at hand: the address is not saved, and nothing of the table.
// CHECK-LABEL: func.func @table
// CHECK:        rtsl.suspend %{{.*}}, %{{.*}}, ^bb1(%{{.*}} : i32) names ["argument"]
// CHECK-NEXT: ^bb1(%[[I:.*]]: i32):
// CHECK:        %[[E:.*]] = rtsl.element %{{.*}}[%[[I]]]
// CHECK-NEXT:   %[[X:.*]] = rtsl.load %[[E]]
func.func @table(%i: i32, %o: vector<3xf32>) -> (f32, i32) {
  %t = rtsl.table "t" [0, 1] : !rtsl.ptr<!rtsl.array<2 x f32>>
  %e = rtsl.element %t[%i] : !rtsl.ptr<!rtsl.array<2 x f32>> -> !rtsl.ptr<f32>
  %x = rtsl.load %e : !rtsl.ptr<f32>
  %c = rtsl.trace %o, %o : vector<3xf32>
  return %x, %i : f32, i32
}

// But a sine costs more than a word.
// CHECK-LABEL: func.func @dear
// CHECK:        rtsl.suspend %{{.*}}, %{{.*}}, ^bb1(%{{.*}} : f32) names ["elementary"]
func.func @dear(%self: !rtsl.ref<"M">, %o: vector<3xf32>) -> f32 {
  %p = rtsl.member %self["eta"] : !rtsl.ref<"M"> -> !rtsl.ptr<f32>
  %eta = rtsl.load %p : !rtsl.ptr<f32>
  %s = rtsl.elementary <sin> %eta : f32
  %c = rtsl.trace %o, %o : vector<3xf32>
  return %s : f32
}

// Nor is a buffer read again.
// CHECK-LABEL: func.func @buffer
// CHECK:        rtsl.suspend %{{.*}}, %{{.*}}, ^bb1(%{{.*}} : vector<3xf32>)
func.func @buffer(%self: !rtsl.ref<"M">, %o: vector<3xf32>, %i: i32) -> vector<3xf32> {
  %b = rtsl.member %self["table"] : !rtsl.ref<"M"> -> !rtsl.ptr<!rtsl.buffer<vector<3xf32>, 1>>
  %e = rtsl.buffer_element %b[%i] : !rtsl.ptr<!rtsl.buffer<vector<3xf32>, 1>> -> !rtsl.ptr<vector<3xf32>>
  %v = rtsl.load %e : !rtsl.ptr<vector<3xf32>>
  %c = rtsl.trace %o, %o : vector<3xf32>
  return %v : vector<3xf32>
}

// Two values from one: the one is saved, once.
// CHECK-LABEL: func.func @shared
// CHECK:        rtsl.suspend %{{.*}}, %{{.*}}, ^bb1(%[[R:.*]] : f32) names ["r"]
// CHECK-NEXT: ^bb1(%[[BACK:.*]]: f32):
// CHECK-DAG:    arith.addf %[[BACK]]
// CHECK-DAG:    arith.mulf %[[BACK]]
func.func @shared(%self: !rtsl.ref<"M">, %o: vector<3xf32>) -> (f32, f32) {
  %one = arith.constant 1.0 : f32
  %r = rtsl.rand loc("r")
  %a = arith.addf %r, %one : f32
  %b = arith.mulf %r, %r : f32
  %c = rtsl.trace %o, %o : vector<3xf32>
  return %a, %b : f32, f32
}

// -----

// A ray's own state is unchanged after the trace, unless its shader wrote it in between.
// CHECK-LABEL: func.func @state
// CHECK:        rtsl.suspend %{{.*}}, %{{.*}}, ^bb1
// CHECK-NEXT: ^bb1:
// CHECK:        %[[AGAIN:.*]] = rtsl.load
// CHECK:        return %[[AGAIN]]
func.func @state(%self: !rtsl.ref<"M">, %o: vector<3xf32>) -> vector<3xf32> {
  %p = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %v = rtsl.load %p : !rtsl.ptr<vector<3xf32>>
  %c = rtsl.trace %o, %o : vector<3xf32>
  return %v : vector<3xf32>
}

// CHECK-LABEL: func.func @overwritten
// CHECK:        rtsl.suspend %{{.*}}, %{{.*}}, ^bb1(%{{.*}} : vector<3xf32>) names ["SampleColor"]
func.func @overwritten(%self: !rtsl.ref<"M">, %o: vector<3xf32>) -> vector<3xf32> {
  %p = rtsl.state "SampleColor" : !rtsl.ptr<vector<3xf32>>
  %v = rtsl.load %p : !rtsl.ptr<vector<3xf32>>
  rtsl.store %o, %p : !rtsl.ptr<vector<3xf32>>
  %c = rtsl.trace %o, %o : vector<3xf32>
  return %v : vector<3xf32>
}

// A store after the load on one of two paths is enough ...
// CHECK-LABEL: func.func @maybeOverwritten
// CHECK:        names ["SampleColor"]
func.func @maybeOverwritten(%self: !rtsl.ref<"M">, %o: vector<3xf32>, %w: i1) -> vector<3xf32> {
  %p = rtsl.state "SampleColor" : !rtsl.ptr<vector<3xf32>>
  %v = rtsl.load %p : !rtsl.ptr<vector<3xf32>>
  cf.cond_br %w, ^write, ^trace
^write:
  rtsl.store %o, %p : !rtsl.ptr<vector<3xf32>>
  cf.br ^trace
^trace:
  %c = rtsl.trace %o, %o : vector<3xf32>
  return %v : vector<3xf32>
}

// ... and one that comes before the load, or of another variable, is none.
// CHECK-LABEL: func.func @writtenBefore
// CHECK:        rtsl.suspend %{{.*}}, %{{.*}}, ^bb1{{$}}
func.func @writtenBefore(%self: !rtsl.ref<"M">, %o: vector<3xf32>) -> vector<3xf32> {
  %p = rtsl.state "SampleColor" : !rtsl.ptr<vector<3xf32>>
  rtsl.store %o, %p : !rtsl.ptr<vector<3xf32>>
  %v = rtsl.load %p : !rtsl.ptr<vector<3xf32>>
  %q = rtsl.state "BSDFValue" : !rtsl.ptr<vector<3xf32>>
  rtsl.store %o, %q : !rtsl.ptr<vector<3xf32>>
  %c = rtsl.trace %o, %o : vector<3xf32>
  return %v : vector<3xf32>
}

// A function that is called counts for what it writes.
func.func private @writes(%v: vector<3xf32>) {
  %p = rtsl.state "PDF" : !rtsl.ptr<f32>
  %x = vector.extract %v[0] : f32 from vector<3xf32>
  rtsl.store %x, %p : !rtsl.ptr<f32>
  return
}
// CHECK-LABEL: func.func @called
// CHECK:        names ["PDF"]
func.func @called(%self: !rtsl.ref<"M">, %o: vector<3xf32>) -> (f32, vector<3xf32>) {
  %p = rtsl.state "PDF" : !rtsl.ptr<f32>
  %v = rtsl.load %p : !rtsl.ptr<f32>
  %q = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %h = rtsl.load %q : !rtsl.ptr<vector<3xf32>>
  call @writes(%o) : (vector<3xf32>) -> ()
  %c = rtsl.trace %o, %o : vector<3xf32>
  return %v, %h : f32, vector<3xf32>
}

// -----

// What one trace saves is needed after the one before it: the random number, and nothing that is made of it.
// CHECK-LABEL: func.func @chain
// CHECK:        rtsl.suspend %{{.*}}, %{{.*}}, ^bb1(%{{.*}}, %{{.*}} : vector<3xf32>, f32) names ["o", "r"]
// CHECK:        rtsl.suspend %{{.*}}, %{{.*}}, ^bb2(%{{.*}} : f32) names ["r"]
func.func @chain(%self: !rtsl.ref<"M">, %o: vector<3xf32> loc("o")) -> (f32, f32) {
  %one = arith.constant 1.0 : f32
  %r = rtsl.rand loc("r")
  %a = arith.addf %r, %one : f32
  %b = arith.mulf %r, %r : f32
  %c = rtsl.trace %o, %o : vector<3xf32>
  %d = rtsl.trace %o, %o : vector<3xf32>
  return %a, %b : f32, f32
}

// In a loop the argument is saved, and what is made of it is not.
// CHECK-LABEL: func.func @loop
// CHECK:        rtsl.suspend %{{.*}}, %{{.*}}, ^bb2(%{{.*}}, %{{.*}} : vector<3xf32>, i32) names ["o", "i"]
func.func @loop(%self: !rtsl.ref<"M">, %o: vector<3xf32> loc("o")) -> i32 {
  %one = arith.constant 1 : i32
  %nine = arith.constant 9 : i32
  cf.br ^loop(%one : i32)
^loop(%i: i32 loc("i")):
  %square = arith.muli %i, %i : i32
  %c = rtsl.trace %o, %o : vector<3xf32>
  %next = arith.addi %i, %one : i32
  %more = arith.cmpi slt, %square, %nine : i32
  cf.cond_br %more, ^loop(%next : i32), ^done
^done:
  return %square : i32
}

// An index has no place in a frame: it is made again of the i32.
// CHECK-LABEL: func.func @index
// CHECK:        rtsl.suspend %{{.*}}, %{{.*}}, ^bb1(%{{.*}}, %{{.*}} : vector<3xf32>, i32)
// CHECK:        ^bb1(%[[V:.*]]: vector<3xf32>, %[[I:.*]]: i32)
// CHECK:        %[[INDEX:.*]] = arith.index_castui %[[I]] : i32 to index
// CHECK:        vector.extract %[[V]][%[[INDEX]]]
func.func @index(%v: vector<3xf32>, %i: i32) -> f32 {
  %index = arith.index_castui %i : i32 to index
  %c = rtsl.trace %v, %v : vector<3xf32>
  %x = vector.extract %v[%index] : f32 from vector<3xf32>
  return %x : f32
}

// What a light that is not known yet leaves in the ray's state cannot be told, but the point that was hit is put back.
// CHECK-LABEL: func.func @lights
// CHECK:        rtsl.suspend %{{.*}}, %{{.*}}, ^bb1(%{{.*}} : vector<3xf32>) names ["GeometricNormal"]
// CHECK-NEXT: ^bb1(
// CHECK:        rtsl.state "HitPoint"
// CHECK-NEXT:   rtsl.load
func.func @lights(%i: i32) -> (vector<3xf32>, vector<3xf32>) {
  %place = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %p = rtsl.load %place : !rtsl.ptr<vector<3xf32>>
  %normal = rtsl.state "GeometricNormal" : !rtsl.ptr<vector<3xf32>>
  %n = rtsl.load %normal : !rtsl.ptr<vector<3xf32>>
  %lit = rtsl.illuminate %p light %i
  %c = rtsl.trace %p, %n : vector<3xf32>
  return %p, %n : vector<3xf32>, vector<3xf32>
}

// MUTATION recompute of common/Recompute.cpp: a state variable that was written since is loaded again
// -       if (writes(op))
// -         return false;

// MUTATION minimum-cut of save/MinimumCut.cpp: an operand need not be there
// -         network.connect(recomputed, nodeOf[operand], impossible);
// +         network.connect(recomputed, nodeOf[operand], 0);

// MUTATION rematerialise of save/Rematerialise.cpp: what is computed again is not used
// -       redefinitions[value][resume] = again;
// +       (void)again;

// MUTATION plans-together of save/Rematerialise.cpp: each trace saves what is cheapest for it alone
// - const std::int64_t cost = costOf(without); cost < best
// + const std::int64_t cost = costOf(without); cost < 0
