// RUN: rtsl-opt %s --rtsl-split="no-dispatch" --split-input-file | FileCheck %s --check-prefix=SPLIT
// RUN: rtsl-opt %s --rtsl-split --split-input-file | FileCheck %s --check-prefix=MACHINE

// A filter hands its ray to another one, and that perhaps to the next: each call has a frame of its own, which begins with
// where to go on (16 bytes), then the direction (12), then the color that is given back (12).

// What is not called itself has no such frame. The call ends its state.
// SPLIT-LABEL: func.func private @rtsl_rt_Material_shade.state0(%arg0: !rtsl.ref<"Mirror">)
// SPLIT:         rtsl.enter @follow(%{{.*}}, %{{.*}}) at [16] writes [] then @rtsl_rt_Material_shade.state1 : !rtsl.ref<"Tint">, vector<3xf32>
// SPLIT-NEXT:    %[[N:.*]] = rtsl.next jump @follow.state0
// SPLIT-NEXT:    rtsl.end %[[N]]
// SPLIT-LABEL: func.func private @rtsl_rt_Material_shade.state1(%arg0: !rtsl.ref<"Mirror">)
// SPLIT-NEXT:    %[[C:.*]] = rtsl.call_returned at [28] : vector<3xf32>
// SPLIT-NEXT:    %[[S:.*]] = rtsl.state "SampleColor"
// SPLIT-NEXT:    rtsl.store %[[C]], %[[S]]
// SPLIT:         rtsl.next done
func.func @rtsl_rt_Material_shade(%self: !rtsl.ref<"Mirror">) attributes {rtsl.export, rtsl.slot = "rt_Material.shade"} {
  %fp = rtsl.member %self["filter"] : !rtsl.ref<"Mirror"> -> !rtsl.ptr<!rtsl.ref<"Tint">>
  %f = rtsl.load %fp : !rtsl.ptr<!rtsl.ref<"Tint">>
  %dp = rtsl.state "RayDirection" : !rtsl.ptr<vector<3xf32>>
  %d = rtsl.load %dp : !rtsl.ptr<vector<3xf32>>
  %c = call @follow(%f, %d) : (!rtsl.ref<"Tint">, vector<3xf32>) -> vector<3xf32>
  %s = rtsl.state "SampleColor" : !rtsl.ptr<vector<3xf32>>
  rtsl.store %c, %s : !rtsl.ptr<vector<3xf32>>
  return
}

// The direction is read where it is needed, on both sides of the trace: it is not saved. The color of the ray is
// saved across the call, in the 12 bytes after what was handed over, rounded up to 8.
// SPLIT-LABEL: func.func private @follow.state0(%arg0: !rtsl.ref<"Tint">)
// SPLIT:         %[[D:.*]] = rtsl.call_argument "argument0"[16] : vector<3xf32>
// SPLIT:         rtsl.spawn %[[D]], %[[D]]
// SPLIT-LABEL: func.func private @follow.state1(%arg0: !rtsl.ref<"Tint">)
// SPLIT:         %[[T:.*]] = rtsl.trace_result
// SPLIT:         %[[D:.*]] = rtsl.call_argument "argument0"[16]
// SPLIT:         rtsl.enter @follow({{.*}}, %[[D]]) at [16] writes [] then @follow.state2
// SPLIT-NEXT:    rtsl.frame_store %[[T]], "traced"[40] : vector<3xf32>
// SPLIT-NEXT:    rtsl.next jump @follow.state0
// SPLIT-LABEL: func.func private @follow.state2(%arg0: !rtsl.ref<"Tint">)
// SPLIT:         %[[I:.*]] = rtsl.call_returned at [28] : vector<3xf32>
// SPLIT:         %[[T:.*]] = rtsl.frame_load "traced"[40] : vector<3xf32>
// SPLIT:         %[[R:.*]] = arith.mulf %[[T]], %[[I]]
// SPLIT:         rtsl.call_result %[[R]], [28] : vector<3xf32>
// SPLIT-NEXT:    rtsl.leave
// SPLIT-NEXT:    %[[N:.*]] = rtsl.next return
// SPLIT-NEXT:    rtsl.end %[[N]]
func.func private @follow(%self: !rtsl.ref<"Tint">, %d: vector<3xf32>) -> vector<3xf32> {
  %c = rtsl.trace %d, %d : vector<3xf32>
  %ip = rtsl.member %self["inner"] : !rtsl.ref<"Tint"> -> !rtsl.ptr<!rtsl.ref<"Tint">>
  %i = rtsl.load %ip : !rtsl.ptr<!rtsl.ref<"Tint">>
  %n = call @follow(%i, %d) : (!rtsl.ref<"Tint">, vector<3xf32>) -> vector<3xf32>
  %r = arith.mulf %c, %n : vector<3xf32>
  return %r : vector<3xf32>
}
rtsl.class @Mirror root "rt_Material" {
  rtsl.member_decl @filter : !rtsl.ref<"Tint"> access "public"
}
rtsl.class @Tint root "rt_Texture" {
  rtsl.member_decl @inner : !rtsl.ref<"Tint"> access "public"
}

// The frame of who calls takes no bytes; 52 of `follow` become 56, for addresses have eight. State 3 is where to go on,
// state 2 begins the call.
// MACHINE-LABEL: func.func private @rtsl_rt_Material_shade.state0(
// MACHINE-SAME:    %[[SELF:.*]]: !rtsl.ref<"Mirror">, %[[FRAME:.*]]: !rtsl.ptr<i32>) -> i32
// MACHINE:         rtsl.store %{{.*}}, %{{.*}} : !rtsl.ptr<i32>
// MACHINE:         rtsl.store %[[SELF]], %{{.*}} : !rtsl.ptr<!rtsl.ref<"Mirror">>
// MACHINE:         rtsl.move_frame %{{.*}} to %{{.*}} : !rtsl.ref<"Tint">
// MACHINE-NEXT:    %[[N:.*]] = arith.constant -2 : i32
// MACHINE-NEXT:    return %[[N]]
// MACHINE-LABEL: func.func private @follow.state2(
// MACHINE-NEXT:    rtsl.frame_slot %arg1[84]
// MACHINE:         rtsl.move_frame %{{.*}} to %{{.*}} : !rtsl.ref<"object">
// MACHINE-LABEL: func.func private @rtsl_frame_area(
// MACHINE-DAG:     0: ^bb1(%c0_i32
// MACHINE-DAG:     1: ^bb1(%c52_i32
// MACHINE-DAG:     2: ^bb1(%c108_i32

// MUTATION call-frames of calls/CallFrames.cpp: results lie where arguments do
// -   for (mlir::Type type : results)
// -     place(type, layout.results);
// +   end = RTSL_CALL_HEADER;
// +   for (mlir::Type type : results)
// +     place(type, layout.results);

// MUTATION frame-areas of calls/CallFrames.cpp: a cycle has only one call
// -       most = std::max(most, bytes(call.callee, chain - 1));
// +       most = std::max(most, bytes(call.callee, 0));
