//===- TevViewer.h - rtslc render --tev ------------------------------------===//
//
// tev is a viewer of pictures, which other programs may send pictures to (github.com/Tom94/tev).
// Over TCP it takes messages: their length in bytes, 32 bits, which counts itself; a byte for what
// is to be done; and its arguments. Numbers are little-endian, texts end with a zero byte.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "TevConnection.h"
#include "runtime/image/Image.h"

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace rtsl::tool {

/// A viewer that shows one picture while it is rendered. A thread sends what it shows, so that the
/// rendering does not wait for a slow viewer, which is sent fewer of the pictures so far.
class TevViewer {
public:
  /// Connects; `failure()` is set if that is not possible. `name`: of the picture, in the viewer.
  TevViewer(const TevOptions &options, std::string name);
  /// Sends nothing more, not even the rest of a message.
  ~TevViewer();
  TevViewer(const TevViewer &) = delete;
  TevViewer &operator=(const TevViewer &) = delete;

  /// Shows a picture in place of the last one, as red, green and blue, as soon as the viewer can
  /// take it. Pictures that are given before that are left out.
  void show(const runtime::Image &image);

  /// Waits until the last picture is sent. `failure()` says whether that was possible.
  void finish();

  /// Why the viewer shows nothing more; empty: it does. Valid before `show` and after `finish`.
  const std::string &failure() const { return connection.failure(); }

private:
  void run();
  void send(const runtime::Image &rgb);
  bool isOutdated();

  const std::string name;
  TevConnection connection;
  bool hasPicture = false; // the viewer knows its size

  std::mutex mutex; // of what follows
  std::condition_variable changed;
  std::optional<runtime::Image> next; // to be shown
  bool isLast = false;                // no other one will follow
  std::thread thread;
};

} // namespace rtsl::tool
