/* The state of an instance: copied, written to bytes and read back.
 *
 * The bytes begin with the FMU's token and are in the byte order of the machine; a state of another FMU, or one that
 * cannot be, is refused.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "preshape_fmu.h"

#include <stdlib.h>
#include <string.h>

#define TOKEN sizeof(PRESHAPE_TABLE_TOKEN)

FMI3_API fmi3Status FMI3(GetFMUState)(fmi3Instance instance, fmi3FMUState *state) {
    const preshape_instance *const self = (const preshape_instance *)instance;
    preshape_memory *copy = (preshape_memory *)*state;
    if (copy == NULL) {
        copy = (preshape_memory *)malloc(sizeof(preshape_memory));
    }
    if (copy == NULL) {
        return preshape_say(self, fmi3Error, "there is no memory for a state.");
    }
    (void)memcpy(copy, &self->memory, sizeof(preshape_memory));
    copy->at = self->gather.at;
    *state = copy;
    return fmi3OK;
}

FMI3_API fmi3Status FMI3(SetFMUState)(fmi3Instance instance, fmi3FMUState state) {
    preshape_instance *const self = (preshape_instance *)instance;
    if (state == NULL) {
        return preshape_say(self, fmi3Error, "there is no such state.");
    }
    (void)memcpy(&self->memory, state, sizeof(preshape_memory));
    self->gather.at = self->memory.at;
    return fmi3OK;
}

FMI3_API fmi3Status FMI3(FreeFMUState)(fmi3Instance instance, fmi3FMUState *state) {
    (void)instance;
    if (state != NULL) {
        free(*state);
        *state = NULL;
    }
    return fmi3OK;
}

FMI3_API fmi3Status FMI3(SerializedFMUStateSize)(fmi3Instance instance, fmi3FMUState state, size_t *size) {
    (void)instance;
    (void)state;
    *size = TOKEN + sizeof(preshape_memory);
    return fmi3OK;
}

FMI3_API fmi3Status FMI3(SerializeFMUState)(fmi3Instance instance, fmi3FMUState state, fmi3Byte bytes[], size_t size) {
    const preshape_instance *const self = (const preshape_instance *)instance;
    if ((state == NULL) || (size < TOKEN + sizeof(preshape_memory))) {
        return preshape_say(self, fmi3Error, "the buffer is too small for a state, or there is no state.");
    }
    (void)memcpy(bytes, PRESHAPE_TABLE_TOKEN, TOKEN);
    (void)memcpy(bytes + TOKEN, state, sizeof(preshape_memory));
    return fmi3OK;
}

/* Whether an instance can be in this state. */
static int possible(const preshape_memory *memory) {
    uint32_t i;
    if ((memory->at >= PRESHAPE_ENTRIES) || (memory->mode > PRESHAPE_TERMINATED) || (memory->pass > 1u) ||
        (memory->logging > 1u) || !preshape_usable(memory->initial) || !preshape_usable(memory->held) ||
        !preshape_usable(memory->time)) {
        return 0;
    }
    for (i = 0u; i < PRESHAPE_ENTRIES; ++i) {
        if (!preshape_usable((double)memory->ring[i])) {
            return 0;
        }
    }
    return 1;
}

FMI3_API fmi3Status FMI3(DeserializeFMUState)(fmi3Instance instance, const fmi3Byte bytes[], size_t size,
                                              fmi3FMUState *state) {
    const preshape_instance *const self = (const preshape_instance *)instance;
    preshape_memory *copy;
    if ((size != TOKEN + sizeof(preshape_memory)) || (memcmp(bytes, PRESHAPE_TABLE_TOKEN, TOKEN) != 0)) {
        return preshape_say(self, fmi3Error, "these bytes are no state of this FMU.");
    }
    copy = (preshape_memory *)malloc(sizeof(preshape_memory));
    if (copy == NULL) {
        return preshape_say(self, fmi3Error, "there is no memory for a state.");
    }
    (void)memcpy(copy, bytes + TOKEN, sizeof(preshape_memory));
    if (!possible(copy)) {
        free(copy);
        return preshape_say(self, fmi3Error, "these bytes are damaged: no instance can be in this state.");
    }
    *state = copy;
    return fmi3OK;
}
