//===- Items.h - what can be left out of a program, and what was ----------===//
//
// Each pass that leaves something out because the scene does not need it looks here whether it may,
// and notes what it did and why: `rtslc explain` (docs/explain.md) shows these notes and judges
// nothing itself.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/ir/SourcePlace.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rtsl {

enum class Item : std::uint8_t {
#define RTSL_ITEM(name, text, title) name,
#include "codegen/link/Items.def"
};

constexpr Item allItems[] = {
#define RTSL_ITEM(name, text, title) Item::name,
#include "codegen/link/Items.def"
};

/// "classes": what --keep takes.
const char *nameOf(Item item);
/// "Classes": for people.
const char *titleOf(Item item);
/// The item of that name.
std::optional<Item> itemNamed(std::string_view name);

/// What is kept although it is not needed.
class ItemSet {
public:
  bool has(Item item) const { return bits >> static_cast<unsigned>(item) & 1; }
  bool isEmpty() const { return bits == 0; }
  void add(Item item) { bits |= 1u << static_cast<unsigned>(item); }
  void add(ItemSet items) { bits |= items.bits; }
  static ItemSet all();
  static ItemSet only(Item item);

private:
  std::uint32_t bits = 0;
};

/// A thing that the program has, or does without.
struct Finding {
  Item item;
  std::string subject; // as an author would name it: "Solid.lookup"
  bool isNeeded = false;
  std::string reason;    // why, in a few words
  ir::SourcePlace place; // of what needs it, or of what is left out; may be unknown
};

using Findings = std::vector<Finding>;

} // namespace rtsl
