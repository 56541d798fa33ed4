/* Shaping a command sample by sample; see preshape_kernel.h.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "preshape_kernel.h"

#include <float.h>
#include <string.h>

#if defined(__FAST_MATH__)
#error "preshape's arithmetic must not be reordered: compile without -ffast-math"
#endif
#if defined(FLT_EVAL_METHOD) && (FLT_EVAL_METHOD != 0) && (FLT_EVAL_METHOD != 16)
#error "preshape's arithmetic must be rounded to its own type: compile for SSE or the like, not for x87"
#endif

#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF /* clang fuses multiplications even with -std=c99; gcc does not know this pragma */
#endif

#ifndef PRESHAPE_CLONES
#define PRESHAPE_CLONES /* attribute for the hot loop, such as target_clones(...) */
#endif

#define BLOCK ((size_t)2048)     /* samples that stay in the first cache while every tap passes over them */
#define GROUP ((uint32_t)8)      /* taps a pass */
#define LARGEST_SUM ((preshape_real)1e6) /* of |w| */
#define SUM_TOLERANCE ((preshape_real)1e-3)
#define MOST_TAPS ((uint32_t)1 << 24)

#ifdef PRESHAPE_SINGLE
typedef int32_t preshape_integer;
#else
typedef int64_t preshape_integer; /* as wide as a real */
#endif

static const preshape_real ZERO = (preshape_real)0.0;

static int acceptable(preshape_real u) {
    return ((u >= -PRESHAPE_LIMIT) & (u <= PRESHAPE_LIMIT)) != 0;
}

static size_t least(size_t a, size_t b) {
    return (a < b) ? a : b;
}

static uint32_t longest_of(const preshape_shaper *shaper) {
    return shaper->delays[shaper->taps - 1u];
}

preshape_status preshape_check(const preshape_shaper *shaper, uint32_t size) {
    preshape_real total = ZERO;
    preshape_real sizes = ZERO;
    uint32_t k;
    if ((size == 0u) || ((size & (size - 1u)) != 0u)) {
        return PRESHAPE_BAD_RING;
    }
    if ((shaper->taps == 0u) || (shaper->taps > MOST_TAPS)) {
        return PRESHAPE_BAD_SHAPER;
    }
    for (k = 0u; k < shaper->taps; ++k) {
        const preshape_real w = shaper->weights[k];
        if ((k > 0u) && (shaper->delays[k] <= shaper->delays[k - 1u])) {
            return PRESHAPE_BAD_SHAPER;
        }
        total += w;
        sizes += (w < ZERO) ? -w : w;
    }
    if (!(sizes <= LARGEST_SUM) || !(total >= (preshape_real)1.0 - SUM_TOLERANCE) ||
        !(total <= (preshape_real)1.0 + SUM_TOLERANCE)) {
        return PRESHAPE_BAD_SHAPER;
    }
    return (longest_of(shaper) < size) ? PRESHAPE_OK : PRESHAPE_RING_TOO_SMALL;
}

/* Whether a run holds a sample that is not acceptable; without a branch, so that it runs in vectors. */
PRESHAPE_CLONES
static int holds_bad(const preshape_real *u, size_t count) {
    preshape_integer bad = 0;
    size_t i;
    for (i = 0u; i < count; ++i) {
        bad |= (u[i] >= -PRESHAPE_LIMIT) ? 0 : 1;
        bad |= (u[i] <= PRESHAPE_LIMIT) ? 0 : 1;
    }
    return bad != 0;
}

size_t preshape_acceptable(const preshape_real *u, size_t count) {
    size_t done = 0u;
    while (done < count) {
        const size_t run = least(count - done, BLOCK);
        if (holds_bad(u + done, run)) {
            while (acceptable(u[done])) {
                ++done;
            }
            return done;
        }
        done += run;
    }
    return count;
}

