/* Drives the kernel's interface with whatever bytes come, and stops at the first broken promise.
 *
 * With libFuzzer:  clang -g -O1 -fsanitize=fuzzer,address,undefined -Isrc/preshape/kernel/c tests/fuzz/fuzz_kernel.c
 * Without it:      gcc -DSTANDALONE -g -O1 -fsanitize=address,undefined -Isrc/preshape/kernel/c tests/fuzz/fuzz_kernel.c
 *                  and run it with a number of seconds and a seed.
 * Both take -DPRESHAPE_SINGLE too. tests/kernel/test_c_kernel.py runs the second for a second.
 */
#include "preshape_kernel.c"

#include <stdio.h>
#include <stdlib.h>

#define MOST 64u /* taps */
#define SMALLEST ((sizeof(preshape_real) == 4u) ? (preshape_real)FLT_MIN : (preshape_real)DBL_MIN) /* below it: steps */
#define ROUNDING ((sizeof(preshape_real) == 4u) ? (preshape_real)1e-2 : (preshape_real)1e-11)

typedef struct {
    const uint8_t *at, *end;
} Bytes;

static uint32_t number(Bytes *bytes, uint32_t below) {
    uint32_t value = 0u;
    for (int i = 0; i < 4; ++i) {
        value = (value << 8) | ((bytes->at < bytes->end) ? *bytes->at++ : 0u);
    }
    return (below == 0u) ? value : value % below;
}

static preshape_real sample(Bytes *bytes) {
    preshape_real value = (preshape_real)0.0;
    const uint32_t kind = number(bytes, 8u);
    if (kind == 0u) { /* any bit pattern */
        uint32_t raw[2] = {number(bytes, 0u), number(bytes, 0u)};
        memcpy(&value, raw, sizeof value);
        return value;
    }
    value = (preshape_real)((int32_t)number(bytes, 2001u) - 1000) / (preshape_real)7.0;
    return (kind == 1u) ? value * (PRESHAPE_LIMIT / (preshape_real)1000.0) : (kind == 2u) ? (preshape_real)3.0 : value;
}

static void promise(int kept, const char *what) {
    if (!kept) {
        fprintf(stderr, "broken promise: %s\n", what);
        abort();
    }
}

static int same(preshape_real a, preshape_real b) {
    return memcmp(&a, &b, sizeof a) == 0;
}

