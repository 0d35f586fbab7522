// RUN: rtsl-opt %s --rtsl-insert-suspends --rtsl-save-live | FileCheck %s

// What is used after the trace comes through the suspend; the object does not, it belongs to the ray.
// CHECK-LABEL: func.func @straight
// CHECK-NEXT:   rtsl.suspend %arg1, %arg1, ^bb1(%arg2 : f32) names ["w"]
// CHECK-NEXT: ^bb1(%[[W:.*]]: f32):
// CHECK-NEXT:   rtsl.trace_result
// CHECK-NEXT:   rtsl.class_id %arg0
// CHECK-NEXT:   return %[[W]]
func.func @straight(%self: !rtsl.ref<"M">, %o: vector<3xf32>, %w: f32 loc("w")) -> f32 {
  %c = rtsl.trace %o, %o : vector<3xf32>
  %id = rtsl.class_id %self : !rtsl.ref<"M">
  return %w : f32
}

// Where ways with and without a trace meet, the two definitions do.
// CHECK-LABEL: func.func @branch
// CHECK-NEXT:   cf.cond_br %arg3, ^bb1, ^bb3(%arg2 : f32)
// CHECK:        rtsl.suspend %arg1, %arg1, ^bb2(%arg2 : f32) names ["w"]
// CHECK-NEXT: ^bb2(%[[BACK:.*]]: f32):
// CHECK:        cf.br ^bb3(%[[BACK]] : f32)
// CHECK-NEXT: ^bb3(%[[W:.*]]: f32):
// CHECK-NEXT:   return %[[W]]
func.func @branch(%self: !rtsl.ref<"M">, %o: vector<3xf32>, %w: f32 loc("w"), %p: i1) -> f32 {
  cf.cond_br %p, ^trace, ^done
^trace:
  %c = rtsl.trace %o, %o : vector<3xf32>
  cf.br ^done
^done:
  return %w : f32
}

// Two values that are called the same get two names, each its own over all traces.
// CHECK-LABEL: func.func @names
// CHECK:        names ["w", "w.2"]
// CHECK:        names ["w.2"]
func.func @names(%self: !rtsl.ref<"M">, %o: vector<3xf32>, %a: f32 loc("w"), %b: f32 loc("w")) -> f32 {
  %c = rtsl.trace %o, %o : vector<3xf32>
  %v = vector.broadcast %a : f32 to vector<3xf32>
  %d = rtsl.trace %v, %v : vector<3xf32>
  return %b : f32
}

// MUTATION liveness of common/Liveness.cpp: what is defined in a block is live in front of it
// -       live.reset(sets.defined);

// MUTATION ssa-repair of common/SsaRepair.cpp: definitions that meet are not told apart
// -         several |= unique && unique != incoming;
// -         unique = incoming;
// -       }
// -       if (several) {
// +         unique = incoming;
// +       }
// +       if (several) {

// MUTATION save-live of save/SaveLive.cpp: a value goes by its plain name, although another has it
// - const std::string &name = names.of(value);
// + const std::string name = sourceName(value);
