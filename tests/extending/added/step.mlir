func.func @f(%i: i32) -> f32 {
  %unused = rtsl.table "unused" [0, 1] : !rtsl.ptr<!rtsl.array<2 x f32>>
  %used = rtsl.table "used" [0, 1] : !rtsl.ptr<!rtsl.array<2 x f32>>
  %element = rtsl.element %used[%i] : !rtsl.ptr<!rtsl.array<2 x f32>> -> !rtsl.ptr<f32>
  %y = rtsl.load %element : !rtsl.ptr<f32>
  return %y : f32
}
