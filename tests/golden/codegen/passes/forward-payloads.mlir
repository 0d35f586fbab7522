// RUN: rtsl-opt %s --rtsl-forward-payloads --canonicalize | FileCheck %s
// A ray that carries a copy of its parent's payload carries the payload itself.

!part = !rtsl.struct<"Part", {a: f32, b: vector<3xf32>}>

// CHECK-LABEL: func.func @onItsWay
// CHECK-NOT:     rtsl.var
// CHECK:         rtsl.store %{{.*}}, %{{.*}} : !rtsl.ptr<f32>
// CHECK:         %[[OWN:.*]] = rtsl.payload
// CHECK:         rtsl.trace_payload {{.*}} carries %[[OWN]]
// CHECK-NEXT:    return
func.func @onItsWay(%origin: vector<3xf32>, %direction: vector<3xf32>, %near: f32, %far: f32) {
  %zero = arith.constant 0.0 : f32
  %own = rtsl.payload : !rtsl.ptr<!part>
  %ownA = rtsl.field %own["a"] : !rtsl.ptr<!part> -> !rtsl.ptr<f32>
  %ownB = rtsl.field %own["b"] : !rtsl.ptr<!part> -> !rtsl.ptr<vector<3xf32>>
  rtsl.store %far, %ownA : !rtsl.ptr<f32>
  %copy = rtsl.var "payload" : !rtsl.ptr<!part>
  %copyA = rtsl.field %copy["a"] : !rtsl.ptr<!part> -> !rtsl.ptr<f32>
  %copyB = rtsl.field %copy["b"] : !rtsl.ptr<!part> -> !rtsl.ptr<vector<3xf32>>
  rtsl.store %zero, %copyA : !rtsl.ptr<f32>
  %a = rtsl.load %ownA : !rtsl.ptr<f32>
  rtsl.store %a, %copyA : !rtsl.ptr<f32>
  %b = rtsl.load %ownB : !rtsl.ptr<vector<3xf32>>
  rtsl.store %b, %copyB : !rtsl.ptr<vector<3xf32>>
  rtsl.trace_payload %origin, %direction from %near to %far carries %copy {how = 0 : i32, ray_type = 1 : i32} : !rtsl.ptr<!part>
  %backA = rtsl.load %copyA : !rtsl.ptr<f32>
  rtsl.store %backA, %ownA : !rtsl.ptr<f32>
  %backB = rtsl.load %copyB : !rtsl.ptr<vector<3xf32>>
  rtsl.store %backB, %ownB : !rtsl.ptr<vector<3xf32>>
  return
}

// The variable gets its first value in another block, as in functions that were inlined.
// CHECK-LABEL: func.func @isDeclaredElsewhere
// CHECK-NOT:     rtsl.var
// CHECK:         %[[OWN:.*]] = rtsl.payload
// CHECK:         rtsl.trace_payload {{.*}} carries %[[OWN]]
// CHECK-NEXT:    cf.br
func.func @isDeclaredElsewhere(%origin: vector<3xf32>, %direction: vector<3xf32>, %near: f32, %far: f32, %goesOn: i1) {
  %zero = arith.constant 0.0 : f32
  %own = rtsl.payload : !rtsl.ptr<!part>
  %ownA = rtsl.field %own["a"] : !rtsl.ptr<!part> -> !rtsl.ptr<f32>
  %ownB = rtsl.field %own["b"] : !rtsl.ptr<!part> -> !rtsl.ptr<vector<3xf32>>
  %copy = rtsl.var "payload" : !rtsl.ptr<!part>
  %copyA = rtsl.field %copy["a"] : !rtsl.ptr<!part> -> !rtsl.ptr<f32>
  %copyB = rtsl.field %copy["b"] : !rtsl.ptr<!part> -> !rtsl.ptr<vector<3xf32>>
  rtsl.store %zero, %copyA : !rtsl.ptr<f32>
  rtsl.store %direction, %copyB : !rtsl.ptr<vector<3xf32>>
  cf.cond_br %goesOn, ^next, ^end
^next:
  %a = rtsl.load %ownA : !rtsl.ptr<f32>
  rtsl.store %a, %copyA : !rtsl.ptr<f32>
  %b = rtsl.load %ownB : !rtsl.ptr<vector<3xf32>>
  rtsl.store %b, %copyB : !rtsl.ptr<vector<3xf32>>
  rtsl.trace_payload %origin, %direction from %near to %far carries %copy {how = 0 : i32, ray_type = 1 : i32} : !rtsl.ptr<!part>
  %backA = rtsl.load %copyA : !rtsl.ptr<f32>
  rtsl.store %backA, %ownA : !rtsl.ptr<f32>
  %backB = rtsl.load %copyB : !rtsl.ptr<vector<3xf32>>
  rtsl.store %backB, %ownB : !rtsl.ptr<vector<3xf32>>
  cf.br ^end
^end:
  return
}

