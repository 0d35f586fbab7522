#include "codegen/cpp/tree/Declaration.h"

#include <iterator>

namespace rtsl::cpp {

Declaration declare(Declaration::What what, std::string comment) {
  Declaration made;
  made.what = std::move(what);
  made.comment = std::move(comment);
  return made;
}

Declaration declareStruct(std::string name) {
  Struct made;
  made.name = std::move(name);
  made.isOnlyDeclared = true;
  return declare(std::move(made));
}

static Parameter passed(Parameter::Pass pass, std::string type, std::string name) {
  Parameter made;
  made.type = std::move(type);
  made.name = std::move(name);
  made.pass = pass;
  return made;
}

Parameter byValue(std::string type, std::string name) {
  return passed(Parameter::Pass::Value, std::move(type), std::move(name));
}

Parameter byReference(std::string type, std::string name) {
  return passed(Parameter::Pass::Reference, std::move(type), std::move(name));
}

Parameter byConstReference(std::string type, std::string name) {
  Parameter made = byReference(std::move(type), std::move(name));
  made.isConst = true;
  return made;
}

Parameter byPointer(std::string type, std::string name) {
  return passed(Parameter::Pass::Pointer, std::move(type), std::move(name));
}

void append(Declarations &declarations, Declarations more) {
  declarations.insert(declarations.end(), std::make_move_iterator(more.begin()),
                      std::make_move_iterator(more.end()));
}

void appendApart(Declarations &declarations, Declarations more) {
  if (!more.empty())
    more.front().hasSpace = true;
  append(declarations, std::move(more));
}

void appendApart(Declarations &declarations, Declaration more) {
  more.hasSpace = true;
  declarations.push_back(std::move(more));
}

} // namespace rtsl::cpp
