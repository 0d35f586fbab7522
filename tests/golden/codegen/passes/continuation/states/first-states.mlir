// RUN: rtsl-opt %s --rtsl-dispatch | FileCheck %s

// An entry point that only jumps is left out; its first state is where it jumps to.
// CHECK-NOT: @generate.state0
func.func private @generate.state0(%o: !rtsl.ref<"rt_RayGeneration">) -> i32 attributes {rtsl.entry = "rtsl_rt_RayGeneration_generate", rtsl.state = 0 : i32} {
  %n = rtsl.next jump @Eye.state0
  rtsl.end %n
}

// Where a ray begins at an entry point of several classes: the state of the method, or the entry point itself. The
// numbers are those of @shade.state0, @Glass.state0 and @Eye.state0.
// CHECK-LABEL: func.func private @shade.state0.first(%arg0: !rtsl.ref<"rt_Material">) -> i32
// CHECK:         cf.switch %{{.*}} : i32, [
// CHECK-NEXT:      default: ^[[NONE:bb[0-9]+]],
// CHECK-NEXT:      3: ^[[GREY:bb[0-9]+]],
// CHECK-NEXT:      4: ^[[GLASS:bb[0-9]+]]
// CHECK:       ^[[GREY]]:
// CHECK-NEXT:    %[[ITSELF:.*]] = arith.constant 1 : i32
// CHECK-NEXT:    return %[[ITSELF]]
// CHECK:       ^[[GLASS]]:
// CHECK-NEXT:    %[[METHOD:.*]] = arith.constant 2 : i32
// CHECK-NEXT:    return %[[METHOD]]
// CHECK:       ^[[NONE]]:
// CHECK-NEXT:    %[[ENTRY:.*]] = arith.constant 1 : i32
// CHECK-NEXT:    return %[[ENTRY]]

// One that looks at the class of its object stays, for the classes whose methods it does itself.
// CHECK-LABEL: func.func private @shade.state0
func.func private @shade.state0(%o: !rtsl.ref<"rt_Material">) -> i32 attributes {rtsl.entry = "rtsl_rt_Material_shade", rtsl.state = 0 : i32} {
  %id = rtsl.class_id %o : !rtsl.ref<"rt_Material">
  cf.switch %id : i32, [
    default: ^none,
    3: ^grey,
    4: ^glass
  ]
^grey:
  %light = arith.constant 1.0 : f32
  %time = rtsl.state "Time" : !rtsl.ptr<f32>
  rtsl.store %light, %time : !rtsl.ptr<f32>
  cf.br ^late
^late:  // reached with effects: the entry point itself runs
  %g = rtsl.next jump @Glass.state0
  rtsl.end %g
^glass:
  %n = rtsl.next jump @Glass.state0
  rtsl.end %n
^none:
  %d = rtsl.next done
  rtsl.end %d
}

func.func private @Glass.state0(%o: !rtsl.ref<"Glass">) -> i32 attributes {rtsl.state = 0 : i32} {
  %n = rtsl.next done
  rtsl.end %n
}
func.func private @Eye.state0(%o: !rtsl.ref<"Eye">) -> i32 attributes {rtsl.state = 0 : i32} {
  %n = rtsl.next done
  rtsl.end %n
}

// CHECK-LABEL: func.func @rtsl_first_state(%arg0: i32, %arg1: !rtsl.ref<"object">) -> i32
// CHECK:         cf.switch %arg0 : i32, [
// CHECK-NEXT:      default: ^[[SAME:bb[0-9]+]],
// CHECK-NEXT:      1: ^[[CHOICE:bb[0-9]+]]
// CHECK:       ^[[SAME]]:
// CHECK-NEXT:    return %arg0
// CHECK:       ^[[CHOICE]]:
// CHECK:         %[[FIRST:.*]] = call @shade.state0.first
// CHECK-NEXT:    return %[[FIRST]]

// CHECK-LABEL: func.func @rtsl_rt_Material_shade_first
// CHECK-NEXT:    arith.constant 1 : i32
// CHECK-LABEL: func.func @rtsl_rt_RayGeneration_generate_first
// CHECK-NEXT:    arith.constant 3 : i32
