//===- CompiledShaders.cpp ------------------------------------------------===//
#include "CompiledShaders.h"

#include "codegen/driver/MachineCode.h"
#include "codegen/driver/Stages.h"
#include "codegen/driver/sources/SourceLoader.h"
#include "rtsl/program.h"
#include "sema/Sema.h"
#include "support/Error.h"

#include <algorithm>

RTSL_DECLARE_SHADERS(numerics); // all files of all rows

namespace rtsl::numerics {

std::string sourceRoot;

namespace {

std::unique_ptr<typed::Module> checkFiles(const std::vector<std::string> &files,
                                          SourceManager &sources, Diagnostics &diagnostics) {
  SourceLoader loader(sources, diagnostics);
  std::vector<const ast::TranslationUnit *> units;
  for (const std::string &file : files)
    if (const ast::TranslationUnit *unit = loader.load(sourceRoot + "/" + file))
      units.push_back(unit);
  return check(
      units,
      [&](const ast::ImportDecl &import, FileId importer) {
        return loader.resolve(import, importer);
      },
      diagnostics);
}

FloatingPoint floatingPointOf(Path path) {
  return path == Path::Fast     ? FloatingPoint::Fast
         : path == Path::Double ? FloatingPoint::Double
                                : FloatingPoint::Strict;
}

} // namespace

CompiledShaders::Compiled
CompiledShaders::compile(const std::vector<std::string> &files, std::vector<std::string> classes,
                         std::vector<std::pair<std::string, std::string>> surfaces, Path path,
                         bool isSampled) {
  if (path == Path::Cpp)
    return {program(numerics_shaders()), ""};
  SourceManager sources;
  Diagnostics diagnostics(sources);
  const std::unique_ptr<typed::Module> module = checkFiles(files, sources, diagnostics);
  LinkRequest request;
  request.classes = std::move(classes);
  request.surfaces = std::move(surfaces);
  request.isSampled = isSampled;
  CompileOptions options;
  options.floatingPoint = floatingPointOf(path);
  Compiled compiled;
  if (!diagnostics.hasErrors()) {
    // On a GPU too this one makes the objects, and computes the memory that a ray takes.
    options.target =
        path == Path::Megakernel || path == Path::Gpu ? Target::HostMegakernel : Target::Host;
    // The bits do not depend on it, and optimising a whole megakernel takes longer than the cases.
    if (path == Path::Megakernel)
      options.optimization = 1;
    compiled.program = compileProgram(*module, request, options, diagnostics);
    if (path == Path::Gpu) {
      CompileInput input;
      input.module = module.get();
      input.scene = &request;
      input.machineCode = &driver::machineCode();
      compiled.ptx = emit(stage("ptx"), input, options, diagnostics).value_or("");
    }
  }
  if (!compiled.program || diagnostics.hasErrors())
    throw Error({ErrorCode::Internal, renderText(diagnostics, false)});
  return compiled;
}

CompiledShaders::CompiledShaders(Compiled made, Path path)
    : path(path), compiled(std::move(made)), theScene(compiled.program) {}

CompiledShaders::CompiledShaders(const std::vector<std::string> &files,
                                 std::vector<std::string> classes,
                                 std::vector<std::pair<std::string, std::string>> surfaces,
                                 Path path, bool isSampled)
    : CompiledShaders(compile(files, std::move(classes), std::move(surfaces), path, isSampled),
                      path) {}

void CompiledShaders::finish() {
  if (!eye)
    eye = path == Path::Megakernel ? megakernelEye()
          : path == Path::Gpu      ? gpuEye(compiled.ptx)
                                   : machineEye();
  eye->turnTo(theScene);
}

runtime::Image CompiledShaders::picture(runtime::RenderOptions options) const {
  options.maxDepth = eyeDepth;
  options.traversal = runtime::Traversal::Device;
  return eye->picture(options);
}

float *CompiledShaders::member(RtslRef object, const std::string &name) const {
  for (const runtime::MemberInfo &member : theScene.classOf(object).members)
    if (member.name == name)
      return reinterpret_cast<float *>(theScene.launch().records + object + member.offset);
  throw Error({ErrorCode::UnknownMember, "there is no member `" + name + "`"});
}

void CompiledShaders::set(RtslRef object, const std::string &name,
                          std::initializer_list<float> values) const {
  std::copy(values.begin(), values.end(), member(object, name));
}

} // namespace rtsl::numerics
