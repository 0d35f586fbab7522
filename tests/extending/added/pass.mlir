func.func @f(%x: f32) -> f32 {
  %unused = rtsl.var "unused" : !rtsl.ptr<f32>
  %used = rtsl.var "used" : !rtsl.ptr<f32>
  rtsl.store %x, %used : !rtsl.ptr<f32>
  %y = rtsl.load %used : !rtsl.ptr<f32>
  return %y : f32
}
