#include "TevViewer.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <utility>

namespace rtsl::tool {

namespace {

/// What a message is about.
enum class Request : std::uint8_t { UpdatePart = 3, CreatePicture = 4 };

/// The bytes of a message.
class Message {
public:
  explicit Message(Request request) : bytes(4, '\0') { bytes += static_cast<char>(request); }

  Message &flag(bool value) {
    bytes += static_cast<char>(value);
    return *this;
  }
  Message &text(const std::string &value) {
    bytes.append(value.c_str(), value.size() + 1);
    return *this;
  }
  Message &number(std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8)
      bytes += static_cast<char>(value >> shift);
    return *this;
  }
  Message &number(float value) {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return number(bits);
  }

  std::string take() {
    const std::string length = Message(bytes.size()).bytes;
    bytes.replace(0, 4, length);
    return std::move(bytes);
  }

private:
  explicit Message(std::size_t length) { number(static_cast<std::uint32_t>(length)); }

  std::string bytes;
};

const char *const channels[] = {"R", "G", "B"};

} // namespace

TevViewer::TevViewer(const TevOptions &options, std::string name)
    : name(std::move(name)), connection(options) {
  if (connection.failure().empty())
    thread = std::thread([this] { run(); });
}

TevViewer::~TevViewer() {
  if (thread.joinable()) {
    connection.abandon();
    finish();
  }
}

void TevViewer::show(const runtime::Image &image) {
  runtime::Image rgb = runtime::toRgb(image);
  const std::lock_guard lock(mutex);
  next = std::move(rgb);
  changed.notify_one();
}

void TevViewer::finish() {
  {
    const std::lock_guard lock(mutex);
    isLast = true;
    changed.notify_one();
  }
  if (thread.joinable())
    thread.join();
}

void TevViewer::run() {
  for (;;) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return next || isLast; });
    if (!next)
      return;
    const runtime::Image image = std::move(*next);
    next.reset();
    lock.unlock();
    send(image);
  }
}

/// Whether the last picture waits for its turn. The ones before it are sent to their end, because
/// a viewer whose lower rows never arrive would show no picture.
bool TevViewer::isOutdated() {
  const std::lock_guard lock(mutex);
  return next && isLast;
}

void TevViewer::send(const runtime::Image &rgb) {
  const std::uint32_t count = std::size(channels);
  if (!std::exchange(hasPicture, true)) {
    Message create(Request::CreatePicture);
    create.flag(true).text(name).number(rgb.width).number(rgb.height).number(count);
    for (const char *channel : channels)
      create.text(channel);
    connection.send(create.take());
  }
  // In strips, so that no message is large.
  const std::uint32_t rows = std::max(1u, (1u << 20) / rgb.width);
  for (std::uint32_t top = 0; top < rgb.height && !isOutdated(); top += rows) {
    const std::uint32_t height = std::min(rows, rgb.height - top);
    for (std::uint32_t c = 0; c < count; ++c) {
      Message update(Request::UpdatePart);
      update.flag(false).text(name).text(channels[c]);
      update.number(0u).number(top).number(rgb.width).number(height);
      for (std::uint32_t y = top; y < top + height; ++y)
        for (std::uint32_t x = 0; x < rgb.width; ++x)
          update.number(rgb.at(x, y)[c]);
      if (!connection.send(update.take()))
        return;
    }
  }
}

} // namespace rtsl::tool
