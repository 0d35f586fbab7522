// Loads of what is bound become constants, parts of aggregates too; what is computed from them folds. What is read at an index
// that is not constant lies in a table. References and members that differ stay loads.
// RUN: rtsl-opt %s --rtsl-bind-members | FileCheck %s
// RUN: rtsl-opt %s --rtsl-ssa | FileCheck %s --check-prefix=FOLDED

module attributes {rtsl.light_count = 2 : i32, rtsl.ambient = array<f32: 0.125, 0.25, 0.5>} {
rtsl.class @Glass root "rt_Material" {
  rtsl.member_decl @index : f32 access "private" {rtsl.bound = array<i32: 1069547520>}
  rtsl.member_decl @tint : vector<3xf32> access "private" {rtsl.bound = array<i32: 1065353216, 0, -2147483648>}
  rtsl.member_decl @isThin : i1 access "public" {rtsl.bound = array<i32: 1>}
  rtsl.member_decl @layers : i32 access "public" {rtsl.bound = array<i32: -3>}
  rtsl.member_decl @weights : !rtsl.array<2 x !rtsl.struct<"Weight", {a: f32, b: vector<2xf32>}>> access "public"
    {rtsl.bound = array<i32: 0, 0, 0, 1065353216, 1073741824, 1077936128>}
  rtsl.member_decl @coat : !rtsl.ref<"rt_Texture"> access "public" {rtsl.bound = array<i32: 64>}
  rtsl.member_decl @depth : f32 access "public"
}

// CHECK-LABEL: func.func @Glass.scalars(
// CHECK-DAG: %[[INDEX:.*]] = arith.constant 1.500000e+00 : f32
// CHECK-DAG: %[[TINT:.*]] = arith.constant dense<[1.000000e+00, 0.000000e+00, -0.000000e+00]> : vector<3xf32>
// CHECK-DAG: %[[THIN:.*]] = arith.constant true
// CHECK-DAG: %[[LAYERS:.*]] = arith.constant -3 : i32
// CHECK: return %[[INDEX]], %[[TINT]], %[[THIN]], %[[LAYERS]]
func.func @Glass.scalars(%self: !rtsl.ref<"Glass">) -> (f32, vector<3xf32>, i1, i32) {
  %0 = rtsl.member %self["index"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<f32>
  %index = rtsl.load %0 : !rtsl.ptr<f32>
  %1 = rtsl.member %self["tint"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<vector<3xf32>>
  %tint = rtsl.load %1 : !rtsl.ptr<vector<3xf32>>
  %2 = rtsl.member %self["isThin"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<i1>
  %thin = rtsl.load %2 : !rtsl.ptr<i1>
  %3 = rtsl.member %self["layers"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<i32>
  %layers = rtsl.load %3 : !rtsl.ptr<i32>
  return %index, %tint, %thin, %layers : f32, vector<3xf32>, i1, i32
}

// CHECK-LABEL: func.func @Glass.parts(
// CHECK: %[[TABLE:.*]] = rtsl.table "weights" [0, 0, 0, 1065353216, 1073741824, 1077936128]
// CHECK: %[[B:.*]] = arith.constant dense<[2.000000e+00, 3.000000e+00]> : vector<2xf32>
// CHECK: %[[AT:.*]] = rtsl.element %[[TABLE]]
// CHECK: %[[FIELD:.*]] = rtsl.field %[[AT]]["a"]
// CHECK: %[[OPEN:.*]] = rtsl.load %[[FIELD]]
// CHECK: return %[[B]], %[[OPEN]]
func.func @Glass.parts(%self: !rtsl.ref<"Glass">, %i: i32) -> (vector<2xf32>, f32) {
  %one = arith.constant 1 : i32
  %0 = rtsl.member %self["weights"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<!rtsl.array<2 x !rtsl.struct<"Weight", {a: f32, b: vector<2xf32>}>>>
  %1 = rtsl.element %0[%one] : !rtsl.ptr<!rtsl.array<2 x !rtsl.struct<"Weight", {a: f32, b: vector<2xf32>}>>> -> !rtsl.ptr<!rtsl.struct<"Weight", {a: f32, b: vector<2xf32>}>>
  %2 = rtsl.field %1["b"] : !rtsl.ptr<!rtsl.struct<"Weight", {a: f32, b: vector<2xf32>}>> -> !rtsl.ptr<vector<2xf32>>
  %b = rtsl.load %2 : !rtsl.ptr<vector<2xf32>>
  %3 = rtsl.element %0[%i] : !rtsl.ptr<!rtsl.array<2 x !rtsl.struct<"Weight", {a: f32, b: vector<2xf32>}>>> -> !rtsl.ptr<!rtsl.struct<"Weight", {a: f32, b: vector<2xf32>}>>
  %4 = rtsl.field %3["a"] : !rtsl.ptr<!rtsl.struct<"Weight", {a: f32, b: vector<2xf32>}>> -> !rtsl.ptr<f32>
  %a = rtsl.load %4 : !rtsl.ptr<f32>
  return %b, %a : vector<2xf32>, f32
}

// CHECK-LABEL: func.func @Glass.loads(
// CHECK: %[[COAT:.*]] = rtsl.load
// CHECK: %[[DEPTH:.*]] = rtsl.load
// CHECK: return %[[COAT]], %[[DEPTH]]
func.func @Glass.loads(%self: !rtsl.ref<"Glass">) -> (!rtsl.ref<"rt_Texture">, f32) {
  %0 = rtsl.member %self["coat"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<!rtsl.ref<"rt_Texture">>
  %coat = rtsl.load %0 : !rtsl.ptr<!rtsl.ref<"rt_Texture">>
  %1 = rtsl.member %self["depth"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<f32>
  %depth = rtsl.load %1 : !rtsl.ptr<f32>
  return %coat, %depth : !rtsl.ref<"rt_Texture">, f32
}

// CHECK-LABEL: func.func @lights(
// CHECK: %[[AMBIENT:.*]] = arith.constant dense<[1.250000e-01, 2.500000e-01, 5.000000e-01]> : vector<3xf32>
// CHECK: %[[COUNT:.*]] = arith.constant 2 : i32
// CHECK: return %[[AMBIENT]], %[[COUNT]]
func.func @lights() -> (vector<3xf32>, i32) {
  %ambient = rtsl.ambient : vector<3xf32>
  %count = rtsl.light_count
  return %ambient, %count : vector<3xf32>, i32
}

// The square of the index is 2.25, and sin(1.5) is our own.
// FOLDED-LABEL: func.func @Glass.folds(
// FOLDED-DAG: %[[SQUARE:.*]] = arith.constant 2.250000e+00 : f32
// FOLDED-DAG: %[[SINE:.*]] = arith.constant 0.997494995 : f32
// FOLDED: return %[[SQUARE]], %[[SINE]]
func.func @Glass.folds(%self: !rtsl.ref<"Glass">) -> (f32, f32) {
  %0 = rtsl.member %self["index"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<f32>
  %index = rtsl.load %0 : !rtsl.ptr<f32>
  %square = arith.mulf %index, %index : f32
  %sine = rtsl.elementary <sin> %index : f32
  return %square, %sine : f32, f32
}
}
