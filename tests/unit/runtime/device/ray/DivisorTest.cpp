#include "runtime/device/ray/Divisor.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

namespace rtsl::device {
namespace {

/// Numbers of all sizes, small ones and those next to powers of two among them.
class Numbers {
public:
  std::uint32_t next() {
    const std::uint32_t word = std::uint32_t(random()), kind = std::uint32_t(random()) % 4;
    const std::uint32_t bits = word % 32;
    if (kind == 0)
      return (1u << bits) + std::uint32_t(random()) % 5 - 2;
    return kind == 1 ? ~(word >> bits) : std::uint32_t(random()) >> bits;
  }

private:
  std::mt19937 random{7};
};

TEST(Divisor, IntegersAreDividedExactly) {
  Numbers numbers;
  for (int i = 0; i < 20000; ++i) {
    std::uint32_t divisor = numbers.next();
    divisor = divisor == 0 ? 1 : divisor;
    const RtslDivisor by = makeDivisor(divisor);
    const std::uint32_t multiple = numbers.next() / divisor * divisor;
    for (const std::uint32_t number : {0u, 0xffffffffu, divisor, divisor - 1, multiple,
                                       multiple - 1, multiple + divisor - 1, numbers.next()})
      ASSERT_EQ(quotient(number, by), number / divisor) << number << " / " << divisor;
  }
}

TEST(Divisor, FloatsAreDividedAsByADivision) {
  Numbers numbers;
  std::mt19937 random(11);
  for (int i = 0; i < 2000000; ++i) {
    const std::uint32_t size = numbers.next(), at = numbers.next();
    const float b = float(size == 0 ? 1 : size);
    const float a = float(at) + float(std::uint32_t(random()) >> 8) * 0x1p-24f;
    ASSERT_EQ(quotientByInverse(a, b, 1.0f / b), a / b) << a << " / " << b;
  }
}

} // namespace
} // namespace rtsl::device
