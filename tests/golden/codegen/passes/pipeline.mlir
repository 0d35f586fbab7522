// A dielectric as lowering leaves it, through the whole of level 2. The result is read in pipeline.mlir.expected.
// RUN: rtsl-opt %s --rtsl-ssa | diff %s.expected -

!frame = !rtsl.struct<"Frame", {normal: vector<3xf32>, entering: i1}>

rtsl.class @Glass root "rt_Material" {
  rtsl.member_decl @eta : f32 access "public"
  rtsl.member_decl @tint : vector<3xf32> access "public"
}

// Writes its result through the leading address, as functions that return structs do.
func.func private @frameOf(%result: !rtsl.ptr<!frame>, %n: vector<3xf32>, %d: vector<3xf32>) {
  %zero = arith.constant 0.0 : f32
  %frame = rtsl.var "frame" : !rtsl.ptr<!frame>
  %product = arith.mulf %n, %d : vector<3xf32>
  %x = vector.extract %product[0] : f32 from vector<3xf32>
  %y = vector.extract %product[1] : f32 from vector<3xf32>
  %z = vector.extract %product[2] : f32 from vector<3xf32>
  %xy = arith.addf %x, %y : f32
  %dot = arith.addf %xy, %z : f32
  %inside = arith.cmpf olt, %dot, %zero : f32
  %entering = rtsl.field %frame["entering"] : !rtsl.ptr<!frame> -> !rtsl.ptr<i1>
  rtsl.store %inside, %entering : !rtsl.ptr<i1>
  %normal = rtsl.field %frame["normal"] : !rtsl.ptr<!frame> -> !rtsl.ptr<vector<3xf32>>
  rtsl.store %n, %normal : !rtsl.ptr<vector<3xf32>>
  rtsl.if %inside {
    rtsl.copy %frame to %result : !rtsl.ptr<!frame>
    rtsl.return
  }
  %flipped = arith.negf %n : vector<3xf32>
  rtsl.store %flipped, %normal : !rtsl.ptr<vector<3xf32>>
  rtsl.copy %frame to %result : !rtsl.ptr<!frame>
  rtsl.return
}

func.func @Glass.shade(%self: !rtsl.ref<"Glass">) attributes {rtsl.class = "Glass", rtsl.method = "shade"} {
  %np = rtsl.state "ShadingNormal" : !rtsl.ptr<vector<3xf32>>
  %n = rtsl.load %np : !rtsl.ptr<vector<3xf32>>
  %dp = rtsl.state "RayDirection" : !rtsl.ptr<vector<3xf32>>
  %d = rtsl.load %dp : !rtsl.ptr<vector<3xf32>>
  %hp = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %h = rtsl.load %hp : !rtsl.ptr<vector<3xf32>>
  %out = rtsl.state "SampleColor" : !rtsl.ptr<vector<3xf32>>

  %frame = rtsl.var "frame" : !rtsl.ptr<!frame>
  func.call @frameOf(%frame, %n, %d) : (!rtsl.ptr<!frame>, vector<3xf32>, vector<3xf32>) -> ()
  %normal = rtsl.field %frame["normal"] : !rtsl.ptr<!frame> -> !rtsl.ptr<vector<3xf32>>
  %nf = rtsl.load %normal : !rtsl.ptr<vector<3xf32>>
  %color = rtsl.var "color" : !rtsl.ptr<vector<3xf32>>
  %reflected = arith.addf %d, %nf : vector<3xf32>
  %c0 = rtsl.trace %h, %reflected : vector<3xf32>
  rtsl.store %c0, %color : !rtsl.ptr<vector<3xf32>>
  %entering = rtsl.field %frame["entering"] : !rtsl.ptr<!frame> -> !rtsl.ptr<i1>
  %e = rtsl.load %entering : !rtsl.ptr<i1>
  rtsl.if %e {
    %etap = rtsl.member %self["eta"] : !rtsl.ref<"Glass"> -> !rtsl.ptr<f32>
    %eta = rtsl.load %etap : !rtsl.ptr<f32>
    %etas = vector.broadcast %eta : f32 to vector<3xf32>
    %refracted = arith.mulf %d, %etas : vector<3xf32>
    %c1 = rtsl.trace %h, %refracted : vector<3xf32>
    %c = rtsl.load %color : !rtsl.ptr<vector<3xf32>>
    %sum = arith.addf %c, %c1 : vector<3xf32>
    rtsl.store %sum, %color : !rtsl.ptr<vector<3xf32>>
    rtsl.yield
  }
  %c = rtsl.load %color : !rtsl.ptr<vector<3xf32>>
  rtsl.store %c, %out : !rtsl.ptr<vector<3xf32>>
  rtsl.return
}
