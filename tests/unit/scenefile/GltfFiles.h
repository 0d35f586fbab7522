//===- GltfFiles.h - small glTF files, for tests --------------------------===//
#pragma once

#include "Folder.h"

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace rtsl::scene::test {

template <typename Number>
std::string bytesOf(const std::vector<Number> &numbers) {
  return {reinterpret_cast<const char *>(numbers.data()), numbers.size() * sizeof(Number)};
}

inline std::string base64(const std::string &bytes) {
  const char *const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char byte : bytes + std::string((3 - bytes.size() % 3) % 3, '\0')) {
    bits = bits << 8 | std::uint8_t(byte);
    for (count += 8; count >= 6; count -= 6)
      text += digits[bits >> (count - 6) & 63];
  }
  const std::size_t filler = (3 - bytes.size() % 3) % 3;
  return text.replace(text.size() - filler, filler, filler, '=');
}

/// A square of two triangles around the origin, in the plane z = 0: buffer 0 has its indices (at 0)
/// and positions (at 12).
inline std::string square() {
  return bytesOf<std::uint16_t>({0, 1, 2, 0, 2, 3}) +
         bytesOf<float>({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0});
}

/// A file that shows the square; `more` are further members of it, each with a comma before it.
inline std::string squareFile(const std::string &nodes = R"({"mesh": 0})",
                              const std::string &more = "", const std::string &bytes = square()) {
  return R"({"asset": {"version": "2.0"}, "scene": 0,
"nodes": [)" +
         nodes + R"(],
"meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}],
"accessors": [{"bufferView": 0, "componentType": 5123, "count": 6, "type": "SCALAR"},
 {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]}],
"bufferViews": [{"buffer": 0, "byteLength": 12}, {"buffer": 0, "byteOffset": 12, "byteLength": 48}],
"buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64,)" +
         base64(bytes) + "\"}]" +
         (more.find("\"scenes\"") == std::string::npos ? ",\n\"scenes\": [{\"nodes\": [0]}]" : "") +
         more + "}";
}

/// The container of a JSON text and a buffer.
inline std::string container(std::string json, const std::string &binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto word = [](std::size_t number) {
    return bytesOf<std::uint32_t>({std::uint32_t(number)});
  };
  const std::string chunks =
      word(json.size()) + "JSON" + json +
      (binary.empty() ? "" : word(binary.size()) + std::string("BIN\0", 4) + binary);
  return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
}

} // namespace rtsl::scene::test
