// RUN: rtsl-opt %s --rtsl-insert-suspends --rtsl-trim-vectors --rtsl-rematerialise --rtsl-save-live | FileCheck %s

// One component is read after the trace, so 4 bytes are saved and not 12.
// CHECK-LABEL: func.func @one
// CHECK:        rtsl.suspend %arg0, %arg0, ^bb1(%{{.*}} : f32) names ["v.y"]
// CHECK-NEXT: ^bb1(%[[Y:.*]]: f32):
// CHECK:        return %[[Y]]
func.func @one(%o: vector<3xf32>, %v: vector<3xf32> loc("v")) -> f32 {
  %c = rtsl.trace %o, %o : vector<3xf32>
  %y = vector.extract %v[1] : f32 from vector<3xf32>
  return %y : f32
}

// A part, and the whole: the part costs nothing to take out again.
// CHECK-LABEL: func.func @whole
// CHECK:        names ["v"]
func.func @whole(%o: vector<3xf32>, %v: vector<3xf32> loc("v")) -> (f32, vector<3xf32>) {
  %c = rtsl.trace %o, %o : vector<3xf32>
  %y = vector.extract %v[1] : f32 from vector<3xf32>
  return %y, %v : f32, vector<3xf32>
}

// Through arithmetic: one component of the product is one product of components.
// CHECK-LABEL: func.func @product
// CHECK:        rtsl.suspend %arg0, %arg0, ^bb1(%{{.*}} : f32) names ["v.x"]
// CHECK-NEXT: ^bb1(%[[X:.*]]: f32):
// CHECK-NEXT:   %[[C:.*]] = rtsl.trace_result
// CHECK-NEXT:   %[[CX:.*]] = vector.extract %[[C]][0]
// CHECK-NEXT:   %[[P:.*]] = arith.mulf %[[X]], %[[CX]] : f32
// CHECK-NEXT:   return %[[P]]
func.func @product(%o: vector<3xf32>, %v: vector<3xf32> loc("v")) -> f32 {
  %c = rtsl.trace %o, %o : vector<3xf32>
  %p = arith.mulf %v, %c : vector<3xf32>
  %x = vector.extract %p[0] : f32 from vector<3xf32>
  return %x : f32
}

// Two of its components are two products.
// CHECK-LABEL: func.func @two
// CHECK:        rtsl.suspend %arg0, %arg0, ^bb1(%{{.*}}, %{{.*}} : f32, f32) names ["v.z", "v.x"]
// CHECK-NEXT: ^bb1(%[[Z:.*]]: f32, %[[X:.*]]: f32):
// CHECK-DAG:    %[[CX:.*]] = vector.extract %{{.*}}[0]
// CHECK-DAG:    %[[CZ:.*]] = vector.extract %{{.*}}[2]
// CHECK-DAG:    %[[PX:.*]] = arith.mulf %[[X]], %[[CX]] : f32
// CHECK-DAG:    %[[PZ:.*]] = arith.mulf %[[Z]], %[[CZ]] : f32
// CHECK:        return %[[PX]], %[[PZ]]
func.func @two(%o: vector<3xf32>, %v: vector<3xf32> loc("v")) -> (f32, f32) {
  %c = rtsl.trace %o, %o : vector<3xf32>
  %p = arith.mulf %v, %c : vector<3xf32>
  %x = vector.extract %p[0] : f32 from vector<3xf32>
  %z = vector.extract %p[2] : f32 from vector<3xf32>
  return %x, %z : f32, f32
}

// A swizzle that leaves something out is a part as well.
// CHECK-LABEL: func.func @swizzle
// CHECK:        rtsl.suspend %arg0, %arg0, ^bb1(%{{.*}} : vector<2xf32>)
func.func @swizzle(%o: vector<3xf32>, %v: vector<3xf32>) -> vector<2xf32> {
  %c = rtsl.trace %o, %o : vector<3xf32>
  %xz = vector.shuffle %v, %v [0, 2] : vector<3xf32>, vector<3xf32>
  return %xz : vector<2xf32>
}

// MUTATION trim-vectors of save/TrimVectors.cpp: the first component for whichever is read
// -         components[componentOf(llvm::cast<vector::ExtractOp>(user))]);
// +         components.begin()->second);