/* A shaper out of the bytes: often a good one. */
static preshape_status shaper_of(Bytes *bytes, preshape_shaper *shaper, uint32_t *delays, preshape_real *weights,
                                 uint32_t size) {
    preshape_real total = (preshape_real)0.0;
    shaper->taps = number(bytes, MOST);
    shaper->delays = delays;
    shaper->weights = weights;
    const int wild = number(bytes, 8u) == 0u;
    for (uint32_t k = 0u; k < shaper->taps; ++k) {
        delays[k] = wild ? number(bytes, 0u) : ((k == 0u) ? 0u : delays[k - 1u] + 1u + number(bytes, 2u * size / MOST + 1u));
        weights[k] = wild ? sample(bytes) : (preshape_real)((int32_t)number(bytes, 200u) - 50) / (preshape_real)100.0;
        if (!wild && (k + 1u == shaper->taps)) {
            weights[k] = (preshape_real)1.0 - total;
        }
        total += weights[k];
    }
    return preshape_check(shaper, size);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t length);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t length) {
    Bytes bytes = {data, data + length};
    const uint32_t size = (number(&bytes, 16u) == 0u) ? number(&bytes, 5000u) : (1u << number(&bytes, 12u));
    uint32_t delays[2][MOST];
    preshape_real weights[2][MOST];
    preshape_shaper first, second;
    const preshape_status one = shaper_of(&bytes, &first, delays[0], weights[0], size);
    const preshape_status two = shaper_of(&bytes, &second, delays[1], weights[1], size);
    if (size == 0u) {
        return 0;
    }
    preshape_real *const rings = malloc(4u * (size_t)size * sizeof(preshape_real)); /* found by the sanitizer if overrun */
    preshape_pair *const pairs = malloc((size_t)size * sizeof(preshape_pair));
    preshape_gather push, block, stages[2];
    preshape_scatter scatter;
    promise(preshape_gather_configure(&push, &first, rings, size) == one, "configuration checks");
    if ((one == PRESHAPE_OK) && (two == PRESHAPE_OK)) {
        (void)preshape_gather_configure(&block, &first, rings + size, size);
        (void)preshape_gather_configure(&stages[0], &first, rings + 2u * size, size);
        (void)preshape_gather_configure(&stages[1], &second, rings + 3u * size, size);
        (void)preshape_scatter_configure(&scatter, &first, pairs, size);
        preshape_real largest = (preshape_real)0.0;
        int together = 1; /* push and scatter have the same shaper and past */
        while (bytes.at < bytes.end) {
            const size_t count = number(&bytes, (number(&bytes, 4u) == 0u) ? 6000u : 40u);
            preshape_real *const u = malloc((count + 1u) * sizeof(preshape_real));
            preshape_real *const y = malloc((count + 1u) * sizeof(preshape_real));
            preshape_real *const gathered = malloc((count + 1u) * sizeof(preshape_real));
            const uint32_t hold = number(&bytes, 2u);
            for (size_t i = 0u; i < count; ++i) {
                u[i] = ((i > 0u) && (hold != 0u)) ? u[0] : sample(&bytes);
            }
            const size_t good = preshape_acceptable(u, count);
            const int in_place = number(&bytes, 2u) == 0u;
            memcpy(y, u, count * sizeof(preshape_real));
            promise(preshape_gather_block(&block, in_place ? y : u, y, count) == good, "a block stops at the same place");
            for (size_t i = 0u; i < good; ++i) {
                preshape_real single;
                promise(preshape_gather_push(&push, u[i], &single) == PRESHAPE_OK, "good samples are taken");
                promise(same(single, y[i]), "blocks are samples");
                promise(acceptable(single / (preshape_real)1e7), "outputs are finite");
            }
            if (good < count) {
                preshape_real single = (preshape_real)5.0;
                promise(preshape_gather_push(&push, u[good], &single) == PRESHAPE_NOT_FINITE, "bad ones are refused");
                promise(same(single, (preshape_real)5.0), "and nothing is written");
            }
            if ((hold != 0u) && (good > first.delays[first.taps - 1u])) {
                promise(y[good - 1u] == u[0], "a constant comes out");
            }
            memcpy(gathered, y, good * sizeof(preshape_real));
            promise(preshape_cascade_block(stages, 2u, u, y, count) == good, "a cascade too");
            promise(preshape_scatter_block(&scatter, u, y, count) == good, "a scatter too");
            for (size_t i = 0u; i < good; ++i) {
                const preshape_real size = (u[i] < (preshape_real)0.0) ? -u[i] : u[i];
                const preshape_real off = (y[i] > gathered[i]) ? y[i] - gathered[i] : gathered[i] - y[i];
                largest = (size > largest) ? size : largest;
                promise(acceptable(y[i] / (preshape_real)1e12), "what scatters is finite");
                promise(!together || (off <= SMALLEST + ROUNDING * largest), "a shaper that stays scatters what it gathers");
            }
            if ((good > 0u) && (scatter.remaining == 0u) && (scatter.pending.high == (preshape_real)0.0)) {
                promise(y[good - 1u] == u[good - 1u], "at rest the command comes out");
            }
            switch (number(&bytes, 6u)) {
            case 0u:
                promise(preshape_scatter_retune(&scatter, &second) == PRESHAPE_OK, "retuned");
                together = 0;
                break;
            case 1u:
                promise(preshape_scatter_take_over(&scatter, &push) == PRESHAPE_OK, "taken over");
                together = 1;
                break;
            case 2u: {
                const preshape_real value = sample(&bytes);
                const preshape_status status = acceptable(value) ? PRESHAPE_OK : PRESHAPE_NOT_FINITE;
                if (status == PRESHAPE_OK) {
                    const preshape_real size = (value < (preshape_real)0.0) ? -value : value;
                    largest = (size > largest) ? size : largest;
                }
                promise(preshape_gather_reset(&push, value) == status, "reset");
                promise(preshape_gather_reset(&block, value) == status, "reset");
                promise(preshape_scatter_reset(&scatter, value) == status, "reset");
                break;
            }
            default:
                break;
            }
            free(u);
            free(y);
            free(gathered);
        }
    }
    free(rings);
    free(pairs);
    return 0;
}

#ifdef STANDALONE
#include <time.h>

int main(int count, char **arguments) {
    const double seconds = (count > 1) ? atof(arguments[1]) : 1.0;
    uint64_t state = (count > 2) ? strtoull(arguments[2], NULL, 10) : 1u;
    const clock_t start = clock();
    unsigned long runs = 0u;
    static uint8_t data[4096];
    while ((double)(clock() - start) < seconds * (double)CLOCKS_PER_SEC) {
        size_t length;
        for (size_t i = 0u; i < sizeof data; ++i) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            data[i] = (uint8_t)(state >> 56);
        }
        length = (size_t)(state >> 32) % sizeof data;
        (void)LLVMFuzzerTestOneInput(data, length);
        ++runs;
    }
    printf("%lu inputs, no finding\n", runs);
    return 0;
}
#endif
