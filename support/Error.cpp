#include "support/Error.h"

namespace rtsl {

const char *name(ErrorCode code) {
  switch (code) {
  case ErrorCode::FileNotFound:
    return "fileNotFound";
  case ErrorCode::FileUnreadable:
    return "fileUnreadable";
  case ErrorCode::FileUnwritable:
    return "fileUnwritable";
  case ErrorCode::OverwritesInput:
    return "overwritesInput";
  case ErrorCode::UnsupportedFormat:
    return "unsupportedFormat";
  case ErrorCode::BadMesh:
    return "badMesh";
  case ErrorCode::BadImage:
    return "badImage";
  case ErrorCode::BadBuffer:
    return "badBuffer";
  case ErrorCode::BadCheckpoint:
    return "badCheckpoint";
  case ErrorCode::BadPackage:
    return "badPackage";
  case ErrorCode::NotAScene:
    return "notAScene";
  case ErrorCode::JsonSyntax:
    return "jsonSyntax";
  case ErrorCode::DuplicateKey:
    return "duplicateKey";
  case ErrorCode::UnknownKey:
    return "unknownKey";
  case ErrorCode::MissingKey:
    return "missingKey";
  case ErrorCode::WrongType:
    return "wrongType";
  case ErrorCode::OutOfRange:
    return "outOfRange";
  case ErrorCode::UnknownName:
    return "unknownName";
  case ErrorCode::ReferenceCycle:
    return "referenceCycle";
  case ErrorCode::NotSupported:
    return "notSupported";
  case ErrorCode::BadOverride:
    return "badOverride";
  case ErrorCode::UnknownClass:
    return "unknownClass";
  case ErrorCode::WrongClass:
    return "wrongClass";
  case ErrorCode::UnknownMember:
    return "unknownMember";
  case ErrorCode::NotSettable:
    return "notSettable";
  case ErrorCode::BadArguments:
    return "badArguments";
  case ErrorCode::MissingMember:
    return "missingMember";
  case ErrorCode::DegenerateGeometry:
    return "degenerateGeometry";
  case ErrorCode::MissingMethod:
    return "missingMethod";
  case ErrorCode::IncompleteScene:
    return "incompleteScene";
  case ErrorCode::Cancelled:
    return "cancelled";
  case ErrorCode::OutOfMemory:
    return "outOfMemory";
  case ErrorCode::NoDevice:
    return "noDevice";
  case ErrorCode::Internal:
    return "internal";
  }
  return "internal";
}

} // namespace rtsl
