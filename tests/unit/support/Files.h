//===- Files.h - a folder for the files of a test -------------------------===//
#pragma once

#include "support/Error.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace rtsl::test {

namespace fs = std::filesystem;

/// A folder that is gone after the test.
class Files : public ::testing::Test {
protected:
  Files() : folder(fs::path(::testing::TempDir()) / ("rtslFiles" + std::to_string(::getpid()))) {
    fs::create_directories(folder);
  }
  ~Files() override { fs::remove_all(folder); }

  std::string path(const std::string &name) const { return (folder / name).string(); }
  std::string put(const std::string &name, const std::string &text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }
  std::size_t fileCount() const {
    return std::size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }

  fs::path folder;
};

/// The error of an action, as "code: message".
template <typename Action>
std::string errorOf(Action action) {
  try {
    action();
  } catch (const Error &error) {
    return std::string(name(error.code)) + ": " + error.what();
  }
  return "no error";
}

} // namespace rtsl::test
