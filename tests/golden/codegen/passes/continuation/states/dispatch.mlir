// RUN: rtsl-opt %s --rtsl-dispatch | FileCheck %s --implicit-check-not=@uncalled --implicit-check-not=@cycle

// The frame becomes a parameter and states become numbers: entry points first, then the beginnings of
// methods, and so on; a jump is negative.
// CHECK-LABEL: func.func private @e.state0(%arg0: !rtsl.ref<"rt_Material">, %arg1: !rtsl.ptr<i32>) -> i32
// CHECK:         rtsl.store
// CHECK-NEXT:    %[[JUMP:.*]] = arith.constant -2 : i32
// CHECK-NEXT:    return %[[JUMP]]
func.func private @e.state0(%o: !rtsl.ref<"rt_Material">) -> i32 attributes {rtsl.entry = "rtsl_rt_Material_shade", rtsl.state = 0 : i32} {
  %a = rtsl.state "Time" : !rtsl.ptr<f32>
  %t = arith.constant 1.0 : f32
  rtsl.store %t, %a : !rtsl.ptr<f32>
  %n = rtsl.next jump @f.state0
  rtsl.end %n
}

// CHECK-LABEL: func.func private @f.state0(%arg0: !rtsl.ref<"F">, %arg1: !rtsl.ptr<i32>) -> i32
// CHECK:         %[[W:.*]] = rtsl.frame_slot %arg1[4] : !rtsl.ptr<i32> -> !rtsl.ptr<f32>
// CHECK-NEXT:    rtsl.store %{{.*}}, %[[W]] : !rtsl.ptr<f32>
// CHECK:         rtsl.spawn
// CHECK-NEXT:    %[[TRACE:.*]] = arith.constant 3 : i32
// CHECK-NEXT:    return %[[TRACE]]
func.func private @f.state0(%o: !rtsl.ref<"F">) -> i32 attributes {rtsl.state = 0 : i32, rtsl.frame_size = 8 : i32} {
  %w = rtsl.rand
  %d = vector.broadcast %w : f32 to vector<3xf32>
  rtsl.frame_store %w, "w"[4] : f32
  rtsl.spawn %d, %d
  %n = rtsl.next trace @f.state1
  rtsl.end %n
}

// A bool is picked out of its word.
// CHECK-LABEL: func.func private @f.state1
// CHECK:         %[[WORD:.*]] = rtsl.load %{{.*}} : !rtsl.ptr<i32>
// CHECK-NEXT:    %[[MASK:.*]] = arith.constant 8 : i32
// CHECK-NEXT:    %[[BIT:.*]] = arith.andi %[[WORD]], %[[MASK]] : i32
// CHECK:         arith.cmpi ne, %[[BIT]]
// CHECK:         %[[OLD:.*]] = rtsl.load
// CHECK:         arith.ori %[[OLD]], %{{.*}} : i32
// CHECK:         arith.andi %[[OLD]], %{{.*}} : i32
// CHECK:         arith.select
// CHECK:         %[[DONE:.*]] = arith.constant 0 : i32
// CHECK:         return %[[DONE]]
func.func private @f.state1(%o: !rtsl.ref<"F">) -> i32 attributes {rtsl.state = 1 : i32, rtsl.frame_size = 8 : i32} {
  %p = rtsl.frame_load "p"[0] bit 3 : i1
  rtsl.frame_store %p, "q"[0] bit 4 : i1
  %n = rtsl.next done
  rtsl.end %n
}

// CHECK-LABEL: func.func @rtsl_run_state
// CHECK:         3: ^bb4
// CHECK-LABEL: func.func @rtsl_frame_size
// CHECK-NEXT:    arith.constant 8 : i32
// CHECK-LABEL: func.func @rtsl_rt_Material_shade_first
// CHECK-NEXT:    arith.constant 1 : i32
// CHECK-LABEL: func.func @rtsl_rt_Miss_miss_first
// CHECK-NEXT:    arith.constant 0 : i32

// Functions that trace and have no states, as with --keep, are removed, those that call each other too.
func.func @uncalled(%d: vector<3xf32>) -> vector<3xf32> {
  %c = rtsl.trace %d, %d : vector<3xf32>
  return %c : vector<3xf32>
}
func.func private @cycle.there(%o: !rtsl.ref<"F">, %d: vector<3xf32>) -> vector<3xf32> {
  %c = call @cycle.back(%o, %d) {rtsl.framed} : (!rtsl.ref<"F">, vector<3xf32>) -> vector<3xf32>
  return %c : vector<3xf32>
}
func.func private @cycle.back(%o: !rtsl.ref<"F">, %d: vector<3xf32>) -> vector<3xf32> {
  %c = call @cycle.there(%o, %d) : (!rtsl.ref<"F">, vector<3xf32>) -> vector<3xf32>
  return %c : vector<3xf32>
}

// MUTATION dispatch of states/Dispatch.cpp: a jump is taken for a trace
// -       value = -value;
// +       value = +value;

// MUTATION drop-uncalled of states/Dispatch.cpp: only functions without callers are removed
// -    if (!ir::attr::state.isOn(function))
// +    if (!ir::attr::state.isOn(function) && mlir::SymbolTable::symbolKnownUseEmpty(function, module))
