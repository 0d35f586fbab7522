// RUN: rtsl-opt %s --rtsl-share-calls | FileCheck %s
// What functions compute wherever they are called, their callers compute, once.

!self = !rtsl.ref<"Coated">
!layers = !rtsl.struct<"Layers", {base: vector<3xf32>, alpha: f32}>

rtsl.class @Coated root "rt_Material" {
  rtsl.member_decl @inner : !rtsl.ref<"Coated"> access "public"
}

// CHECK-LABEL: func.func private @layers
func.func private @layers(%self: !self, %result: !rtsl.ptr<!layers>) {
  %state = rtsl.state "TextureUV" : !rtsl.ptr<vector<2xf32>>
  %uv = rtsl.load %state : !rtsl.ptr<vector<2xf32>>
  %u = vector.extract %uv[0] : f32 from vector<2xf32>
  %alpha = rtsl.field %result["alpha"] : !rtsl.ptr<!layers> -> !rtsl.ptr<f32>
  rtsl.store %u, %alpha : !rtsl.ptr<f32>
  %color = vector.broadcast %u : f32 to vector<3xf32>
  %base = rtsl.field %result["base"] : !rtsl.ptr<!layers> -> !rtsl.ptr<vector<3xf32>>
  rtsl.store %color, %base : !rtsl.ptr<vector<3xf32>>
  return
}

// It is called on each path, so its callers call it, and pass the part that is read.
// CHECK-LABEL: func.func private @value
// CHECK-SAME:      (%{{.*}}: !rtsl.ref<"Coated">, %[[COSINE:.*]]: f32, %[[BASE:.*]]: vector<3xf32>)
// CHECK-NOT:     call
// CHECK:         return
func.func private @value(%self: !self, %cosine: f32) -> vector<3xf32> {
  %zero = arith.constant 0.0 : f32
  %black = arith.constant dense<0.0> : vector<3xf32>
  %layers = rtsl.var "layers" : !rtsl.ptr<!layers>
  call @layers(%self, %layers) : (!self, !rtsl.ptr<!layers>) -> ()
  %isLit = arith.cmpf olt, %zero, %cosine : f32
  cf.cond_br %isLit, ^lit, ^end(%black : vector<3xf32>)
^lit:
  %base = rtsl.field %layers["base"] : !rtsl.ptr<!layers> -> !rtsl.ptr<vector<3xf32>>
  %color = rtsl.load %base : !rtsl.ptr<vector<3xf32>>
  cf.br ^end(%color : vector<3xf32>)
^end(%result: vector<3xf32>):
  return %result : vector<3xf32>
}

// Not on each path: it stays.
// CHECK-LABEL: func.func private @sometimes
// CHECK-SAME:      (%{{.*}}: !rtsl.ref<"Coated">, %{{.*}}: f32) -> f32
// CHECK:         call @layers
func.func private @sometimes(%self: !self, %cosine: f32) -> f32 {
  %zero = arith.constant 0.0 : f32
  %layers = rtsl.var "layers" : !rtsl.ptr<!layers>
  %isLit = arith.cmpf olt, %zero, %cosine : f32
  cf.cond_br %isLit, ^lit, ^end(%zero : f32)
^lit:
  call @layers(%self, %layers) : (!self, !rtsl.ptr<!layers>) -> ()
  %alpha = rtsl.field %layers["alpha"] : !rtsl.ptr<!layers> -> !rtsl.ptr<f32>
  %a = rtsl.load %alpha : !rtsl.ptr<f32>
  cf.br ^end(%a : f32)
^end(%result: f32):
  return %result : f32
}

// The object is a member, which the callers load.
// CHECK-LABEL: func.func private @inner
// CHECK-SAME:      (%{{.*}}: !rtsl.ref<"Coated">, %{{.*}}: f32)
// CHECK-NOT:     call
// CHECK:         return
func.func private @inner(%self: !self) -> f32 {
  %inner = rtsl.member %self["inner"] : !self -> !rtsl.ptr<!self>
  %object = rtsl.load %inner : !rtsl.ptr<!self>
  %layers = rtsl.var "layers" : !rtsl.ptr<!layers>
  call @layers(%object, %layers) : (!self, !rtsl.ptr<!layers>) -> ()
  %alpha = rtsl.field %layers["alpha"] : !rtsl.ptr<!layers> -> !rtsl.ptr<f32>
  %a = rtsl.load %alpha : !rtsl.ptr<f32>
  return %a : f32
}

// It changes what is read: it stays.
// CHECK-LABEL: func.func private @changes
// CHECK:         call @layers
func.func private @changes(%self: !self) -> f32 {
  %uv = arith.constant dense<1.0> : vector<2xf32>
  %state = rtsl.state "TextureUV" : !rtsl.ptr<vector<2xf32>>
  rtsl.store %uv, %state : !rtsl.ptr<vector<2xf32>>
  %layers = rtsl.var "layers" : !rtsl.ptr<!layers>
  call @layers(%self, %layers) : (!self, !rtsl.ptr<!layers>) -> ()
  %alpha = rtsl.field %layers["alpha"] : !rtsl.ptr<!layers> -> !rtsl.ptr<f32>
  %a = rtsl.load %alpha : !rtsl.ptr<f32>
  return %a : f32
}

// Two calls of `value` share one of `layers`, and two of `inner` another one.
// CHECK-LABEL: func.func @shade
// CHECK:         call @layers
// CHECK-COUNT-2: call @value
// CHECK-NOT:     call @layers
// CHECK:         rtsl.member %{{.*}}["inner"]
// CHECK:         call @layers
// CHECK-NOT:     call @layers
// CHECK:         call @inner
// CHECK-NOT:     call
// CHECK:         return
func.func @shade(%self: !self, %a: f32, %b: f32) -> (vector<3xf32>, f32) {
  %x = call @value(%self, %a) : (!self, f32) -> vector<3xf32>
  %y = call @value(%self, %b) : (!self, f32) -> vector<3xf32>
  %color = arith.addf %x, %y : vector<3xf32>
  %v = call @inner(%self) : (!self) -> f32
  %w = call @inner(%self) : (!self) -> f32
  %sum = arith.addf %v, %w : f32
  return %color, %sum : vector<3xf32>, f32
}

// CHECK-LABEL: func.func @others
// CHECK-NOT:     call @layers
// CHECK:         return
func.func @others(%self: !self, %a: f32) -> f32 {
  %x = call @sometimes(%self, %a) : (!self, f32) -> f32
  %y = call @sometimes(%self, %x) : (!self, f32) -> f32
  %v = call @changes(%self) : (!self) -> f32
  %w = call @changes(%self) : (!self) -> f32
  %sum = arith.addf %v, %w : f32
  %all = arith.addf %sum, %y : f32
  return %all : f32
}
