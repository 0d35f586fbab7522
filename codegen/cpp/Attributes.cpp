//===- Attributes.cpp - scratch members, and where they lie in a hit ------===//
//
// A class with scratch members has a struct `Scratch` of them, which its methods take: in
// `intersect` it is a variable of that call, elsewhere what the hit that won has stored. A material
// finds a primitive's attribute by name and type, so equal ones have the same place. Classes that
// derive from one another share one `Scratch`, with the members of all.
//
//===----------------------------------------------------------------------===//
#include "codegen/cpp/Printer.h"

#include "runtime/device/ray/Abi.h"
#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

#include <fmt/format.h>

namespace rtsl::cpp {

static unsigned wordsOf(const Type *type, unsigned colorComponents) {
  switch (type->kind) {
  case TypeKind::Vector:
    return type->count;
  case TypeKind::Matrix:
    return type->componentCount();
  case TypeKind::Color:
    return colorComponents;
  case TypeKind::Array:
    return type->count * wordsOf(type->element, colorComponents);
  case TypeKind::Struct: {
    unsigned sum = 0;
    for (const typed::Field &field : type->structure->fields)
      sum += wordsOf(field.type, colorComponents);
    return sum;
  }
  default:
    return 1;
  }
}

const typed::Class &ModulePrinter::top(const typed::Class &definition) const {
  const typed::Class *at = &definition;
  while (at->base)
    at = at->base;
  return *at;
}

std::vector<const typed::Class *> ModulePrinter::family(const typed::Class &definition) const {
  std::vector<const typed::Class *> classes;
  for (const auto &other : module.classes)
    if (&top(*other) == &top(definition))
      classes.push_back(other.get());
  return classes;
}

bool ModulePrinter::hasScratch(const typed::Class &definition) {
  const typed::Class &head = top(definition);
  std::optional<bool> &known = scratchOfFamily[&head];
  if (known)
    return *known;
  bool found = false;
  for (const typed::Class *at : family(head)) {
    for (const auto &member : at->members)
      found |= member->access == ast::Access::Scratch;
    // A free function that reports hits says so there.
    for (const auto &function : at->functions)
      if (function->body)
        forEachExpr(*function->body, [&](const typed::Expr &expr) {
          auto *call = dynCast<typed::CallExpr>(&expr);
          found |= call && !call->function->owner && effects.function(*call->function).reportsHit;
        });
  }
  return *(known = found);
}

// Each name and type has its own place while there is room; two attributes may share one if no
// family has both.
void ModulePrinter::placeAttributes() {
  struct Attribute {
    std::pair<std::string, const Type *> key;
    std::set<const typed::Class *> families;
    SourceRange range;
  };
  std::vector<Attribute> attributes;
  for (const auto &definition : module.classes)
    for (const auto &member : definition->members) {
      if (member->access != ast::Access::Scratch)
        continue;
      const std::pair<std::string, const Type *> key = {member->name, member->type};
      auto found = std::find_if(attributes.begin(), attributes.end(),
                                [&](const Attribute &a) { return a.key == key; });
      if (found == attributes.end())
        found = attributes.insert(attributes.end(), {key, {}, member->range});
      found->families.insert(&top(*definition));
    }
  unsigned last = 0;
  for (std::size_t i = 0; i < attributes.size(); ++i) {
    const unsigned words = wordsOf(attributes[i].key.second, options.colorComponents);
    unsigned offset = 0;
    for (bool moved = true; moved;) {
      moved = false;
      for (std::size_t j = 0; j < i; ++j) {
        const bool meet =
            std::any_of(attributes[i].families.begin(), attributes[i].families.end(),
                        [&](const auto *one) { return attributes[j].families.count(one) != 0; });
        const unsigned begin = attributeWords[attributes[j].key];
        const unsigned end = begin + wordsOf(attributes[j].key.second, options.colorComponents);
        if (meet && offset < end && begin < offset + words) {
          offset = end;
          moved = true;
        }
      }
    }
    attributeWords[attributes[i].key] = offset;
    last = std::max(last, offset + words);
    if (last > RTSL_MAX_ATTRIBUTE_WORDS) {
      diagnostics.report(rtsl::Code::attributesTooLarge, attributes[i].range, last,
                         RTSL_MAX_ATTRIBUTE_WORDS);
      failed = true;
      return;
    }
  }
}

std::string ModulePrinter::scratchStructure(const typed::Class &definition) {
  if (!hasScratch(definition) || &top(definition) != &definition)
    return {};
  std::string text = "struct Scratch : rtsl::Scratch {\n";
  std::string visits;
  std::set<std::string> known;
  for (const typed::Class *at : family(definition))
    for (const auto &member : at->members) {
      if (member->access != ast::Access::Scratch || !known.insert(names.of(member.get())).second)
        continue;
      text += this->member(*member);
      visits += fmt::format("at({}, {});\n", attributeWords[{member->name, member->type}],
                            names.of(member.get()));
    }
  if (!visits.empty())
    text += "\ntemplate <typename Visit>\nvoid visit(Visit at) {\n" + visits + "}\n";
  return text + "};\n";
}

} // namespace rtsl::cpp
