/* See embree_shim.h. */
#include "embree_shim.h"
#include <stddef.h>

/* Layouts that Rust's side writes into; bindgen's own tests check the same from Rust. */
_Static_assert(sizeof(struct RTCRay) == 48, "RTCRay has an unknown layout");
_Static_assert(offsetof(struct RTCRayHit, hit) == 48, "RTCRayHit has an unknown layout");
_Static_assert(RTC_MAX_INSTANCE_LEVEL_COUNT >= 1, "Embree was built without instances");

#if GLINT_EMBREE_MAJOR == 4
typedef struct RTCRayQueryContext Context;
#else
typedef struct RTCIntersectContext Context;
#endif

/* Embree hands the context through to filters: ours carries whom to ask. */
typedef struct Query {
  Context context; /* first, so that a pointer to it is a pointer to the whole */
  GlintAccept accept;
  const void *user;
} Query;

static void filter(const struct RTCFilterFunctionNArguments *args) {
  const Query *query = (const Query *)args->context;
  if (!query->accept) return;
  /* Rays are traced one at a time: with N = 1 the SoA structures are RTCRay and RTCHit themselves. */
  const struct RTCRay *ray = (const struct RTCRay *)args->ray;
  const struct RTCHit *hit = (const struct RTCHit *)args->hit;
  if (!query->accept(query->user, ray->id, hit->instID[0], hit->geomID, hit->primID))
    args->valid[0] = 0;
}

void glint_filter_geometry(RTCGeometry geometry) {
  rtcSetGeometryIntersectFilterFunction(geometry, filter);
  rtcSetGeometryOccludedFilterFunction(geometry, filter);
}

#if GLINT_EMBREE_MAJOR == 4

void glint_closest(RTCScene scene, struct RTCRayHit *rays, unsigned n, GlintAccept accept,
                   const void *user) {
  Query query = {.accept = accept, .user = user};
  rtcInitRayQueryContext(&query.context);
  struct RTCIntersectArguments args;
  rtcInitIntersectArguments(&args);
  args.context = &query.context;
  for (unsigned i = 0; i < n; i++) rtcIntersect1(scene, &rays[i], &args);
}

void glint_occluded(RTCScene scene, struct RTCRay *rays, unsigned n, GlintAccept accept,
                    const void *user) {
  Query query = {.accept = accept, .user = user};
  rtcInitRayQueryContext(&query.context);
  struct RTCOccludedArguments args;
  rtcInitOccludedArguments(&args);
  args.context = &query.context;
  for (unsigned i = 0; i < n; i++) rtcOccluded1(scene, &rays[i], &args);
}

#else

void glint_closest(RTCScene scene, struct RTCRayHit *rays, unsigned n, GlintAccept accept,
                   const void *user) {
  Query query = {.accept = accept, .user = user};
  rtcInitIntersectContext(&query.context);
  for (unsigned i = 0; i < n; i++) rtcIntersect1(scene, &query.context, &rays[i]);
}

void glint_occluded(RTCScene scene, struct RTCRay *rays, unsigned n, GlintAccept accept,
                    const void *user) {
  Query query = {.accept = accept, .user = user};
  rtcInitIntersectContext(&query.context);
  for (unsigned i = 0; i < n; i++) rtcOccluded1(scene, &query.context, &rays[i]);
}

#endif
