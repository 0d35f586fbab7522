//===- Importer.cpp - assimp, in a library of its own ---------------------===//
#include "runtime/geometry/assimp/Importer.h"

#include <assimp/Importer.hpp>
#include <assimp/material.h>
#include <assimp/postprocess.h>

namespace {

class AssimpImporter final : public rtsl::runtime::Importer {
public:
  const aiScene *read(const char *path) override {
    scene = importer.ReadFile(path, aiProcess_Triangulate | aiProcess_SortByPType);
    return scene;
  }

  const char *error() const override { return importer.GetErrorString(); }

  const char *materialName(unsigned index) override {
    name.Clear();
    scene->mMaterials[index]->Get(AI_MATKEY_NAME, name);
    return name.C_Str();
  }

private:
  Assimp::Importer importer;
  const aiScene *scene = nullptr;
  aiString name;
};

bool reads(const char *extension) {
  return Assimp::Importer().IsExtensionSupported(extension);
}

std::unique_ptr<rtsl::runtime::Importer> open() {
  return std::make_unique<AssimpImporter>();
}

} // namespace

extern "C" [[gnu::visibility("default")]] const rtsl::runtime::ImporterLibrary rtslImporterLibrary;
const rtsl::runtime::ImporterLibrary rtslImporterLibrary = {reads, open};