// Part `b` is set in another block alone: the copy remains.
// CHECK-LABEL: func.func @isPartlySet
// CHECK:         %[[COPY:.*]] = rtsl.var
// CHECK:         rtsl.trace_payload {{.*}} carries %[[COPY]]
func.func @isPartlySet(%origin: vector<3xf32>, %direction: vector<3xf32>, %near: f32, %far: f32, %goesOn: i1) {
  %own = rtsl.payload : !rtsl.ptr<!part>
  %ownA = rtsl.field %own["a"] : !rtsl.ptr<!part> -> !rtsl.ptr<f32>
  %ownB = rtsl.field %own["b"] : !rtsl.ptr<!part> -> !rtsl.ptr<vector<3xf32>>
  %copy = rtsl.var "payload" : !rtsl.ptr<!part>
  %copyA = rtsl.field %copy["a"] : !rtsl.ptr<!part> -> !rtsl.ptr<f32>
  %copyB = rtsl.field %copy["b"] : !rtsl.ptr<!part> -> !rtsl.ptr<vector<3xf32>>
  %b = rtsl.load %ownB : !rtsl.ptr<vector<3xf32>>
  rtsl.store %b, %copyB : !rtsl.ptr<vector<3xf32>>
  cf.cond_br %goesOn, ^next, ^end
^next:
  %a = rtsl.load %ownA : !rtsl.ptr<f32>
  rtsl.store %a, %copyA : !rtsl.ptr<f32>
  rtsl.trace_payload %origin, %direction from %near to %far carries %copy {how = 0 : i32, ray_type = 1 : i32} : !rtsl.ptr<!part>
  %backA = rtsl.load %copyA : !rtsl.ptr<f32>
  rtsl.store %backA, %ownA : !rtsl.ptr<f32>
  %backB = rtsl.load %copyB : !rtsl.ptr<vector<3xf32>>
  rtsl.store %backB, %ownB : !rtsl.ptr<vector<3xf32>>
  cf.br ^end
^end:
  return
}

// Part `b` is another one: the copy remains.
// CHECK-LABEL: func.func @changed
// CHECK:         %[[COPY:.*]] = rtsl.var
// CHECK:         rtsl.trace_payload {{.*}} carries %[[COPY]]
func.func @changed(%origin: vector<3xf32>, %direction: vector<3xf32>, %near: f32, %far: f32) {
  %own = rtsl.payload : !rtsl.ptr<!part>
  %ownA = rtsl.field %own["a"] : !rtsl.ptr<!part> -> !rtsl.ptr<f32>
  %ownB = rtsl.field %own["b"] : !rtsl.ptr<!part> -> !rtsl.ptr<vector<3xf32>>
  %copy = rtsl.var "payload" : !rtsl.ptr<!part>
  %copyA = rtsl.field %copy["a"] : !rtsl.ptr<!part> -> !rtsl.ptr<f32>
  %copyB = rtsl.field %copy["b"] : !rtsl.ptr<!part> -> !rtsl.ptr<vector<3xf32>>
  %a = rtsl.load %ownA : !rtsl.ptr<f32>
  rtsl.store %a, %copyA : !rtsl.ptr<f32>
  rtsl.store %direction, %copyB : !rtsl.ptr<vector<3xf32>>
  rtsl.trace_payload %origin, %direction from %near to %far carries %copy {how = 0 : i32, ray_type = 1 : i32} : !rtsl.ptr<!part>
  %backA = rtsl.load %copyA : !rtsl.ptr<f32>
  rtsl.store %backA, %ownA : !rtsl.ptr<f32>
  %backB = rtsl.load %copyB : !rtsl.ptr<vector<3xf32>>
  rtsl.store %backB, %ownB : !rtsl.ptr<vector<3xf32>>
  return
}

