//===- Graphviz.cpp - drawing graphs --------------------------------------===//
#include "codegen/explain/Graphviz.h"

#include "support/Error.h"
#include "support/ErrorMessages.h"

#include "llvm/ADT/SmallString.h"
#include "llvm/Support/FileSystem.h"
#include "llvm/Support/FileUtilities.h"
#include "llvm/Support/MemoryBuffer.h"
#include "llvm/Support/Program.h"
#include "llvm/Support/raw_ostream.h"

#include <array>
#include <optional>

namespace rtsl {

namespace {

/// A temporary file for a stream of `dot`; removed by the destructor.
struct TemporaryFile {
  TemporaryFile() {
    if (const std::error_code error = llvm::sys::fs::createTemporaryFile("rtslc-graph", "", path))
      refuseToWrite(error);
  }
  TemporaryFile(const TemporaryFile &) = delete;
  TemporaryFile &operator=(const TemporaryFile &) = delete;
  ~TemporaryFile() { llvm::sys::fs::remove(path); }

  void write(const std::string &text) {
    std::error_code error;
    llvm::raw_fd_ostream out(path, error);
    if (error)
      refuseToWrite(error);
    out << text;
    out.close();
    error = out.error();
    out.clear_error();
    if (error)
      refuseToWrite(error);
  }
  std::string read() const {
    auto buffer = llvm::MemoryBuffer::getFile(path);
    if (!buffer)
      throw Error(message::temporaryUnreadable(buffer.getError().message()));
    return (*buffer)->getBuffer().str();
  }

  [[noreturn]] static void refuseToWrite(std::error_code error) {
    throw Error(message::temporaryUnwritable(error.message()));
  }

  llvm::SmallString<128> path;
};

} // namespace

static std::string runDot(const std::string &graph) {
  const llvm::ErrorOr<std::string> program = llvm::sys::findProgramByName("dot");
  if (!program)
    throw Error(message::graphvizMissing())
        .note("install Graphviz (on Debian: `apt-get install graphviz`), or use `--format=dot`");

  TemporaryFile in, out, messages;
  in.write(graph);
  const std::array<std::optional<llvm::StringRef>, 3> streams = {in.path.str(), out.path.str(),
                                                                 messages.path.str()};
  std::string error;
  const int status =
      llvm::sys::ExecuteAndWait(*program, {*program, "-Tsvg"}, std::nullopt, streams, 0, 0, &error);
  if (status != 0)
    throw Error(message::graphvizFails(
        *program, error.empty() ? llvm::StringRef(messages.read()).rtrim().str() : error));
  return out.read();
}

/// Rules of a style sheet precede the attributes that `dot` writes.
static constexpr char style[] =
    "<style>\n"
    "svg{background:#fff}\n"
    "text{fill:#222;font-family:ui-monospace,'DejaVu Sans Mono',Menlo,Consolas,monospace}\n"
    ".graph>polygon{fill:none}.cluster>polygon{stroke:#c3cad1}.cluster>text{font-weight:bold}\n"
    ".node>polygon{fill:#f4f6f8;stroke:#8896a4}.first>polygon{fill:#e3eefc}\n"
    ".node>ellipse,.edge>path,.edge>polygon{stroke:#3b6ea8}\n"
    ".node>ellipse[fill=black],.edge>polygon{fill:#3b6ea8}\n"
    "@media(prefers-color-scheme:dark){svg{background:#15181c}text{fill:#e6e6e6}\n"
    ".cluster>polygon{stroke:#444d57}.node>polygon{fill:#22272d;stroke:#5b6773}\n"
    ".first>polygon{fill:#22324a}.node>ellipse,.edge>path,.edge>polygon{stroke:#7fb0ea}\n"
    ".node>ellipse[fill=black],.edge>polygon{fill:#7fb0ea}}\n"
    "</style>\n";

std::string drawGraph(const std::string &graph, const std::string &title) {
  const std::string document = runDot(graph);
  // The part before the root element declares a DTD, which is not allowed within a page.
  const std::size_t root = document.find("<svg");
  const std::size_t content = root == std::string::npos ? root : document.find('>', root);
  if (content == std::string::npos)
    throw Error(message::graphvizNoSvg());
  return document.substr(root, content + 1 - root) + "\n<title>" + title + "</title>\n" + style +
         document.substr(document.find_first_not_of('\n', content + 1));
}

} // namespace rtsl
