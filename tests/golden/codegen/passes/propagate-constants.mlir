// RUN: rtsl-opt %s --rtsl-propagate-constants | FileCheck %s

// An index that is 0 when it is first evaluated stays variable.
// CHECK-LABEL: func.func @variableIndex
// CHECK: vector.extract %{{.*}}[%[[I:.*]]] : i1 from vector<2xi1>
// CHECK: vector.insert %{{.*}}, %{{.*}} [%[[I]]] : i1 into vector<2xi1>
func.func @variableIndex(%count: i32) -> vector<2xi1> {
  %table = arith.constant dense<[false, true]> : vector<2xi1>
  %zero = arith.constant 0 : i32
  %one = arith.constant 1 : i32
  cf.br ^loop(%zero, %table : i32, vector<2xi1>)
^loop(%i: i32, %sum: vector<2xi1>):
  %index = arith.index_castui %i : i32 to index
  %element = vector.extract %table[%index] : i1 from vector<2xi1>
  %next = vector.insert %element, %table [%index] : i1 into vector<2xi1>
  %j = arith.addi %i, %one : i32
  %more = arith.cmpi ult, %j, %count : i32
  cf.cond_br %more, ^loop(%j, %next : i32, vector<2xi1>), ^end
^end:
  return %next : vector<2xi1>
}

// What each turn of a loop leaves as it is, is constant.
// CHECK-LABEL: func.func @throughALoop
// CHECK: %[[FIVE:.*]] = arith.constant 5 : i32
// CHECK: return %[[FIVE]]
func.func @throughALoop(%count: i32) -> i32 {
  %zero = arith.constant 0 : i32
  %one = arith.constant 1 : i32
  %five = arith.constant 5 : i32
  cf.br ^loop(%zero, %five : i32, i32)
^loop(%i: i32, %v: i32):
  %isFive = arith.cmpi eq, %v, %five : i32
  cf.cond_br %isFive, ^same, ^other
^same:
  cf.br ^more(%v : i32)
^other:
  cf.br ^more(%i : i32)
^more(%w: i32):
  %j = arith.addi %i, %one : i32
  %more = arith.cmpi ult, %j, %count : i32
  cf.cond_br %more, ^loop(%j, %w : i32, i32), ^end
^end:
  return %w : i32
}
