// What shaders print, in the order of the launch.
#include "runtime/program/PrintLog.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>
#include <thread>

using namespace rtsl::runtime;

namespace {

using Kind = ValueType::Kind;

std::uint32_t bits(float value) {
  std::uint32_t word;
  std::memcpy(&word, &value, sizeof word);
  return word;
}

TEST(PrintLog, SpellsEveryKindOfValue) {
  PrintLog log;
  const std::vector<PrintFormat> formats = {
      {{"x is", Kind::Float, 0}, {"float", Kind::Float, 1}, {"int", Kind::Int, 1}},
      {{"uint", Kind::UInt, 1}, {"bvec2", Kind::Bool, 2}, {"vec3", Kind::Float, 3}},
      {}};
  log.add({4, 7, 2, 0, 0, {bits(0.1f), std::uint32_t(-3)}});
  log.add(
      {4,
       7,
       2,
       1,
       1,
       {4000000000u, 1, 0, bits(1), bits(std::numeric_limits<float>::infinity()), 0xffc00001u}});
  log.add({0, 0, PrintedLine::noSample, 0, 2, {}});
  EXPECT_EQ(log.texts(formats),
            (std::vector<std::string>{
                "scene:", "pixel 4,7 sample 2: x is 0.1 -3",
                "pixel 4,7 sample 2: 4000000000 bvec2(true, false) vec3(1, inf, nan)"}));
}

TEST(PrintLog, KeepsTheFirstLinesInWhateverOrderTheyCome) {
  constexpr std::uint32_t width = 1000, height = 300;
  std::vector<std::uint32_t> pixels(width * height);
  for (std::uint32_t i = 0; i < pixels.size(); ++i)
    pixels[i] = i;
  std::shuffle(pixels.begin(), pixels.end(), std::mt19937(1));
  PrintLog log;
  for (std::uint32_t pixel : pixels)
    log.add({pixel % width, pixel / width, 0, 0, 0, {pixel}});
  const std::vector<std::string> texts = log.texts({{{"uint", Kind::UInt, 1}}});
  ASSERT_EQ(texts.size(), PrintLog::mostLines + 1);
  for (std::size_t i :
       {std::size_t(0), std::size_t(999), std::size_t(1000), PrintLog::mostLines - 1})
    EXPECT_EQ(texts[i], "pixel " + std::to_string(i % width) + "," + std::to_string(i / width) +
                            " sample 0: " + std::to_string(i));
  EXPECT_EQ(texts.back(), "... and 200000 more lines");
}

/// Each thread prints lines of one to three values into the memory of a device, with room for
/// `capacity` words.
struct PrintedByThreads {
  static constexpr std::uint32_t threadCount = 4, ofThread = 500, all = threadCount * ofThread;

  std::vector<std::uint32_t> words;
  RtslPrintedLines printed{};
  RtslStatus status{};

  explicit PrintedByThreads(std::uint64_t capacity) : words(capacity, 0xdeadbeefu) {
    printed.capacity = capacity;
    printed.words = words.data();
    status.printed = &printed;
    RtslLaunch launch{};
    launch.status = &status;
    std::vector<std::thread> threads;
    for (std::uint32_t t = 0; t < threadCount; ++t)
      threads.emplace_back([t, &launch] {
        RtslEvents events = {t, 0, 0, 0, 0};
        RtslState state{};
        state.launch = &launch;
        state.events = &events;
        for (std::uint32_t i = 0; i < ofThread; ++i) {
          const std::uint32_t values[] = {i, i + 1, i + 2};
          rtsl_print(&state, i % 3, values, i % 3 + 1);
        }
      });
    for (std::thread &thread : threads)
      thread.join();
  }
};

const std::vector<PrintFormat> oneToThree = {
    {{"uint", Kind::UInt, 1}}, {{"uvec2", Kind::UInt, 2}}, {{"uvec3", Kind::UInt, 3}}};

TEST(PrintLog, TakesTheLinesOfADevice) {
  const PrintedByThreads device(20000);
  EXPECT_EQ(device.status.stop, 1u) << "more than half of the words are used";
  PrintLog log;
  log.add(device.printed, device.words.data());
  const std::vector<std::string> texts = log.texts(oneToThree);
  ASSERT_EQ(texts.size(), PrintedByThreads::all);
  for (std::uint32_t t = 0; t < PrintedByThreads::threadCount; ++t) {
    const auto line = [&](std::uint32_t i) { return texts[t * PrintedByThreads::ofThread + i]; };
    const std::string place = "pixel " + std::to_string(t) + ",0 sample 0: ";
    EXPECT_EQ(line(0), place + "0");
    EXPECT_EQ(line(1), place + "uvec2(1, 2)");
    EXPECT_EQ(line(497), place + "uvec3(497, 498, 499)");
    EXPECT_EQ(line(499), place + "uvec2(499, 500)");
  }
}

TEST(PrintLog, CountsTheLinesThatADeviceHadNoMemoryFor) {
  for (const std::uint64_t capacity : {0, 1, 5, 6, 7, 8, 1000, 1003, 7777}) {
    const PrintedByThreads device(capacity);
    EXPECT_EQ(device.status.stop, 1u);
    PrintLog log;
    log.add(device.printed, device.words.data());
    const std::vector<std::string> texts = log.texts(oneToThree);
    const std::uint64_t lost = device.printed.lost;
    ASSERT_EQ(texts.size(), PrintedByThreads::all - lost + 1) << capacity;
    EXPECT_GE(texts.size() - 1, capacity / 9) << capacity << ": all but the end is used";
    EXPECT_NE(texts.back().find("... and " + std::to_string(lost) + " lines"), std::string::npos)
        << texts.back();
  }
}

TEST(PrintLog, StopsNoLaunchWhoseLinesFillLessThanHalf) {
  const PrintedByThreads device(40000);
  EXPECT_EQ(device.status.stop, 0u);
}

TEST(PrintLog, TakesWhatAllThreadsPrinted) {
  (void)takePrintLog();
  std::vector<std::thread> threads;
  for (std::uint32_t t = 0; t < 4; ++t)
    threads.emplace_back([t] {
      RtslEvents events = {t, 0, 0, 0, 0};
      RtslState state{};
      state.events = &events;
      for (std::uint32_t word : {10u, 20u})
        rtsl_print(&state, 0, &word, 1);
    });
  for (std::thread &thread : threads)
    thread.join();
  const std::vector<std::string> texts = takePrintLog().texts({{{"uint", Kind::UInt, 1}}});
  ASSERT_EQ(texts.size(), 8u);
  EXPECT_EQ(texts[0], "pixel 0,0 sample 0: 10");
  EXPECT_EQ(texts[1], "pixel 0,0 sample 0: 20");
  EXPECT_EQ(texts[7], "pixel 3,0 sample 0: 20");
  EXPECT_TRUE(takePrintLog().texts({}).empty());
}

} // namespace
