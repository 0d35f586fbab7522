//===- Jpeg2000Claim.h - what the header of a JPEG 2000 file claims -------===//
//
// OpenImageIO decodes such a file when it opens it, so its header is read before that.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/image/ImageClaim.h"

#include <functional>
#include <optional>
#include <vector>

namespace rtsl::runtime {

/// As many bytes of a file from `offset` on; fewer where it ends.
using ReadBytes =
    std::function<std::vector<unsigned char>(std::uint64_t offset, std::size_t count)>;

/// Nothing if it is no JPEG 2000 file, or a damaged one. `pixelBytes` is that of the pixels while
/// they are decoded: OpenJPEG has 4 bytes for each sample, whatever its bits.
std::optional<ImageClaim> jpeg2000Claim(const ReadBytes &read);

} // namespace rtsl::runtime
