//===- Renew.cpp - write the checker's messages to the language's tests ---===//
//
// Rewrites the expected messages in tests/language/*/errors.rtsl, and the typed trees in
// accepted.typed beside accepted.rtsl. What changed is then read as a difference in version
// control. tests/language/renew starts it.
//
//===----------------------------------------------------------------------===//
#include "Harness.h"

#include <filesystem>
#include <iostream>

using namespace rtsl;
using namespace rtsl::test;

static void write(const std::string &path, const std::string &text) {
  if (std::filesystem::exists(path) && readFile(path) == text)
    return;
  writeFile(path, text);
  std::cout << "wrote " << path << "\n";
}

int main() {
  for (const std::string &path : languageFiles("errors.rtsl")) {
    std::string renewed;
    for (const Case &each : splitCases(readFile(path)))
      renewed += "//--- " + each.title + "\n" + withActualMessages(each.text);
    write(path, renewed);
  }
  bool hasErrors = false;
  for (const std::string &path : languageFiles("accepted.rtsl")) {
    const std::unique_ptr<Checked> checked = checkText(readFile(path));
    if (const std::string messages = render(*checked); !messages.empty()) {
      std::cerr << path << " is not accepted:\n" << messages;
      hasErrors = true;
      continue;
    }
    write(std::filesystem::path(path).replace_extension(".typed").string(),
          typed::dump(*checked->module));
  }
  return hasErrors ? 1 : 0;
}
