/* Shaping a command sample by sample: C99, no allocation, no globals, no library but memcpy.
 *
 * A shaper on the sample grid is a list of taps, delay d[k] in samples and weight w[k], whose weights sum to 1. All forms
 * below compute, with the last tap as the reference r = u[n - d[last]],
 *
 *     y[n] = r + sum over k < last, in this order, of w[k] * (u[n - d[k]] - r)
 *
 * so that a constant command comes out unchanged, to the last bit, and the last weight is whatever the others leave of 1.
 *
 * One source, two precisions: compile with PRESHAPE_SINGLE defined for float, without it for double; the two may be
 * linked together. Every operation must be rounded to that precision: no -ffast-math, no fused multiply-add
 * (-ffp-contract=off for gcc and clang), no x87 registers.
 *
 * Memory is the caller's and fixed: the struct, and a ring of a power of two of entries, more than the longest delay
 * (PRESHAPE_RING(longest) of them). On a 64-bit machine a gather is 24 bytes, a scatter 64 at most.
 *
 * Worst case of one sample, for K taps (a scatter skips its loop while the command stays; nothing else depends on data):
 *     gather   K loads, K - 1 multiplications, 2 K - 1 additions
 *     scatter  K - 1 multiplications, 20 K + 40 additions, K + 1 loads and stores of pairs
 *     cascade  the sum of its stages
 * reset costs one pass over the ring, scatter_take_over as many scatter samples as the longest delay.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef PRESHAPE_KERNEL_H
#define PRESHAPE_KERNEL_H

#include <stddef.h>
#include <stdint.h>

#ifdef PRESHAPE_SINGLE
typedef float preshape_real;
#define PRESHAPE_LIMIT 1e18f
#define PRESHAPE_NAME(name) name##_f32
#else
typedef double preshape_real;
#define PRESHAPE_LIMIT 1e250
#define PRESHAPE_NAME(name) name##_f64
#endif
/* PRESHAPE_LIMIT: larger commands, infinity and NaN are refused; nothing below it can overflow on the way. */

#define preshape_check PRESHAPE_NAME(preshape_check)
#define preshape_acceptable PRESHAPE_NAME(preshape_acceptable)
#define preshape_convolve PRESHAPE_NAME(preshape_convolve)
#define preshape_gather_configure PRESHAPE_NAME(preshape_gather_configure)
#define preshape_gather_reset PRESHAPE_NAME(preshape_gather_reset)
#define preshape_gather_push PRESHAPE_NAME(preshape_gather_push)
#define preshape_gather_block PRESHAPE_NAME(preshape_gather_block)
#define preshape_cascade_push PRESHAPE_NAME(preshape_cascade_push)
#define preshape_cascade_block PRESHAPE_NAME(preshape_cascade_block)
#define preshape_scatter_configure PRESHAPE_NAME(preshape_scatter_configure)
#define preshape_scatter_reset PRESHAPE_NAME(preshape_scatter_reset)
#define preshape_scatter_push PRESHAPE_NAME(preshape_scatter_push)
#define preshape_scatter_block PRESHAPE_NAME(preshape_scatter_block)
#define preshape_scatter_retune PRESHAPE_NAME(preshape_scatter_retune)
#define preshape_scatter_take_over PRESHAPE_NAME(preshape_scatter_take_over)

/* Entries of the ring for a longest delay, a constant expression: the next power of two above it. */
#define PRESHAPE_FILL1(n) ((n) | ((n) >> 1))
#define PRESHAPE_FILL2(n) (PRESHAPE_FILL1(n) | (PRESHAPE_FILL1(n) >> 2))
#define PRESHAPE_FILL4(n) (PRESHAPE_FILL2(n) | (PRESHAPE_FILL2(n) >> 4))
#define PRESHAPE_FILL8(n) (PRESHAPE_FILL4(n) | (PRESHAPE_FILL4(n) >> 8))
#define PRESHAPE_RING(longest) ((PRESHAPE_FILL8((uint32_t)(longest)) | (PRESHAPE_FILL8((uint32_t)(longest)) >> 16)) + 1u)

