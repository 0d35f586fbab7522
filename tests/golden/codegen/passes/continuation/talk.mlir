// The loop of Robison's talk "Compilation for GPU accelerated ray tracing in OptiX" (2011, slides 37 to 41): five rays from
// (i, 0, 0), scaled by a member. Each of its five steps.
// RUN: rtsl-opt %s | FileCheck %s --check-prefix=COMPILED
// RUN: rtsl-opt %s --rtsl-insert-suspends --rtsl-rematerialise=only-addresses --rtsl-save-live \
// RUN:   | FileCheck %s --check-prefix=CONTINUATIONS
// RUN: rtsl-opt %s --rtsl-insert-suspends --rtsl-rematerialise --rtsl-save-live | FileCheck %s --check-prefix=OPTIMISED
// RUN: rtsl-opt %s --rtsl-split=no-dispatch | FileCheck %s --check-prefix=STATES
// RUN: rtsl-opt %s --rtsl-split=no-dispatch --rtsl-restructure | FileCheck %s --check-prefix=STRUCTURED
// RUN: rtsl-opt %s --rtsl-split | FileCheck %s --check-prefix=MACHINE
// RUN: rtsl-opt %s --rtsl-split=report=text 2>&1 >/dev/null | FileCheck %s --check-prefix=REPORT

rtsl.class @Fan root "rt_Miss" {
  rtsl.member_decl @node : i32 access "public"
}

func.func @Fan.miss(%self: !rtsl.ref<"Fan">) attributes {rtsl.class = "Fan", rtsl.method = "miss"} {
  %zero = arith.constant 0 : i32
  %one = arith.constant 1 : i32 loc("one")
  %five = arith.constant 5 : i32 loc("iend")
  %direction = arith.constant dense<[0.0, 0.0, 1.0]> : vector<3xf32> loc("direction")
  %place = rtsl.member %self["node"] : !rtsl.ref<"Fan"> -> !rtsl.ptr<i32>
  %node = rtsl.load %place : !rtsl.ptr<i32>
  cf.br ^loop(%zero : i32)
^loop(%i: i32 loc("i")):
  %scaled = arith.muli %i, %node : i32
  %x = arith.sitofp %scaled : i32 to f32
  %y = arith.constant 0.0 : f32
  %origin = vector.from_elements %x, %y, %y : vector<3xf32>
  %c = rtsl.trace %origin, %direction : vector<3xf32>
  %next = arith.addi %i, %one : i32
  %again = arith.cmpi ne, %next, %five : i32
  cf.cond_br %again, ^loop(%next : i32), ^done
^done:
  %color = rtsl.state "SampleColor" : !rtsl.ptr<vector<3xf32>>
  rtsl.store %c, %color : !rtsl.ptr<vector<3xf32>>
  return
}

// 1. Compile.
// COMPILED: ^bb1(%[[I:.*]]: i32):
// COMPILED: rtsl.trace
// COMPILED: cf.cond_br %{{.*}}, ^bb1(

// 2. Insert continuations: save everything that is live, and restore it.
// CONTINUATIONS: rtsl.suspend %{{.*}}, %{{.*}}, ^bb2({{.*}} : i32, i32, vector<3xf32>, i32, i32) names ["one", "iend", "direction", "node", "i"]
// CONTINUATIONS-NEXT: ^bb2(%[[ONE:.*]]: i32, %[[END:.*]]: i32, %[[DIRECTION:.*]]: vector<3xf32>, %[[NODE:.*]]: i32, %[[I:.*]]: i32):
// CONTINUATIONS-NEXT: rtsl.trace_result
// CONTINUATIONS-NEXT: %[[NEXT:.*]] = arith.addi %[[I]], %[[ONE]]
// CONTINUATIONS-NEXT: arith.cmpi ne, %[[NEXT]], %[[END]]

// 3. Optimise: one value is saved, i; the rest is computed again.
// OPTIMISED: rtsl.suspend %{{.*}}, %{{.*}}, ^bb2(%{{.*}} : i32) names ["i"]
// OPTIMISED-NEXT: ^bb2(%[[I:.*]]: i32):
// OPTIMISED-NEXT: rtsl.trace_result
// OPTIMISED-DAG: %[[ONE:.*]] = arith.constant 1 : i32
// OPTIMISED-DAG: %[[END:.*]] = arith.constant 5 : i32
// OPTIMISED-DAG: rtsl.member %{{.*}}["node"]
// OPTIMISED: %[[NEXT:.*]] = arith.addi %[[I]], %[[ONE]]
// OPTIMISED-NEXT: arith.cmpi ne, %[[NEXT]], %[[END]]

