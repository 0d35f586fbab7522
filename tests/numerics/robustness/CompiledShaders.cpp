//===- CompiledShaders.cpp ------------------------------------------------===//
#include "CompiledShaders.h"

#include "frontend/Parser.h"
#include "runtime/AtomicFile.h"
#include "runtime/Error.h"
#include "sema/Sema.h"

#include <limits>

namespace rtsl::numerics {

std::string sourceRoot;

namespace {

std::shared_ptr<const runtime::Program> compile(const std::vector<std::string> &files, const LinkRequest &request, FloatingPoint floatingPoint) {
  SourceManager sources;
  Diagnostics diagnostics(sources);
  std::vector<std::unique_ptr<ast::TranslationUnit>> trees;
  std::vector<const ast::TranslationUnit *> units;
  for (const std::string &file : files) {
    const std::string path = sourceRoot + "/" + file;
    trees.push_back(parse(sources.add(path, runtime::readFile(path)), diagnostics));
    units.push_back(trees.back().get());
  }
  const auto noImports = [](const ast::ImportDecl &, FileId) -> const ast::TranslationUnit * { return nullptr; };
  const std::unique_ptr<typed::Module> module = check(units, noImports, diagnostics);
  CompileOptions options;
  options.floatingPoint = floatingPoint;
  std::shared_ptr<const runtime::Program> program;
  if (!diagnostics.hasErrors())
    program = compileProgram(*module, request, options, diagnostics);
  if (!program)
    throw runtime::Error(runtime::ErrorCode::Internal, renderText(diagnostics, false));
  return program;
}

LinkRequest requestFor(std::vector<std::string> classes, std::vector<std::pair<std::string, std::string>> surfaces) {
  LinkRequest request;
  request.classes = std::move(classes);
  request.surfaces = std::move(surfaces);
  for (Item item : {Item::Methods, Item::States, Item::Outputs}) // rows call methods that no ray of a scene would start
    request.keep.add(item);
  return request;
}

} // namespace

CompiledShaders::CompiledShaders(const std::vector<std::string> &files, std::vector<std::string> classes,
                                 std::vector<std::pair<std::string, std::string>> surfaces, FloatingPoint floatingPoint)
    : theScene(compile(files, requestFor(std::move(classes), std::move(surfaces)), floatingPoint)) {}

RtslState CompiledShaders::ray() const {
  RtslState state{};
  state.launch = &launch;
  state.instance = state.primitive = RTSL_NO_HIT;
  state.rayMask = ~0u;
  state.HitDistance = std::numeric_limits<float>::infinity();
  return state;
}

float *CompiledShaders::member(RtslRef object, const std::string &name) const {
  for (const runtime::MemberInfo &member : theScene.classOf(object).members)
    if (member.name == name)
      return reinterpret_cast<float *>(launch.records + object + member.offset);
  throw runtime::Error(runtime::ErrorCode::UnknownMember, "there is no member `" + name + "`");
}

} // namespace rtsl::numerics
