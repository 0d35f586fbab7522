// What is reached after several traces gets a state of its own where its copies come to more than the function.
// RUN: rtsl-opt %s --rtsl-insert-suspends --rtsl-cut-joins="free=0 copies=1 shortest=1" | FileCheck %s
// RUN: rtsl-opt %s --rtsl-insert-suspends --rtsl-cut-joins | FileCheck %s --check-prefix=FEW
// RUN: rtsl-opt %s --rtsl-insert-suspends --rtsl-cut-joins="free=0 copies=1 shortest=1" --rtsl-save-live --rtsl-layout-frame --rtsl-split-states | FileCheck %s --check-prefix=STATES

// CHECK-LABEL: func.func @twice
// CHECK:         rtsl.suspend ^[[REST:bb[0-9]+]] {rtsl.join}
// CHECK-NEXT:  ^[[REST]]:
// CHECK-NEXT:    rtsl.trace_returned
// CHECK-NEXT:    rtsl.state "SampleColor"
// CHECK-NOT:     rtsl.join

// FEW-LABEL: func.func @twice
// FEW-NOT:     rtsl.join

// No ray is sent: the state jumps, and the value that is stored there comes through the frame.
// STATES:      rtsl.frame_store %{{.*}}, "c"
// STATES-NEXT: rtsl.next jump @twice.state[[REST:[0-9]+]]
// STATES:      func.func private @twice.state[[REST]]
// STATES:        rtsl.frame_load "c"
func.func @twice(%self: !rtsl.ref<"M">) {
  %a = rtsl.state "HitPoint" : !rtsl.ptr<vector<3xf32>>
  %o = rtsl.load %a : !rtsl.ptr<vector<3xf32>>
  %x = rtsl.rand
  %y = rtsl.rand
  %p = arith.cmpf olt, %x, %y : f32
  cf.cond_br %p, ^first, ^then(%o : vector<3xf32>)
^first:
  %c1 = rtsl.trace %o, %o : vector<3xf32>
  cf.br ^then(%c1 : vector<3xf32>)
^then(%b: vector<3xf32> loc("b")):
  %z = rtsl.rand
  %q = arith.cmpf olt, %z, %y : f32
  cf.cond_br %q, ^second, ^rest(%b : vector<3xf32>)
^second:
  %c2 = rtsl.trace %o, %b : vector<3xf32>
  cf.br ^rest(%c2 : vector<3xf32>)
^rest(%c: vector<3xf32> loc("c")):
  %s = rtsl.state "SampleColor" : !rtsl.ptr<vector<3xf32>>
  rtsl.store %c, %s : !rtsl.ptr<vector<3xf32>>
  return
}
