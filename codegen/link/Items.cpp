#include "codegen/link/Items.h"

namespace rtsl {

namespace {

struct Text {
  const char *name, *title;
};
constexpr Text texts[] = {
#define RTSL_ITEM(name, text, title) {text, title},
#include "codegen/link/Items.def"
};

} // namespace

const char *nameOf(Item item) {
  return texts[static_cast<std::size_t>(item)].name;
}
const char *titleOf(Item item) {
  return texts[static_cast<std::size_t>(item)].title;
}

std::string changeSubject(const std::string &attribute, std::uint32_t axis) {
  return "change of " + attribute + (axis == 0 ? " along dPdx" : " along dPdy");
}

std::optional<Item> itemNamed(std::string_view name) {
  for (Item item : allItems)
    if (name == nameOf(item))
      return item;
  return std::nullopt;
}

ItemSet ItemSet::all() {
  ItemSet set;
  for (Item item : allItems)
    set.add(item);
  return set;
}

ItemSet ItemSet::only(Item item) {
  ItemSet set;
  set.add(item);
  return set;
}

ItemSet ItemSet::ofMembers() {
  ItemSet set;
  for (Item item : {Item::Parameters, Item::Buffers, Item::Images, Item::Bindless})
    set.add(item);
  return set;
}

} // namespace rtsl
