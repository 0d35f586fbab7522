// The records, instances and emitters of a bound scene are constants of its program, and members are loaded from there.
// RUN: rtsl-opt %s --rtsl-to-llvm | FileCheck %s
// RUN: rtsl-opt %s --rtsl-to-llvm | mlir-translate --mlir-to-llvmir | FileCheck %s --check-prefix=LLVM

// CHECK-NOT: rtsl.records =
// CHECK-DAG: llvm.mlir.global internal constant @rtsl.records(dense<[0, 0, 0, 0, 1, 1065353216]> : tensor<6xi32>) {addr_space = 0 : i32, alignment = 16 : i64}
// CHECK-DAG: llvm.mlir.global internal constant @rtsl.instances(dense<[16, 7]> : tensor<2xi32>)
// LLVM-DAG: @rtsl.records = internal constant [6 x i32]
// LLVM: define weak_odr ptr @rtsl_instances(ptr %{{.*}})
// LLVM: ret ptr @rtsl.instances
// LLVM: define weak_odr i32 @rtsl_emitter_count(ptr %{{.*}})
// LLVM: ret i32 1
// LLVM: define weak_odr ptr @rtsl_emitters(ptr %{{.*}})
// LLVM: ret ptr @rtsl.emitters
// LLVM: define weak_odr i32 @rtsl_emitters_have_parts(ptr %{{.*}})
// LLVM: ret i32 0
// LLVM: define weak_odr i32 @rtsl_listed_instances(ptr %{{.*}})
// LLVM: ret i32 1
// LLVM: define weak_odr ptr @rtsl_listed_boxes(ptr %{{.*}})
// LLVM: ret ptr @rtsl.listed_boxes
module attributes {rtsl.records = array<i32: 0, 0, 0, 0, 1, 1065353216>, rtsl.instances = array<i32: 16, 7>, rtsl.emitters = array<i32: 1, 0, 1065353216, 0, 0>, rtsl.whole_emitters, rtsl.listed_boxes = array<i32: 1, 2, 3, 0, 4, 5, 6, 0>} {
  rtsl.class @Ball root "rt_Primitive" {
    rtsl.member_decl @radius : f32 access "public"
  }
  // CHECK-LABEL: llvm.func @Ball.read(
  // CHECK: %[[RECORDS:.*]] = llvm.mlir.addressof @rtsl.records : !llvm.ptr
  // CHECK: llvm.getelementptr inbounds{{.*}} %[[RECORDS]]
  func.func @Ball.read(%self: !rtsl.ref<"Ball">) -> f32 {
    %member = rtsl.member %self["radius"] : !rtsl.ref<"Ball"> -> !rtsl.ptr<f32>
    %radius = rtsl.load %member : !rtsl.ptr<f32>
    return %radius : f32
  }
}
