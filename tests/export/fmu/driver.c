/* An importer in C, for the sanitizers: two instances, random commands, states, refusals. Exit code 0 when all is right. */
#include "preshape_fmu.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

fmi3Instance fmi3InstantiateCoSimulation(fmi3String, fmi3String, fmi3String, fmi3Boolean, fmi3Boolean, fmi3Boolean,
                                         fmi3Boolean, const fmi3ValueReference[], size_t, fmi3InstanceEnvironment,
                                         fmi3LogMessageCallback, fmi3IntermediateUpdateCallback);
void fmi3FreeInstance(fmi3Instance);
fmi3Status fmi3Reset(fmi3Instance);
fmi3Status fmi3EnterInitializationMode(fmi3Instance, fmi3Boolean, fmi3Float64, fmi3Float64, fmi3Boolean, fmi3Float64);
fmi3Status fmi3ExitInitializationMode(fmi3Instance);
fmi3Status fmi3SetFloat64(fmi3Instance, const fmi3ValueReference[], size_t, const fmi3Float64[], size_t);
fmi3Status fmi3GetFloat64(fmi3Instance, const fmi3ValueReference[], size_t, fmi3Float64[], size_t);
fmi3Status fmi3DoStep(fmi3Instance, fmi3Float64, fmi3Float64, fmi3Boolean, fmi3Boolean *, fmi3Boolean *, fmi3Boolean *,
                      fmi3Float64 *);
fmi3Status fmi3GetFMUState(fmi3Instance, fmi3FMUState *);
fmi3Status fmi3SetFMUState(fmi3Instance, fmi3FMUState);
fmi3Status fmi3FreeFMUState(fmi3Instance, fmi3FMUState *);
fmi3Status fmi3SerializedFMUStateSize(fmi3Instance, fmi3FMUState, size_t *);
fmi3Status fmi3SerializeFMUState(fmi3Instance, fmi3FMUState, fmi3Byte[], size_t);
fmi3Status fmi3DeserializeFMUState(fmi3Instance, const fmi3Byte[], size_t, fmi3FMUState *);

#define CHECK(condition)                                                                                               \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            return __LINE__ % 251 + 1;                                                                                 \
        }                                                                                                              \
    } while (0)

static int messages = 0;

static void hear(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category, fmi3String message) {
    (void)environment;
    messages += (status >= fmi3Discard) && (strlen(category) > 0u) && (strlen(message) > 10u);
}

static fmi3Instance made(void) {
    return fmi3InstantiateCoSimulation("one", PRESHAPE_TABLE_TOKEN, NULL, false, true, false, false, NULL, 0u, NULL,
                                       hear, NULL);
}

static fmi3Status step(fmi3Instance instance, double now, double size, double u, double *y) {
    static const fmi3ValueReference command = 1u, shaped = 2u;
    fmi3Boolean event, terminate, early;
    fmi3Float64 reached;
    fmi3Status status = fmi3SetFloat64(instance, &command, 1u, &u, 1u);
    if (status == fmi3OK) {
        status = fmi3DoStep(instance, now, size, true, &event, &terminate, &early, &reached);
    }
    (void)fmi3GetFloat64(instance, &shaped, 1u, y, 1u);
    return status;
}

int main(void) {
    const double dt = PRESHAPE_TABLE_DT;
    const size_t length = 3u * PRESHAPE_ENTRIES + 7u;
    double first[2] = {0.0, 0.0}, again[2] = {0.0, 0.0}, nothing = 0.0;
    fmi3Instance one = made(), two = made();
    fmi3FMUState state = NULL, copy = NULL;
    fmi3Byte *bytes;
    size_t size = 0u, i, round;
    CHECK((one != NULL) && (two != NULL));
    CHECK(fmi3InstantiateCoSimulation("x", "another", NULL, false, true, false, false, NULL, 0u, NULL, hear, NULL) ==
          NULL);
    CHECK(messages == 1);
    for (round = 0u; round < 2u; ++round) {
        srand(61131u);
        CHECK(fmi3EnterInitializationMode(one, false, 0.0, 0.0, false, 0.0) == fmi3OK);
        CHECK(fmi3ExitInitializationMode(one) == fmi3OK);
        for (i = 0u; i < length; ++i) {
            CHECK(step(one, (double)i * dt, dt, (double)rand(), (round == 0u) ? &first[0] : &again[0]) == fmi3OK);
        }
        CHECK(step(one, (double)length * dt, dt, (double)NAN, &nothing) == fmi3Discard);
        CHECK(step(one, (double)length * dt, 0.3 * dt, 1.0, &nothing) == fmi3Discard);
        CHECK(fmi3Reset(one) == fmi3OK);
    }
    CHECK((first[0] >= again[0]) && (first[0] <= again[0]) && (messages == 5));
    CHECK(fmi3EnterInitializationMode(one, false, 0.0, 0.0, false, 0.0) == fmi3OK);
    CHECK(fmi3ExitInitializationMode(one) == fmi3OK);
    CHECK(step(one, 0.0, dt, 3.0, &nothing) == fmi3OK);
    CHECK(fmi3GetFMUState(one, &state) == fmi3OK);
    CHECK(fmi3GetFMUState(one, &state) == fmi3OK); /* into the same memory */
    CHECK(fmi3SerializedFMUStateSize(one, state, &size) == fmi3OK);
    bytes = (fmi3Byte *)malloc(size);
    CHECK(bytes != NULL);
    CHECK(fmi3SerializeFMUState(one, state, bytes, size - 1u) == fmi3Error);
    CHECK(fmi3SerializeFMUState(one, state, bytes, size) == fmi3OK);
    CHECK(fmi3DeserializeFMUState(two, bytes, size, &copy) == fmi3OK);
    CHECK(fmi3SetFMUState(two, copy) == fmi3OK);
    CHECK(step(one, dt, 5.0 * dt, -2.0, &first[1]) == fmi3OK);
    CHECK(step(two, dt, 5.0 * dt, -2.0, &again[1]) == fmi3OK);
    CHECK((first[1] >= again[1]) && (first[1] <= again[1]));
    for (i = 0u; i < size; ++i) { /* whatever one damaged byte makes of it: refused, or a state that runs */
        fmi3FMUState odd = NULL;
        bytes[i] ^= (fmi3Byte)0x5a;
        if (fmi3DeserializeFMUState(two, bytes, size, &odd) == fmi3OK) {
            CHECK(fmi3SetFMUState(two, odd) == fmi3OK);
            (void)step(two, dt, dt, 1.0, &nothing);
            CHECK(fmi3FreeFMUState(two, &odd) == fmi3OK);
        }
        bytes[i] ^= (fmi3Byte)0x5a;
    }
    free(bytes);
    CHECK((fmi3FreeFMUState(one, &state) == fmi3OK) && (state == NULL));
    CHECK(fmi3FreeFMUState(two, &copy) == fmi3OK);
    fmi3FreeInstance(one);
    fmi3FreeInstance(two);
    fmi3FreeInstance(NULL);
    return 0;
}
