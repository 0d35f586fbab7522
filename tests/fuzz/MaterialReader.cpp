//===- MaterialReader.cpp - any bytes through the reader of MTL files -----===//
//
// As the file of an OBJ model's materials, and each of them as an object of the scene.
//
//===----------------------------------------------------------------------===//
#include "Target.h"

#include "scenefile/obj/Material.h"
#include "support/Error.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

using namespace rtsl;
using namespace rtsl::scene;
using fuzz::require;

namespace {

/// A place counts lines and columns from 1, and lies in the file.
void checkPlace(const Place &place, std::size_t lines) {
  require(place.line <= lines && (place.line == 0 || place.column > 0), "a place lies in the file");
}

void read(const std::string &path, std::size_t lines) {
  const gltf::Mention mention{"model.obj"};
  for (const obj::Material &material : obj::readMaterials(path)) {
    gltf::Modules modules;
    std::vector<Warning> warnings;
    try {
      const JsonValue made =
          obj::materialOf(material, 1, gltf::VertexColors::Rgb, mention, modules, warnings);
      require(made.find("class") != nullptr, "a material is an object of a class");
      require(!modules.empty(), "its class is of the library");
    } catch (const Error &error) {
      require(error.code != ErrorCode::Internal, "an error is the file's");
      if (error.place)
        checkPlace(*error.place, lines);
    }
    for (const Warning &warning : warnings)
      require(!warning.message.empty(), "a warning has a text");
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  const int file = memfd_create("materials", 0);
  require(file >= 0 && write(file, data, size) == static_cast<ssize_t>(size), "a file is written");
  const auto lines = static_cast<std::size_t>(std::count(data, data + size, '\n')) + 1;
  fuzz::attempt([&] { read("/proc/self/fd/" + std::to_string(file), lines); });
  close(file);
  return 0;
}
