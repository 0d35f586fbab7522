#include "codegen/cpp/states/statements/Insertion.h"

namespace rtsl::cpp {

Code Insertion::code() const {
  Code code = vector;
  for (const Part &part : parts)
    code = part.component
               ? cpp::call(withParameters("rtsl::with", {std::to_string(*part.component)}),
                           {code, part.value})
               : cpp::call("rtsl::with", {code, part.index, part.value});
  return code;
}

Code Insertion::lvalue(const Code &vector, const Part &part) {
  return part.component ? component(vector, *part.component)
                        : cpp::call("rtsl::at", {vector, part.index});
}

} // namespace rtsl::cpp