/* Eight taps over a run: y = [y +] the sum of w (p - r) [+ r]; `first` and `final` are constants where it is inlined. */
static inline void pass(preshape_real *restrict y, size_t count, const preshape_real *r, const preshape_real *const *p,
                        const preshape_real *w, int first, int final) {
    const preshape_real *p0 = p[0], *p1 = p[1], *p2 = p[2], *p3 = p[3], *p4 = p[4], *p5 = p[5], *p6 = p[6], *p7 = p[7];
    const preshape_real w0 = w[0], w1 = w[1], w2 = w[2], w3 = w[3], w4 = w[4], w5 = w[5], w6 = w[6], w7 = w[7];
    size_t i;
    for (i = 0u; i < count; ++i) {
        const preshape_real reference = r[i];
        preshape_real sum = first ? ZERO : y[i];
        sum += w0 * (p0[i] - reference);
        sum += w1 * (p1[i] - reference);
        sum += w2 * (p2[i] - reference);
        sum += w3 * (p3[i] - reference);
        sum += w4 * (p4[i] - reference);
        sum += w5 * (p5[i] - reference);
        sum += w6 * (p6[i] - reference);
        sum += w7 * (p7[i] - reference);
        y[i] = final ? (reference + sum) : sum;
    }
}

/* Where the samples of one delay are: in a ring around slot `at`, or with mask 0 in the samples before `base`. */
static inline const preshape_real *source(const preshape_real *base, uint32_t mask, uint32_t at, uint32_t delay) {
    return (mask == 0u) ? (base - delay) : (base + ((at - delay) & mask));
}

/* All taps over a run of at most BLOCK samples; none of the sources may reach over the ring's end. Missing taps of the
 * last eight have weight 0 and add exactly nothing. */
PRESHAPE_CLONES
static void blend(const preshape_shaper *shaper, const preshape_real *base, uint32_t mask, uint32_t at,
                  preshape_real *restrict y, size_t count) {
    const uint32_t last = shaper->taps - 1u;
    const preshape_real *const r = source(base, mask, at, longest_of(shaper));
    uint32_t k;
    for (k = 0u; (k < last) || (k == 0u); k += GROUP) {
        const preshape_real *p[GROUP];
        preshape_real w[GROUP];
        uint32_t j;
        for (j = 0u; j < GROUP; ++j) {
            const int used = (k + j) < last;
            p[j] = used ? source(base, mask, at, shaper->delays[k + j]) : r;
            w[j] = used ? shaper->weights[k + j] : ZERO;
        }
        if ((k == 0u) && (last <= GROUP)) {
            pass(y, count, r, p, w, 1, 1);
        } else if (k == 0u) {
            pass(y, count, r, p, w, 1, 0);
        } else if (last - k <= GROUP) {
            pass(y, count, r, p, w, 0, 1);
        } else {
            pass(y, count, r, p, w, 0, 0);
        }
    }
}

void preshape_convolve(const preshape_shaper *shaper, const preshape_real *u, preshape_real *y, size_t count) {
    size_t done;
    for (done = 0u; done < count; done += BLOCK) {
        blend(shaper, u + done, 0u, 0u, y + done, least(count - done, BLOCK));
    }
}

preshape_status preshape_gather_configure(preshape_gather *g, const preshape_shaper *shaper, preshape_real *ring,
                                          uint32_t size) {
    const preshape_status status = preshape_check(shaper, size);
    if (status == PRESHAPE_OK) {
        g->shaper = shaper;
        g->ring = ring;
        g->mask = size - 1u;
        g->at = 0u;
        (void)preshape_gather_reset(g, ZERO);
    }
    return status;
}

preshape_status preshape_gather_reset(preshape_gather *g, preshape_real value) {
    uint32_t i;
    if (!acceptable(value)) {
        return PRESHAPE_NOT_FINITE;
    }
    for (i = 0u; i <= g->mask; ++i) {
        g->ring[i] = value;
    }
    return PRESHAPE_OK;
}

static preshape_real gather_step(preshape_gather *g, preshape_real u) {
    const preshape_shaper *const shaper = g->shaper;
    const uint32_t *const delays = shaper->delays;
    const preshape_real *const weights = shaper->weights;
    preshape_real *const ring = g->ring;
    const uint32_t last = shaper->taps - 1u;
    const uint32_t mask = g->mask;
    const uint32_t at = g->at;
    preshape_real sum = ZERO;
    preshape_real reference;
    uint32_t k;
    ring[at] = u;
    reference = ring[(at - delays[last]) & mask];
    for (k = 0u; k < last; ++k) {
        sum += weights[k] * (ring[(at - delays[k]) & mask] - reference);
    }
    g->at = (at + 1u) & mask;
    return reference + sum;
}

