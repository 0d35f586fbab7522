//===- ImageChannels.cpp - which channels of images are read --------------===//
//
//   %s = rtsl.load (rtsl.member %self "rough")
//   %c = rtsl.call_method "sample.vec2" on %s(%uv)
//   %r = vector.extract %c[0]
//
// If all that the program does with the images of a member is to look up colors, of which it takes
// only the red component, the scene need not keep the other channels. Uses of a color are followed
// through variables and arithmetic on components; uses of a reference are not.
//
//===----------------------------------------------------------------------===//
#include "codegen/link/Members.h"
#include "codegen/link/steps/Steps.h"

#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "mlir/IR/OpDefinition.h"
#include "llvm/ADT/SmallPtrSet.h"

namespace rtsl::linking {

namespace {

constexpr std::uint32_t all = runtime::MemberInfo::allChannels;

class ChannelReads {
public:
  /// The components of a vector of four that the program reads.
  std::uint32_t ofColor(mlir::Value color) {
    std::uint32_t read = 0;
    for (mlir::Operation *user : color.getUsers())
      read |= ofUser(color, user);
    return read;
  }

private:
  std::uint32_t ofUser(mlir::Value color, mlir::Operation *user) {
    if (auto extract = llvm::dyn_cast<mlir::vector::ExtractOp>(user);
        extract && !extract.hasDynamicPosition() && extract.getSource() == color)
      return 1u << extract.getStaticPosition().front();
    if (auto shuffle = llvm::dyn_cast<mlir::vector::ShuffleOp>(user)) {
      std::uint32_t read = 0;
      for (const std::int64_t lane : shuffle.getMask())
        if (lane >= 0 && (lane < 4 ? shuffle.getV1() : shuffle.getV2()) == color)
          read |= 1u << (lane % 4);
      return shuffle.getV1().getType() == shuffle.getV2().getType() ? read : all;
    }
    if (auto store = llvm::dyn_cast<ir::StoreOp>(user))
      return ofVariable(store.getAddress());
    if (mlir::OpTrait::hasElementwiseMappableTraits(user) && user->getNumResults() == 1 &&
        user->getResult(0).getType() == color.getType())
      return ofColor(user->getResult(0));
    return all;
  }

  /// A variable that is only loaded and stored as a whole.
  std::uint32_t ofVariable(mlir::Value address) {
    if (!address.getDefiningOp<ir::VarOp>())
      return all;
    if (!visited.insert(address.getAsOpaquePointer()).second)
      return 0;
    std::uint32_t read = 0;
    for (mlir::Operation *user : address.getUsers())
      if (auto load = llvm::dyn_cast<ir::LoadOp>(user))
        read |= ofColor(load.getResult());
      else if (!llvm::isa<ir::StoreOp>(user))
        return all;
    return read;
  }

  llvm::SmallPtrSet<void *, 8> visited; // variables
};

/// Is it a whole number, or a vector of these, such as the size of an image?
bool isWhole(mlir::Type type) {
  return mlir::getElementTypeOrSelf(type).isInteger(32);
}

std::uint32_t ofReference(mlir::Value reference) {
  std::uint32_t read = 0;
  for (mlir::Operation *user : reference.getUsers()) {
    if (auto cast = llvm::dyn_cast<ir::CastRefOp>(user)) {
      read |= ofReference(cast.getResult());
      continue;
    }
    if (llvm::isa<ir::EqualRefOp>(user))
      continue;
    auto call = llvm::dyn_cast<ir::CallMethodOp>(user);
    if (!call || call.getObject() != reference || call->getNumResults() != 1)
      return all;
    const mlir::Value result = call->getResult(0);
    if (isWhole(result.getType()))
      continue;
    const auto color = llvm::dyn_cast<mlir::VectorType>(result.getType());
    read |= color && color.getNumElements() == 4 ? ChannelReads().ofColor(result) : all;
  }
  return read;
}

/// The channels read through an address of: a reference to an image, or an array or a buffer of
/// them.
std::uint32_t ofAddress(mlir::Value address) {
  std::uint32_t read = 0;
  for (mlir::Operation *user : address.getUsers())
    if (auto load = llvm::dyn_cast<ir::LoadOp>(user))
      read |= ofReference(load.getResult());
    else if (llvm::isa<ir::ElementOp, ir::BufferElementOp>(user))
      read |= ofAddress(user->getResult(0));
    else if (!llvm::isa<ir::StoreOp, ir::BufferLengthOp>(user)) // stored by a constructor
      return all;
  return read;
}

/// Does it hold references to images, and nothing else?
bool holdsImages(mlir::Type type) {
  if (const auto buffer = llvm::dyn_cast<ir::BufferType>(type))
    type = buffer.getElement();
  while (const auto array = llvm::dyn_cast<ir::ArrayType>(type))
    type = array.getElement();
  const auto reference = llvm::dyn_cast<ir::RefType>(type);
  return reference && isSampler(reference.getClassName().str());
}

} // namespace

ImageChannels findImageChannels(const LinkContext &context) {
  ImageChannels channels;
  mlir::ModuleOp(context.ir).walk([&](ir::MemberOp member) {
    const auto object = llvm::cast<ir::RefType>(member.getObject().getType()).getClassName();
    if (holdsImages(llvm::cast<ir::PtrType>(member.getType()).getPointee()))
      channels[{object.str(), member.getMember().str()}] |= ofAddress(member);
  });
  return channels;
}

std::uint32_t channelsOf(const ImageChannels &channels, const typed::Class &info,
                         const std::string &member) {
  std::uint32_t read = 0;
  for (const auto &[key, ofMember] : channels)
    if (key.second == member && derivesFrom(info, key.first))
      read |= ofMember;
  return read;
}

} // namespace rtsl::linking
