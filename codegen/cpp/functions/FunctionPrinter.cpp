#include "codegen/cpp/functions/FunctionPrinter.h"

namespace rtsl::cpp {

FunctionPrinter::FunctionPrinter(Context &context, const typed::Function *function,
                                 const typed::Class *owner)
    : context(context), function(function), owner(function ? function->owner : owner),
      literals(*this, context), expressions(*this, context), conversions(*this, context),
      operators(*this, context), ranges(*this, context), assignments(*this, context),
      lvalues(*this, context), calls(*this, context), builtins(*this, context),
      hitAnswers(*this, context), statements(*this, context) {
  if (!function)
    return;
  for (const auto &parameter : function->parameters)
    usedNames.insert(context.names.of(parameter.get()));
  for (const auto &local : function->locals)
    usedNames.insert(context.names.of(local.get()));
}

const std::string &FunctionPrinter::nameOf(const void *entity) const {
  const auto own = constantNames.find(entity);
  return own != constantNames.end() ? own->second : context.names.of(entity);
}

std::string FunctionPrinter::temporaryName(const std::string &hint) {
  for (unsigned i = 1;; ++i) {
    std::string name = hint + std::to_string(i);
    if (usedNames.insert(name).second) {
      temporaries.insert(name);
      return name;
    }
  }
}

Code FunctionPrinter::hoist(const Type *type, const std::string &hint, Code value) {
  const std::string variable = temporaryName(hint);
  before->push_back(cpp::declaration("const", context.types.of(type), variable, std::move(value)));
  return name(variable);
}

} // namespace rtsl::cpp
