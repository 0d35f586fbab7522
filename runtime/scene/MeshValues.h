//===- MeshValues.h - named attributes of a mesh as a program reads them --===//
#pragma once

#include "runtime/geometry/Mesh.h"
#include "runtime/scene/Objects.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::runtime {

/// RtslLaunch::meshAttributes of a program.
std::vector<RtslMeshAttribute> attributesOf(const Program &program);

/// The first attribute of this name that the program reads of meshes; null: none.
const AttributeInfo *findAttribute(const Program &program, const std::string &name);

/// What to read of the files of meshes for a program.
MeshRequest requestOf(const Program &program);

/// Throws MissingMember if the mesh does not have one of the attributes that the material reads,
/// `wanted` of Program::meshAttributes, and WrongType if it is of another type. `name` is the
/// mesh's.
void requireAttributes(const Mesh &mesh, const std::string &name, const Program &program,
                       std::uint32_t wanted, const Objects::Object &material);

/// RtslMesh::attributes. The values are the mesh's own, unless they are of another type: an
/// attribute of integers may be read as floats, and red, green and blue as a color.
class MeshValues {
public:
  MeshValues() = default;
  MeshValues(const Mesh &mesh, const Program &program, std::uint32_t wanted);

  std::uint32_t wanted() const { return bits; }
  /// The values; null: there are none.
  const RtslMeshValues *table() const { return values.empty() ? nullptr : values.data(); }
  /// Is it one of those that are wanted?
  bool isRead(const NamedAttribute &attribute, const Program &program) const;

private:
  std::uint32_t bits = 0; // of Program::meshAttributes
  std::vector<RtslMeshValues> values;
  std::vector<std::vector<std::uint32_t>> converted; // owns those that are not the mesh's
};

} // namespace rtsl::runtime
