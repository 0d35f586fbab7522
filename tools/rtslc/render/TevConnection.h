//===- TevConnection.h - bytes for a viewer, over TCP ----------------------===//
#pragma once

#include "tools/common/OptionValues.h"

#include <string>

namespace rtsl::tool {

struct TevOptions {
  std::string host; // empty: no viewer
  std::string port;

  /// As --tev takes it: an address of IPv6 in brackets.
  std::string shownHost() const;
};

/// Adds --tev.
void addTevOption(CLI::App &command, TevOptions &options);

/// A connection that is lost for good after the first failure. One thread at a time sends.
class TevConnection {
public:
  /// Connects; `failure()` is set if that is not possible.
  explicit TevConnection(const TevOptions &options);
  ~TevConnection();
  TevConnection(const TevConnection &) = delete;
  TevConnection &operator=(const TevConnection &) = delete;

  /// Waits until the system has taken all bytes for the viewer; false: the connection is lost.
  bool send(const std::string &bytes);

  /// Ends a `send` of another thread, which fails.
  void abandon();

  /// Why nothing can be sent any more; empty: it can.
  const std::string &failure() const { return whyNot; }

private:
  void connectTo(const TevOptions &options);
  bool fail(int error);

  int socket = -1;
  std::string whyNot;
};

} // namespace rtsl::tool
