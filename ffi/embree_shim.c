/* See embree_shim.h. */
#include "embree_shim.h"
#include <stddef.h>

/* Layouts that Rust's side writes into; bindgen's own tests check the same from Rust. */
_Static_assert(sizeof(struct RTCRay) == 48, "RTCRay has an unknown layout");
_Static_assert(offsetof(struct RTCRayHit, hit) == 48, "RTCRayHit has an unknown layout");
_Static_assert(sizeof(struct RTCRay16) == 16 * 48, "RTCRay16 has an unknown layout");
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

int glint_embree_major(void) { return GLINT_EMBREE_MAJOR; }

/* Which lanes of a packet hold rays: all, but in the last one. */
static const int all[16] __attribute__((aligned(64))) = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                         -1, -1, -1, -1, -1, -1, -1, -1};

static const int *lanes(int first[16], unsigned left, unsigned width) {
  if (left >= width) return all;
  for (unsigned lane = 0; lane < width; lane++) first[lane] = lane < left ? -1 : 0;
  return first;
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

/* A function of the name that traces n rays in packets of `width` by Embree's `call`. */
#define PACKETS(name, packet, arguments_type, init, call, width)                                 \
  void name(RTCScene scene, packet *packets, unsigned n, int coherent) {                         \
    Query query = {.accept = NULL};                                                              \
    rtcInitRayQueryContext(&query.context);                                                      \
    arguments_type args;                                                                         \
    init(&args);                                                                                 \
    args.context = &query.context;                                                               \
    args.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;         \
    int first[16] __attribute__((aligned(64)));                                                  \
    for (unsigned i = 0; i < n; i += width)                                                      \
      call(lanes(first, n - i, width), scene, &packets[i / width], &args);                       \
  }
#define CLOSEST struct RTCIntersectArguments, rtcInitIntersectArguments
#define OCCLUDED struct RTCOccludedArguments, rtcInitOccludedArguments
#define EXPAND(...) PACKETS(__VA_ARGS__)
EXPAND(glint_closest_8, struct RTCRayHit8, CLOSEST, rtcIntersect8, 8)
EXPAND(glint_closest_16, struct RTCRayHit16, CLOSEST, rtcIntersect16, 16)
EXPAND(glint_occluded_8, struct RTCRay8, OCCLUDED, rtcOccluded8, 8)
EXPAND(glint_occluded_16, struct RTCRay16, OCCLUDED, rtcOccluded16, 16)

void glint_closest_stream(RTCScene scene, struct RTCRayHit *rays, unsigned n, unsigned length,
                          int coherent) {
  (void)length, (void)coherent;
  glint_closest(scene, rays, n, NULL, NULL);
}

void glint_occluded_stream(RTCScene scene, struct RTCRay *rays, unsigned n, unsigned length,
                           int coherent) {
  (void)length, (void)coherent;
  glint_occluded(scene, rays, n, NULL, NULL);
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

static Query hinted(int coherent) {
  Query query = {.accept = NULL};
  rtcInitIntersectContext(&query.context);
  query.context.flags =
      coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return query;
}

/* A function of the name that traces n rays in packets of `width` by Embree's `call`. */
#define PACKETS(name, packet, call, width)                                                       \
  void name(RTCScene scene, packet *packets, unsigned n, int coherent) {                         \
    Query query = hinted(coherent);                                                              \
    int first[16] __attribute__((aligned(64)));                                                  \
    for (unsigned i = 0; i < n; i += width)                                                      \
      call(lanes(first, n - i, width), scene, &query.context, &packets[i / width]);              \
  }
PACKETS(glint_closest_8, struct RTCRayHit8, rtcIntersect8, 8)
PACKETS(glint_closest_16, struct RTCRayHit16, rtcIntersect16, 16)
PACKETS(glint_occluded_8, struct RTCRay8, rtcOccluded8, 8)
PACKETS(glint_occluded_16, struct RTCRay16, rtcOccluded16, 16)

void glint_closest_stream(RTCScene scene, struct RTCRayHit *rays, unsigned n, unsigned length,
                          int coherent) {
  Query query = hinted(coherent);
  for (unsigned i = 0; i < n; i += length)
    rtcIntersect1M(scene, &query.context, &rays[i], n - i < length ? n - i : length, sizeof *rays);
}

void glint_occluded_stream(RTCScene scene, struct RTCRay *rays, unsigned n, unsigned length,
                           int coherent) {
  Query query = hinted(coherent);
  for (unsigned i = 0; i < n; i += length)
    rtcOccluded1M(scene, &query.context, &rays[i], n - i < length ? n - i : length, sizeof *rays);
}

#endif