preshape_status preshape_gather_push(preshape_gather *g, preshape_real u, preshape_real *y) {
    if (!acceptable(u)) {
        return PRESHAPE_NOT_FINITE;
    }
    *y = gather_step(g, u);
    return PRESHAPE_OK;
}

/* Through the ring, in runs in which nothing reaches over its end; y may be u. */
static void gather_runs(preshape_gather *g, const preshape_real *u, preshape_real *y, size_t count) {
    const preshape_shaper *const shaper = g->shaper;
    const size_t size = (size_t)g->mask + 1u;
    size_t done = 0u;
    while (done < count) {
        size_t run = least(least(count - done, BLOCK), size - longest_of(shaper));
        uint32_t k;
        run = least(run, size - g->at);
        for (k = 0u; k < shaper->taps; ++k) {
            run = least(run, size - ((g->at - shaper->delays[k]) & g->mask));
        }
        (void)memcpy(g->ring + g->at, u + done, run * sizeof(preshape_real));
        blend(shaper, g->ring, g->mask, g->at, y + done, run);
        g->at = (g->at + (uint32_t)run) & g->mask;
        done += run;
    }
}

/* Put samples into the ring that were shaped elsewhere. */
static void gather_remember(preshape_gather *g, const preshape_real *u, size_t count) {
    const size_t size = (size_t)g->mask + 1u;
    const size_t skipped = (count > size) ? (count - size) : 0u;
    size_t done = skipped;
    g->at = (uint32_t)((g->at + skipped) & g->mask);
    while (done < count) {
        const size_t run = least(count - done, size - g->at);
        (void)memcpy(g->ring + g->at, u + done, run * sizeof(preshape_real));
        g->at = (g->at + (uint32_t)run) & g->mask;
        done += run;
    }
}

size_t preshape_gather_block(preshape_gather *g, const preshape_real *u, preshape_real *y, size_t count) {
    const size_t head = (y == u) ? count : least(count, longest_of(g->shaper));
    size_t done = preshape_acceptable(u, head);
    gather_runs(g, u, y, done);
    if (done == head) { /* from here on the past is in u; each run is checked while it comes into the cache */
        size_t good = BLOCK;
        while ((done < count) && (good == BLOCK)) {
            good = preshape_acceptable(u + done, least(count - done, BLOCK));
            blend(g->shaper, u + done, 0u, 0u, y + done, good);
            done += good;
        }
        gather_remember(g, u + head, done - head);
    }
    return done;
}

preshape_status preshape_cascade_push(preshape_gather *stages, uint32_t count, preshape_real u, preshape_real *y) {
    preshape_real value = u;
    uint32_t j;
    if (!acceptable(u)) {
        return PRESHAPE_NOT_FINITE;
    }
    for (j = 0u; j < count; ++j) {
        value = gather_step(&stages[j], value);
    }
    *y = value;
    return PRESHAPE_OK;
}

size_t preshape_cascade_block(preshape_gather *stages, uint32_t count, const preshape_real *u, preshape_real *y,
                              size_t samples) {
    const size_t good = preshape_acceptable(u, samples);
    size_t done;
    for (done = 0u; done < good; done += BLOCK) {
        uint32_t j;
        for (j = 0u; j < count; ++j) {
            gather_runs(&stages[j], (j == 0u) ? (u + done) : (y + done), y + done, least(good - done, BLOCK));
        }
    }
    return good;
}

/* a + b exactly, as a pair (Knuth). */
static preshape_pair two_sum(preshape_real a, preshape_real b) {
    preshape_pair sum;
    preshape_real shadow;
    sum.high = a + b;
    shadow = sum.high - a;
    sum.low = (a - (sum.high - shadow)) + (b - shadow);
    return sum;
}

/* a + b to twice the precision of the larger. */
static preshape_pair pair_sum(preshape_pair a, preshape_pair b) {
    preshape_pair sum = two_sum(a.high, b.high);
    const preshape_real low = sum.low + (a.low + b.low);
    const preshape_real high = sum.high + low;
    sum.low = low - (high - sum.high);
    sum.high = high;
    return sum;
}