// 4. Two states; the part of the loop before the trace is in both, and the loop itself is gone.
// STATES-LABEL: func.func private @Fan.miss.state0
// STATES: rtsl.frame_store %{{.*}}, "i"[0] : i32
// STATES-NEXT: rtsl.spawn
// STATES-NEXT: %[[NEXT:.*]] = rtsl.next trace @Fan.miss.state1
// STATES-NEXT: rtsl.end %[[NEXT]]
// STATES-NEXT: }
// STATES-LABEL: func.func private @Fan.miss.state1
// STATES: rtsl.trace_result
// STATES: %[[I:.*]] = rtsl.frame_load "i"[0] : i32
// STATES: %[[NEXT:.*]] = arith.addi %[[I]]
// STATES: cf.cond_br %{{.*}}, ^bb1, ^bb2
// STATES-NEXT: ^bb1:
// STATES: rtsl.load
// STATES: arith.muli %[[NEXT]]
// STATES: rtsl.frame_store %[[NEXT]], "i"[0] : i32
// STATES-NEXT: rtsl.spawn
// STATES-NEXT: rtsl.next trace @Fan.miss.state1
// STATES: ^bb2:
// STATES: rtsl.next done
// STATES-NOT: func.func

// 5. Structured control flow again, for C++: what was the body of the loop is an `if` now.
// STRUCTURED-LABEL: func.func private @Fan.miss.state0
// STRUCTURED-NOT: rtsl.if
// STRUCTURED: rtsl.frame_store %{{.*}}, "i"[0] : i32
// STRUCTURED: rtsl.return %{{.*}} : i32
// STRUCTURED-LABEL: func.func private @Fan.miss.state1
// STRUCTURED: rtsl.trace_result
// STRUCTURED: %[[I:.*]] = rtsl.frame_load "i"[0] : i32
// STRUCTURED: %[[NEXT:.*]] = arith.addi %[[I]]
// STRUCTURED: rtsl.if %{{.*}} {
// STRUCTURED:   arith.muli %[[NEXT]]
// STRUCTURED:   rtsl.frame_store %[[NEXT]], "i"[0] : i32
// STRUCTURED-NEXT: rtsl.spawn
// STRUCTURED-NEXT: %[[AGAIN:.*]] = rtsl.next trace @Fan.miss.state1
// STRUCTURED-NEXT: rtsl.return %[[AGAIN]] : i32
// STRUCTURED-NEXT: }
// STRUCTURED: %[[DONE:.*]] = rtsl.next done
// STRUCTURED-NEXT: rtsl.return %[[DONE]] : i32

// MACHINE: return %c2_i32
// MACHINE-LABEL: func.func @rtsl_run_state(%arg0: i32, %arg1: !rtsl.ref<"object">, %arg2: !rtsl.ptr<i32>) -> i32
// MACHINE: 1: ^[[FIRST:.*]],
// MACHINE-NEXT: 2: ^[[SECOND:.*]]
// MACHINE: ^[[FIRST]]:
// MACHINE: call @Fan.miss.state0
// MACHINE: ^[[SECOND]]:
// MACHINE: call @Fan.miss.state1
// MACHINE-LABEL: func.func @rtsl_frame_size(%arg0: i32) -> i32
// MACHINE-NEXT: arith.constant 4 : i32

// REPORT: Fan.miss: 2 states, frame of 4 bytes
// REPORT-NEXT:   trace at talk.mlir:{{[0-9]+}}:8, resumes at Fan.miss.state1
// REPORT-NEXT:     live           28 bytes: one, iend, direction, node, i
// REPORT-NEXT:     rematerialised 24 bytes: one, iend, direction, node
// REPORT-NEXT:     saved          4 bytes: i
// REPORT-NEXT:     stored         4 bytes
// REPORT-NEXT:     restored       4 bytes
// REPORT-NEXT:     extra          1 operation again, 1 store, 1 load, cost 14; of plain liveness 5 stores, 5 loads, cost 84
// REPORT-NEXT:   slot 0 to 4: i
