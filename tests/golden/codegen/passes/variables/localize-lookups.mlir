// RUN: rtsl-opt %s --rtsl-localize-lookups | FileCheck %s
// What textures store is a variable of the function that looks them up.

// A texture stores for its caller.
// CHECK-LABEL: func.func private @Wood.lookup
// CHECK:         rtsl.store %{{.*}}, %TextureColor
func.func private @Wood.lookup(%color: vector<3xf32>) attributes {rtsl.in_lookup} {
  %TextureColor = rtsl.state "TextureColor" : !rtsl.ptr<vector<3xf32>>
  rtsl.store %color, %TextureColor : !rtsl.ptr<vector<3xf32>>
  return
}

// CHECK-LABEL: func.func @inlined
// CHECK:         %[[COLOR:.*]] = rtsl.var "TextureColor"
// CHECK-NOT:     rtsl.state
// CHECK-COUNT-2: rtsl.store %{{.*}}, %[[COLOR]]
// CHECK:         rtsl.load %[[COLOR]]
func.func @inlined(%zero: vector<3xf32>, %color: vector<3xf32>) -> vector<3xf32> {
  %TextureColor = rtsl.state "TextureColor" : !rtsl.ptr<vector<3xf32>>
  rtsl.store %zero, %TextureColor : !rtsl.ptr<vector<3xf32>>
  rtsl.store %color, %TextureColor : !rtsl.ptr<vector<3xf32>>
  %found = rtsl.load %TextureColor : !rtsl.ptr<vector<3xf32>>
  return %found : vector<3xf32>
}

// A call has the state.
// CHECK-LABEL: func.func @called
// CHECK:         %[[COLOR:.*]] = rtsl.var "TextureColor"
// CHECK-NEXT:    rtsl.store %arg0, %[[COLOR]]
// CHECK-NEXT:    %[[STATE:.*]] = rtsl.state "TextureColor"
// CHECK-NEXT:    %[[BEFORE:.*]] = rtsl.load %[[COLOR]]
// CHECK-NEXT:    rtsl.store %[[BEFORE]], %[[STATE]]
// CHECK-NEXT:    call @Wood.lookup
// CHECK-NEXT:    %[[AFTER:.*]] = rtsl.load %[[STATE]]
// CHECK-NEXT:    rtsl.store %[[AFTER]], %[[COLOR]]
// CHECK-NEXT:    rtsl.load %[[COLOR]]
func.func @called(%zero: vector<3xf32>, %color: vector<3xf32>) -> vector<3xf32> {
  %TextureColor = rtsl.state "TextureColor" : !rtsl.ptr<vector<3xf32>>
  rtsl.store %zero, %TextureColor : !rtsl.ptr<vector<3xf32>>
  call @Wood.lookup(%color) : (vector<3xf32>) -> ()
  %found = rtsl.load %TextureColor : !rtsl.ptr<vector<3xf32>>
  return %found : vector<3xf32>
}
