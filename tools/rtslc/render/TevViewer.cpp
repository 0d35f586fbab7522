#include "TevViewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <memory>
#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>
#include <utility>

namespace rtsl::tool {

namespace {

constexpr long longestSeconds = 5; // that the viewer may take to answer, or to take a message

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

void addTevOption(CLI::App &command, TevOptions &options) {
  command
      .add_option_function<std::string>(
          "--tev",
          [&options](const std::string &text) {
            const std::size_t colon = text.rfind(':');
            options.host = text.substr(0, colon);
            options.port = colon == std::string::npos ? "14158" : text.substr(colon + 1);
            if (options.host.empty())
              throw CLI::ValidationError(
                  "--tev", fmt::format("`{}` names no host; give one like localhost:14158", text));
            parseWhole("--tev", options.port, 1, 65535);
          },
          "show the picture in the viewer tev while it is rendered; the port is 14158 by default")
      ->type_name("HOST[:PORT]");
}

TevViewer::TevViewer(const TevOptions &options, std::string name) : name(std::move(name)) {
  connectTo(options);
}

TevViewer::~TevViewer() {
  if (socket >= 0)
    ::close(socket);
}

void TevViewer::connectTo(const TevOptions &options) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo *found = nullptr;
  if (const int error = getaddrinfo(options.host.c_str(), options.port.c_str(), &hints, &found)) {
    whyNot = gai_strerror(error);
    return;
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, freeaddrinfo);
  for (const addrinfo *address = found; address; address = address->ai_next) {
    socket =
        ::socket(address->ai_family, address->ai_socktype | SOCK_CLOEXEC, address->ai_protocol);
    if (socket >= 0) {
      const timeval limit = {longestSeconds, 0}; // of connecting, too
      setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
      if (connect(socket, address->ai_addr, address->ai_addrlen) == 0) {
        whyNot.clear();
        return;
      }
    }
    fail(errno);
  }
}

void TevViewer::fail(int error) {
  if (socket >= 0)
    ::close(socket);
  socket = -1;
  const bool isLate = error == EAGAIN || error == EWOULDBLOCK || error == EINPROGRESS;
  whyNot = isLate ? fmt::format("no answer for {} seconds", longestSeconds) : std::strerror(error);
}

void TevViewer::send(const std::string &message) {
  for (std::size_t sent = 0; sent < message.size() && socket >= 0;) {
    const ssize_t count =
        ::send(socket, message.data() + sent, message.size() - sent, MSG_NOSIGNAL);
    if (count > 0)
      sent += static_cast<std::size_t>(count);
    else if (count == 0 || errno != EINTR)
      fail(count == 0 ? ECONNRESET : errno);
  }
}

void TevViewer::show(const runtime::Image &image) {
  if (socket < 0)
    return;
  const runtime::Image shown = runtime::toRgb(image);
  const std::uint32_t count = std::size(channels);
  if (!std::exchange(hasPicture, true)) {
    Message create(Request::CreatePicture);
    create.flag(true).text(name).number(shown.width).number(shown.height).number(count);
    for (const char *channel : channels)
      create.text(channel);
    send(create.take());
  }
  // In strips, so that no message is large.
  const std::uint32_t rows = std::max(1u, (1u << 20) / shown.width);
  for (std::uint32_t top = 0; top < shown.height; top += rows) {
    const std::uint32_t height = std::min(rows, shown.height - top);
    for (std::uint32_t c = 0; c < count; ++c) {
      Message update(Request::UpdatePart);
      update.flag(false).text(name).text(channels[c]);
      update.number(0u).number(top).number(shown.width).number(height);
      for (std::uint32_t y = top; y < top + height; ++y)
        for (std::uint32_t x = 0; x < shown.width; ++x)
          update.number(shown.at(x, y)[c]);
      send(update.take());
    }
  }
}

} // namespace rtsl::tool