// What comes back is not all stored, so it may not change: the copy remains.
// CHECK-LABEL: func.func @keepsItsOwn
// CHECK:         %[[COPY:.*]] = rtsl.var
// CHECK:         rtsl.trace_payload {{.*}} carries %[[COPY]]
func.func @keepsItsOwn(%origin: vector<3xf32>, %direction: vector<3xf32>, %near: f32, %far: f32) {
  %own = rtsl.payload : !rtsl.ptr<!part>
  %ownA = rtsl.field %own["a"] : !rtsl.ptr<!part> -> !rtsl.ptr<f32>
  %ownB = rtsl.field %own["b"] : !rtsl.ptr<!part> -> !rtsl.ptr<vector<3xf32>>
  %copy = rtsl.var "payload" : !rtsl.ptr<!part>
  %copyA = rtsl.field %copy["a"] : !rtsl.ptr<!part> -> !rtsl.ptr<f32>
  %copyB = rtsl.field %copy["b"] : !rtsl.ptr<!part> -> !rtsl.ptr<vector<3xf32>>
  %a = rtsl.load %ownA : !rtsl.ptr<f32>
  rtsl.store %a, %copyA : !rtsl.ptr<f32>
  %b = rtsl.load %ownB : !rtsl.ptr<vector<3xf32>>
  rtsl.store %b, %copyB : !rtsl.ptr<vector<3xf32>>
  rtsl.trace_payload %origin, %direction from %near to %far carries %copy {how = 0 : i32, ray_type = 1 : i32} : !rtsl.ptr<!part>
  %backA = rtsl.load %copyA : !rtsl.ptr<f32>
  rtsl.store %backA, %ownA : !rtsl.ptr<f32>
  return
}

// The own payload changes after it is copied: the copy remains.
// CHECK-LABEL: func.func @changesItsOwn
// CHECK:         %[[COPY:.*]] = rtsl.var
// CHECK:         rtsl.trace_payload {{.*}} carries %[[COPY]]
func.func @changesItsOwn(%origin: vector<3xf32>, %direction: vector<3xf32>, %near: f32, %far: f32) {
  %own = rtsl.payload : !rtsl.ptr<!part>
  %ownA = rtsl.field %own["a"] : !rtsl.ptr<!part> -> !rtsl.ptr<f32>
  %ownB = rtsl.field %own["b"] : !rtsl.ptr<!part> -> !rtsl.ptr<vector<3xf32>>
  %copy = rtsl.var "payload" : !rtsl.ptr<!part>
  %copyA = rtsl.field %copy["a"] : !rtsl.ptr<!part> -> !rtsl.ptr<f32>
  %copyB = rtsl.field %copy["b"] : !rtsl.ptr<!part> -> !rtsl.ptr<vector<3xf32>>
  %a = rtsl.load %ownA : !rtsl.ptr<f32>
  rtsl.store %a, %copyA : !rtsl.ptr<f32>
  rtsl.store %far, %ownA : !rtsl.ptr<f32>
  %b = rtsl.load %ownB : !rtsl.ptr<vector<3xf32>>
  rtsl.store %b, %copyB : !rtsl.ptr<vector<3xf32>>
  rtsl.trace_payload %origin, %direction from %near to %far carries %copy {how = 0 : i32, ray_type = 1 : i32} : !rtsl.ptr<!part>
  %backA = rtsl.load %copyA : !rtsl.ptr<f32>
  rtsl.store %backA, %ownA : !rtsl.ptr<f32>
  %backB = rtsl.load %copyB : !rtsl.ptr<vector<3xf32>>
  rtsl.store %backB, %ownB : !rtsl.ptr<vector<3xf32>>
  return
}
