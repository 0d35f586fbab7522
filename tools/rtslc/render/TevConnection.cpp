#include "TevConnection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <linux/sockios.h>
#include <memory>
#include <netdb.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

namespace rtsl::tool {

namespace {

constexpr int longestSeconds = 5; // that the viewer may take to answer, or to accept more bytes

/// HOST, HOST:PORT, [HOST] or [HOST]:PORT: the address of IPv6 has colons of its own.
TevOptions parseAddress(const std::string &text) {
  const bool hasBrackets = !text.empty() && text.front() == '[';
  if (!hasBrackets && std::count(text.begin(), text.end(), ':') > 1)
    throw CLI::ValidationError("--tev", fmt::format("`{}` has several `:`; an address of IPv6 is "
                                                    "written in brackets, such as [::1]:14158",
                                                    text));
  const std::size_t end = text.find(hasBrackets ? ']' : ':');
  if (hasBrackets && end == std::string::npos)
    throw CLI::ValidationError("--tev", fmt::format("`{}` has no `]`", text));
  const std::string host = hasBrackets ? text.substr(1, end - 1) : text.substr(0, end);
  if (host.empty())
    throw CLI::ValidationError(
        "--tev", fmt::format("`{}` names no host; give one like localhost:14158", text));
  const std::string rest = end == std::string::npos ? "" : text.substr(end + hasBrackets);
  if (rest.empty())
    return {host, "14158"};
  if (rest.front() != ':')
    throw CLI::ValidationError("--tev",
                               fmt::format("`{}` is not `]` or `]:PORT` at its end", text));
  const std::string port = rest.substr(1);
  parseWhole("--tev", port, 1, 65535);
  return {host, port};
}

} // namespace

std::string TevOptions::shownHost() const {
  return host.find(':') == std::string::npos ? host : fmt::format("[{}]", host);
}

void addTevOption(CLI::App &command, TevOptions &options) {
  command
      .add_option_function<std::string>(
          "--tev", [&options](const std::string &text) { options = parseAddress(text); },
          "show the picture in the viewer tev while it is rendered; the port is 14158 by default")
      ->type_name("HOST[:PORT]");
}

TevConnection::TevConnection(const TevOptions &options) {
  connectTo(options);
}

TevConnection::~TevConnection() {
  if (socket >= 0)
    ::close(socket);
}

void TevConnection::connectTo(const TevOptions &options) {
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
    if (socket >= 0)
      ::close(socket);
    socket =
        ::socket(address->ai_family, address->ai_socktype | SOCK_CLOEXEC, address->ai_protocol);
    if (socket >= 0) {
      const timeval limit = {longestSeconds, 0}; // of connecting
      setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
      if (connect(socket, address->ai_addr, address->ai_addrlen) == 0) {
        whyNot.clear();
        return;
      }
    }
    fail(errno);
  }
}

bool TevConnection::fail(int error) {
  const bool isLate = error == EAGAIN || error == EWOULDBLOCK || error == EINPROGRESS;
  whyNot = isLate ? fmt::format("no answer for {} seconds", longestSeconds) : std::strerror(error);
  return false;
}

/// The bytes that the viewer has not accepted yet.
static int queuedBytes(int socket) {
  int bytes = 0;
  return ioctl(socket, SIOCOUTQ, &bytes) == 0 ? bytes : 0;
}

bool TevConnection::send(const std::string &bytes) {
  for (std::size_t sent = 0; sent < bytes.size() && whyNot.empty();) {
    const ssize_t count =
        ::send(socket, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count >= 0) {
      sent += static_cast<std::size_t>(count);
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      // There is room when a third of the queue is free, for which a slow viewer may take longer.
      const int before = queuedBytes(socket);
      pollfd waiting = {socket, POLLOUT, 0};
      if (poll(&waiting, 1, 1000 * longestSeconds) == 0 && queuedBytes(socket) >= before)
        return fail(EAGAIN);
    } else if (errno != EINTR) {
      return fail(errno);
    }
  }
  return whyNot.empty();
}

void TevConnection::abandon() {
  shutdown(socket, SHUT_RDWR);
}

} // namespace rtsl::tool
