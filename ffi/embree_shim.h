/* What glint needs of Embree that its headers define inline, and the one place that knows that
 * Embree 3 (Debian 12) and Embree 4 (Debian 13) differ. See ffi/README.md for ownership and threads. */
#ifndef GLINT_EMBREE_SHIM_H
#define GLINT_EMBREE_SHIM_H

#if GLINT_EMBREE_MAJOR == 4
#include <embree4/rtcore.h>
#elif GLINT_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#error "GLINT_EMBREE_MAJOR must be 3 or 4"
#endif

/* 3 or 4. */
int glint_embree_major(void);

/* Answers whether the candidate counts. `user` is what the query was given; `ray` is RTCRay.id;
 * `t` is Embree's own distance. Must not unwind. */
typedef int (*GlintAccept)(const void *user, unsigned ray, unsigned instance, unsigned geometry,
                           unsigned primitive);

/* Closest hit of each of n rays; `accept` may be NULL. */
void glint_closest(RTCScene scene, struct RTCRayHit *rays, unsigned n, GlintAccept accept,
                   const void *user);

/* Any hit of each of n rays: tfar becomes -inf where one is found; `accept` may be NULL. */
void glint_occluded(RTCScene scene, struct RTCRay *rays, unsigned n, GlintAccept accept,
                    const void *user);

/* Has the geometry ask the `accept` of whatever query meets it. */
void glint_filter_geometry(RTCGeometry geometry);

/* For benchmarks: Embree's calls for several rays at once, on n rays in the layout of the call, without
 * filters. `coherent` is the hint of that name. The last packet may be partly filled. */
void glint_closest_8(RTCScene scene, struct RTCRayHit8 *packets, unsigned n, int coherent);
void glint_closest_16(RTCScene scene, struct RTCRayHit16 *packets, unsigned n, int coherent);
void glint_occluded_8(RTCScene scene, struct RTCRay8 *packets, unsigned n, int coherent);
void glint_occluded_16(RTCScene scene, struct RTCRay16 *packets, unsigned n, int coherent);

/* Streams of `length` rays, the last one shorter. Embree 4 has none, and traces ray by ray here. */
void glint_closest_stream(RTCScene scene, struct RTCRayHit *rays, unsigned n, unsigned length,
                          int coherent);
void glint_occluded_stream(RTCScene scene, struct RTCRay *rays, unsigned n, unsigned length,
                           int coherent);

#endif
