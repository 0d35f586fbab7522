//===- Items.h - the items that a program may omit, and findings ----------===//
//
// Each pass that omits something because the scene does not need it checks here whether it may, and
// records what it omitted and why: `rtslc explain` (docs/explain.md) only shows these records.
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
/// "Classes": for text output.
const char *titleOf(Item item);
/// The item of that name.
std::optional<Item> itemNamed(std::string_view name);

/// The items that are kept although they are not needed.
class ItemSet {
public:
  bool has(Item item) const { return bits >> static_cast<unsigned>(item) & 1; }
  bool isEmpty() const { return bits == 0; }
  void add(Item item) { bits |= 1u << static_cast<unsigned>(item); }
  void add(ItemSet items) { bits |= items.bits; }
  static ItemSet all();
  static ItemSet only(Item item);
  /// The items of members of objects.
  static ItemSet ofMembers();

private:
  std::uint32_t bits = 0;
};

/// An item that the program contains or omits.
struct Finding {
  Item item;
  std::string subject; // its name in the source: "Solid.lookup"
  bool isNeeded = false;
  std::string reason;    // a short phrase
  ir::SourcePlace place; // of the code that needs it, or of the omitted item; may be unknown
};

using Findings = std::vector<Finding>;

/// Finding::subject of RTSL_NEEDS_FOOTPRINT.
inline constexpr const char *footprintSubject = "footprints of rays";
/// Finding::subject of the change of an attribute along an axis of the footprint, 0 or 1.
std::string changeSubject(const std::string &attribute, std::uint32_t axis);

} // namespace rtsl
