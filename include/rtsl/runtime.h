//===- runtime.h - scenes and pictures of compiled shaders ----------------===//
//
// The whole C++ interface of the runtime library: rtsl::runtime::Scene, Mesh, render, writeImage and
// what they throw. examples/cpp-api shows it at work.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "rtsl/program.h"
#include "runtime/Error.h"
#include "runtime/Image.h"
#include "runtime/Mesh.h"
#include "runtime/PrintLog.h"
#include "runtime/Renderer.h"
#include "runtime/Scene.h"
