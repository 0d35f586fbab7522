//===- BufferOutput.h - output buffers to files ---------------------------===//
#pragma once

#include "runtime/scene/SceneData.h"

#include <string>

namespace rtsl::runtime {

/// Throws NotSupported if the format of the file's name has no place for the elements of a buffer:
/// structs, of this type, in .csv.
void checkBufferFile(const std::string &path, const std::string &buffer, bool holdsStructs,
                     const std::string &type);

/// Writes the elements of a buffer, in the format of the file's name: NumPy's .npy, with the
/// dimensions of the buffer first and those of an element after them; .csv, with a row for each
/// element, or for each row of a buffer of numbers with two dimensions; otherwise the elements as
/// they lie in memory, 4 bytes a number. Replaces the file when it is complete. "-" is standard
/// output. Throws NotSupported for structs in .csv, and the errors of writing a file.
void writeBuffer(const std::string &path, const OutputBuffer &buffer);

} // namespace rtsl::runtime