static preshape_pair negative(preshape_pair a) {
    a.high = -a.high;
    a.low = -a.low;
    return a;
}

static preshape_real scatter_step(preshape_scatter *s, preshape_real u) {
    const preshape_shaper *const shaper = s->shaper;
    const uint32_t last = shaper->taps - 1u;
    const preshape_pair nothing = {ZERO, ZERO};
    const preshape_pair increment = two_sum(u, -s->command);
    preshape_pair out;
    s->command = u;
    if ((increment.high < ZERO) || (increment.high > ZERO)) {
        preshape_pair rest = increment;
        preshape_pair *slot;
        uint32_t k;
        for (k = 0u; k < last; ++k) {
            preshape_pair piece;
            piece.high = shaper->weights[k] * increment.high;
            piece.low = ZERO;
            slot = &s->ring[(s->at + shaper->delays[k]) & s->mask];
            *slot = pair_sum(*slot, piece);
            rest = pair_sum(rest, negative(piece));
        }
        slot = &s->ring[(s->at + shaper->delays[last]) & s->mask];
        *slot = pair_sum(*slot, rest);
        s->pending = pair_sum(s->pending, increment);
        if (s->remaining < shaper->delays[last]) {
            s->remaining = shaper->delays[last];
        }
    }
    s->pending = pair_sum(s->pending, negative(s->ring[s->at]));
    s->ring[s->at] = nothing;
    s->at = (s->at + 1u) & s->mask;
    if (s->remaining == 0u) {
        s->pending = nothing; /* everything has arrived: the rounding of the way ends here */
    } else {
        --s->remaining;
    }
    out = two_sum(u, -s->pending.high);
    return out.high + (out.low - s->pending.low);
}

preshape_status preshape_scatter_configure(preshape_scatter *s, const preshape_shaper *shaper, preshape_pair *ring,
                                           uint32_t size) {
    const preshape_status status = preshape_check(shaper, size);
    if (status == PRESHAPE_OK) {
        s->shaper = shaper;
        s->ring = ring;
        s->mask = size - 1u;
        s->at = 0u;
        (void)preshape_scatter_reset(s, ZERO);
    }
    return status;
}

preshape_status preshape_scatter_reset(preshape_scatter *s, preshape_real value) {
    const preshape_pair nothing = {ZERO, ZERO};
    uint32_t i;
    if (!acceptable(value)) {
        return PRESHAPE_NOT_FINITE;
    }
    for (i = 0u; i <= s->mask; ++i) {
        s->ring[i] = nothing;
    }
    s->pending = nothing;
    s->command = value;
    s->remaining = 0u;
    return PRESHAPE_OK;
}

preshape_status preshape_scatter_push(preshape_scatter *s, preshape_real u, preshape_real *y) {
    if (!acceptable(u)) {
        return PRESHAPE_NOT_FINITE;
    }
    *y = scatter_step(s, u);
    return PRESHAPE_OK;
}

size_t preshape_scatter_block(preshape_scatter *s, const preshape_real *u, preshape_real *y, size_t count) {
    const size_t good = preshape_acceptable(u, count);
    size_t i;
    for (i = 0u; i < good; ++i) {
        y[i] = scatter_step(s, u[i]);
    }
    return good;
}

preshape_status preshape_scatter_retune(preshape_scatter *s, const preshape_shaper *shaper) {
    const preshape_status status = preshape_check(shaper, s->mask + 1u);
    if (status == PRESHAPE_OK) {
        s->shaper = shaper;
    }
    return status;
}

preshape_status preshape_scatter_take_over(preshape_scatter *s, const preshape_gather *g) {
    const uint32_t longest = longest_of(g->shaper);
    const preshape_status status = preshape_scatter_retune(s, g->shaper);
    uint32_t age;
    if (status == PRESHAPE_OK) {
        (void)preshape_scatter_reset(s, g->ring[(g->at - 1u - longest) & g->mask]);
        for (age = longest; age > 0u; --age) {
            (void)scatter_step(s, g->ring[(g->at - age) & g->mask]);
        }
    }
    return status;
}
