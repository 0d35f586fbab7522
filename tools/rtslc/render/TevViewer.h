//===- TevViewer.h - rtslc render --tev ------------------------------------===//
//
// tev is a viewer of pictures, which other programs may send pictures to (github.com/Tom94/tev).
// Over TCP it takes messages: their length in bytes, 32 bits, which counts itself; a byte for what
// is to be done; and its arguments. Numbers are little-endian, texts end with a zero byte.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/image/Image.h"
#include "tools/common/OptionValues.h"

#include <string>

namespace rtsl::tool {

struct TevOptions {
  std::string host; // empty: no viewer
  std::string port;
};

/// Adds --tev.
void addTevOption(CLI::App &command, TevOptions &options);

/// The connection to a viewer, for one picture.
class TevViewer {
public:
  /// Connects; `failure()` is set if that is not possible. `name`: of the picture, in the viewer.
  TevViewer(const TevOptions &options, std::string name);
  ~TevViewer();
  TevViewer(const TevViewer &) = delete;
  TevViewer &operator=(const TevViewer &) = delete;

  /// Shows a picture in place of the last one, as red, green and blue. Nothing happens after a
  /// failure.
  void show(const runtime::Image &image);

  /// Why the viewer shows nothing more; empty: it does.
  const std::string &failure() const { return whyNot; }

private:
  void connectTo(const TevOptions &options);
  void send(const std::string &message);
  void fail(int error);

  const std::string name;
  int socket = -1;
  bool hasPicture = false; // the viewer knows its size
  std::string whyNot;
};

} // namespace rtsl::tool