typedef enum {
    PRESHAPE_OK = 0,
    PRESHAPE_NOT_FINITE = 1,   /* the sample is NaN, infinite or beyond PRESHAPE_LIMIT: nothing was changed */
    PRESHAPE_BAD_RING = 2,     /* the ring's size is not a power of two */
    PRESHAPE_RING_TOO_SMALL = 3, /* the ring does not hold the longest delay */
    PRESHAPE_BAD_SHAPER = 4    /* no taps, delays not increasing, weights not finite, too large or not of sum 1 */
} preshape_status;

/* A shaper on the grid; it and its arrays may be constants in flash. */
typedef struct {
    const uint32_t *delays;       /* [samples], strictly increasing */
    const preshape_real *weights; /* [-], of sum 1 */
    uint32_t taps;                /* how many, at least 1 */
} preshape_shaper;

/* A fixed shaper: the past commands in a ring. */
typedef struct {
    const preshape_shaper *shaper;
    preshape_real *ring;
    uint32_t mask; /* size - 1 */
    uint32_t at;   /* slot of the next sample */
} preshape_gather;

/* An unevaluated sum of twice the precision. */
typedef struct {
    preshape_real high;
    preshape_real low;
} preshape_pair;

/* A changing shaper: each increment of the command is scattered over the future by the shaper in force. */
typedef struct {
    const preshape_shaper *shaper;
    preshape_pair *ring;   /* what is to arrive, by slot */
    uint32_t mask;
    uint32_t at;
    preshape_pair pending; /* the sum of the ring */
    preshape_real command; /* the last sample */
    uint32_t remaining;    /* samples until everything has arrived */
} preshape_scatter;

/* Whether this shaper runs on a ring of this size. */
preshape_status preshape_check(const preshape_shaper *shaper, uint32_t size);

/* How many samples from the first one on are acceptable: finite, and not beyond PRESHAPE_LIMIT. */
size_t preshape_acceptable(const preshape_real *u, size_t count);

/* y[i] for i < count, from u[i - longest delay] ... u[i]: the caller holds the past before u. y is another array. */
void preshape_convolve(const preshape_shaper *shaper, const preshape_real *u, preshape_real *y, size_t count);

/* Bind memory and shaper together, at rest at 0; `size` entries in `ring`. */
preshape_status preshape_gather_configure(preshape_gather *g, const preshape_shaper *shaper, preshape_real *ring,
                                          uint32_t size);
/* As if `value` had been commanded for ever. */
preshape_status preshape_gather_reset(preshape_gather *g, preshape_real value);
preshape_status preshape_gather_push(preshape_gather *g, preshape_real u, preshape_real *y);
/* The same for many samples, bit for bit; y is u itself or another array. Returns how many were taken: it stops before
 * the first that is not acceptable. */
size_t preshape_gather_block(preshape_gather *g, const preshape_real *u, preshape_real *y, size_t count);

/* Several shapers in a row, each with its own ring: what their convolution does, with the sum of their taps instead of
 * the product (Hyde, 3.2.2). The product of the sums of |w| must stay below 1e18. */
preshape_status preshape_cascade_push(preshape_gather *stages, uint32_t count, preshape_real u, preshape_real *y);
size_t preshape_cascade_block(preshape_gather *stages, uint32_t count, const preshape_real *u, preshape_real *y,
                              size_t samples);

preshape_status preshape_scatter_configure(preshape_scatter *s, const preshape_shaper *shaper, preshape_pair *ring,
                                           uint32_t size);
preshape_status preshape_scatter_reset(preshape_scatter *s, preshape_real value);
preshape_status preshape_scatter_push(preshape_scatter *s, preshape_real u, preshape_real *y);
size_t preshape_scatter_block(preshape_scatter *s, const preshape_real *u, preshape_real *y, size_t count);
/* Increments from the next sample on go through this shaper; those commanded before arrive as they would have. */
preshape_status preshape_scatter_retune(preshape_scatter *s, const preshape_shaper *shaper);
/* Go on where a gather stands, from its past; `s` must be configured with a ring that holds the gather's shaper. */
preshape_status preshape_scatter_take_over(preshape_scatter *s, const preshape_gather *g);

#endif
