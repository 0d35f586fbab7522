#include "runtime/embree/EmbreeCallbacks.h"

#include "runtime/embree/EmbreeRay.h"
#include "runtime/embree/EnterSpace.h"
#include "runtime/embree/HostScene.h"
#include "support/Fibers.h"

#include <limits>

namespace rtsl::runtime {

namespace {

using Implementation = EmbreeScene::Implementation;

template <typename Arguments>
const EmbreeContext &contextOf(const Arguments *arguments) {
  return *reinterpret_cast<const EmbreeContext *>(arguments->context);
}

constexpr float isOver = -std::numeric_limits<float>::infinity(); // RTCRay::tfar

/// Embree's ray, whose direction is scaled by a power of two.
void fill(RTCRay &ray, const EmbreeContext &context) {
  const device::TriangleRay &from = *context.ray;
  const float epsilon = context.state->Epsilon;
  const device::Vec3 direction = from.direction * (1 / context.toEmbree);
  ray.org_x = from.origin.x;
  ray.org_y = from.origin.y;
  ray.org_z = from.origin.z;
  ray.dir_x = direction.x;
  ray.dir_y = direction.y;
  ray.dir_z = direction.z;
  ray.tnear = device::maximum(epsilon * context.toEmbree, 0.0f) * (1.0f - 2 * device::rangeShare);
  ray.tfar = context.end(context.limit());
  ray.time = 0;
  ray.mask = ~0u;
  ray.id = 0;
  ray.flags = 0;
}

/// Where Embree's search ends, now that something was tested: nothing beyond a hit matters.
void setEnd(const EmbreeContext &context, RTCRay &ray, bool ends) {
  ray.tfar = ends ? isOver : context.end(context.limit());
}

template <typename Ray>
RtslLeafItem itemOf(const EmbreeContext &context, const EmbreePrimitive &primitive) {
  return {device::instanceOf(context.rayAs<Ray>(), primitive.instance), primitive.number};
}

/// `test(instance, item, intersect)` tests an RTSL primitive.
template <typename Ray, typename Test>
[[gnu::always_inline]] inline bool testPrimitive(const EmbreeContext &context, unsigned number,
                                                 Test test) {
  const EmbreePrimitive &primitive = context.space->primitives[number];
  const RtslLeafItem item = itemOf<Ray>(context, primitive);
  const Implementation &scene = *context.space->scene;
  const RtslInstance &instance = scene.launch.instances[item.instance];
  if (!primitive.intersect)
    return device::testTriangle(*context.state, context.rayAs<Ray>(),
                                scene.launch.meshes[instance.mesh], item.instance, item.primitive);
  return test(instance, item, device::withModerateRay(primitive.intersect, scene.scalesSearches));
}

template <typename Ray>
bool testPrimitive(const EmbreeContext &context, unsigned number) {
  return testPrimitive<Ray>(context, number,
                            [&](const RtslInstance &instance, RtslLeafItem item, auto intersect) {
                              return device::testPrimitive(*context.state, context.rayAs<Ray>(),
                                                           instance, item, intersect);
                            });
}

/// The same for one of the world, where the ray is in its box.
bool testListed(const EmbreeContext &context, unsigned number, device::Range inBox) {
  return testPrimitive<device::TriangleRay>(
      context, number, [&](const RtslInstance &instance, RtslLeafItem item, auto intersect) {
        return device::testInRange(*context.state, *context.ray, instance, item, inBox, intersect);
      });
}

/// Searches a primitive, which `test` tests, for the nearest hit. True if the search is over.
template <typename Ray, typename Test>
[[gnu::always_inline]] inline bool searchPrimitive(const EmbreeContext &context, unsigned number,
                                                   Test test) {
  if (context.visitor)
    return context.visitItem(itemOf<Ray>(context, context.space->primitives[number]));
  return test() && context.endsAtHit({}); // no block or instance
}

template <typename Ray>
void intersectPrimitive(const RTCIntersectFunctionNArguments *arguments) {
  const EmbreeContext &context = contextOf(arguments);
  setEnd(context, reinterpret_cast<RTCRayHit *>(arguments->rayhit)->ray,
         searchPrimitive<Ray>(context, arguments->primID,
                              [&] { return testPrimitive<Ray>(context, arguments->primID); }));
}

template <typename Ray>
void occludedPrimitive(const RTCOccludedFunctionNArguments *arguments) {
  if (testPrimitive<Ray>(contextOf(arguments), arguments->primID))
    reinterpret_cast<RTCRay *>(arguments->ray)->tfar = isOver;
}

/// Tests all primitives of the space, for a ray that Embree cannot trace. True if the search is
/// over.
[[gnu::cold, gnu::noinline]] bool testAll(const EmbreeContext &context,
                                          const device::InstanceRay &ray, bool anyHit) {
  for (unsigned i = 0; i < context.space->primitives.size(); ++i) {
    if (context.visitor) {
      const EmbreePrimitive &primitive = context.space->primitives[i];
      if (context.visitItem(itemOf<device::InstanceRay>(context, primitive)))
        return true;
    } else if (testPrimitive<device::InstanceRay>(context, i) && anyHit) {
      return true;
    }
  }
  return false;
}

/// Searches Embree's tree of an instance that has a space of its own. True if the search is over.
bool searchInside(EmbreeContext &context, const device::InstanceRay &ray, bool anyHit) {
  if (!EmbreeScene::needsNoScaling(ray.origin, ray.direction)) {
    if (!EmbreeScene::canFollow(ray.origin, ray.direction))
      return testAll(context, ray, anyHit);
    ++rayCounters().rescaledRays;
    context.toEmbree = device::powerOfTwo(device::exponentOf(device::largest(ray.direction)));
  }
  return Implementation::searchTree(context, anyHit);
}

/// Searches an instance that has a space of its own, where the ray is in its box (reachBox). True
/// if the search is over.
template <bool anyHit>
bool searchInstance(const EmbreeContext &outer, unsigned number, device::Range inBox) {
  const EmbreeInstance &one = outer.space->instances[number];
  const Implementation &scene = *outer.space->scene;
  RtslState &state = *outer.state;
  device::InstanceRay ray;
  const auto isSeen = [&] {
    return outer.seesAll ||
           device::isSeen(state, scene.launch.instances[one.instance], FilledSlots{*scene.slots});
  };
  if (!isSeen() || !enterSpace(*state.launch, *outer.ray, one, inBox, state.Time, state.Epsilon,
                               outer.limit(), ray))
    return false;
  EmbreeContext context;
  rtcInitIntersectContext(&context.embree);
  context.state = &state;
  context.ray = &ray;
  context.space = one.inside;
  context.visitor = outer.visitor;
  context.seesAll = true; // what is inside
  context.endsIfHidden = outer.endsIfHidden;
  context.toEmbree = 1;
  if (searchTriangles<device::InstanceRay>(context, anyHit))
    return true;
  return one.inside->hasTree() && searchInside(context, ray, anyHit);
}

bool reachBox(const EmbreeContext &context, unsigned number, device::Range &inBox) {
  return reachBox(*context.ray, context.space->instances[number], context.state->Epsilon,
                  context.limit(), inBox);
}

/// The same wherever the ray is.
template <bool anyHit>
bool searchInstance(const EmbreeContext &context, unsigned number) {
  device::Range inBox;
  return reachBox(context, number, inBox) && searchInstance<anyHit>(context, number, inBox);
}

/// Searches one for the nearest hit, and records if it has that so far. True if the search is over.
bool searchForNearest(const EmbreeContext &context, unsigned number, device::Range inBox) {
  const Occluder item = {number, true};
  if (context.isTested(item))
    return false;
  const float before = context.state->nearest;
  if (searchInstance<false>(context, number, inBox)) {
    context.occluder = item;
    return true;
  }
  if (context.state->nearest < before)
    context.found = item;
  return false;
}

/// Searches one for any hit.
bool searchForAny(const EmbreeContext &context, unsigned number, device::Range inBox) {
  if (!searchInstance<true>(context, number, inBox))
    return false;
  context.occluder = {number, true};
  return true;
}

void intersectInstance(const RTCIntersectFunctionNArguments *arguments) {
  const EmbreeContext &context = contextOf(arguments);
  device::Range inBox;
  setEnd(context, reinterpret_cast<RTCRayHit *>(arguments->rayhit)->ray,
         reachBox(context, arguments->primID, inBox) &&
             searchForNearest(context, arguments->primID, inBox));
}

void occludedInstance(const RTCOccludedFunctionNArguments *arguments) {
  const EmbreeContext &context = contextOf(arguments);
  device::Range inBox;
  if (reachBox(context, arguments->primID, inBox) &&
      searchForAny(context, arguments->primID, inBox))
    reinterpret_cast<RTCRay *>(arguments->ray)->tfar = isOver;
}

} // namespace

bool EmbreeScene::Implementation::isInInstance(const EmbreeContext &context, std::uint32_t number) {
  return searchInstance<true>(context, number);
}

void EmbreeScene::Implementation::searchInInstance(const EmbreeContext &context,
                                                   std::uint32_t number) {
  searchInstance<false>(context, number);
}

bool EmbreeScene::Implementation::searchTree(const EmbreeContext &context, bool anyHit) {
  Fibers::pauseThread(); // Embree's tree has no place for it
  const device::TriangleRay &ray = *context.ray;
  const RTCScene tree = context.space->treeFor(ray.origin);
  if (anyHit) {
    RTCRay searched;
    fill(searched, context);
    rtcOccluded1(tree, &context.embree, &searched);
    return searched.tfar == isOver;
  }
  RTCRayHit searched;
  fill(searched.ray, context);
  searched.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  searched.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(tree, &context.embree, &searched);
  return searched.ray.tfar == isOver;
}

bool EmbreeScene::Implementation::searchList(const EmbreeContext &context, bool anyHit) {
  const EmbreeSpace &world = *context.space;
  const auto primitives = unsigned(world.primitives.size());
  const auto search = [&](unsigned i, device::Range inBox) {
    if (i >= primitives)
      return anyHit ? searchForAny(context, i - primitives, inBox)
                    : searchForNearest(context, i - primitives, inBox);
    const auto test = [&] { return testListed(context, i, inBox); };
    return anyHit ? test() : searchPrimitive<device::TriangleRay>(context, i, test);
  };
  ItemList::Entered entered =
      world.list.enter(*context.ray, context.state->Epsilon, context.limit());
  while (entered.items) {
    const unsigned i = entered.takeNearest();
    if (!(entered.near[i] <= context.limit()))
      return false;
    if (search(i, entered.range(i)))
      return true;
  }
  return false;
}

template <typename Ray>
static constexpr SearchCallbacks forPrimitives{intersectPrimitive<Ray>, occludedPrimitive<Ray>};

SearchCallbacks primitiveCallbacks(bool isWorld) {
  return isWorld ? forPrimitives<device::TriangleRay> : forPrimitives<device::InstanceRay>;
}

SearchCallbacks instanceCallbacks() {
  return {intersectInstance, occludedInstance};
}

} // namespace rtsl::runtime
