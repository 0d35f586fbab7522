//===- runtime.h - scenes and images of compiled shaders ------------------===//
//
// The whole C++ interface of the runtime library: rtsl::runtime::Scene, Mesh, render, writeImage
// and the exceptions that they throw. examples/cpp-api is an example.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "rtsl/program.h"
#include "runtime/geometry/Mesh.h"
#include "runtime/image/Image.h"
#include "runtime/program/PrintLog.h"
#include "runtime/render/Renderer.h"
#include "runtime/scene/MeshValues.h"
#include "runtime/scene/Scene.h"
#include "support/Error.h"

namespace rtsl::runtime {
using rtsl::Error;
using rtsl::ErrorCode;
} // namespace rtsl::runtime
