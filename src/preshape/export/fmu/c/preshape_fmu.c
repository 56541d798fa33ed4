/* A shaper as a co-simulation FMU of FMI 3.0: its life, its variables and its step.
 *
 * One internal step takes the command, held since the last communication point, and gives one sample. Memory is
 * allocated when an instance or a state is made, never in a step; nothing is shared between instances.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "preshape_fmu.h"
#include "preshape_taps.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TIME = 0, COMMAND = 1, SHAPED = 2, INITIAL = 3, PASS = 4 };

#define ON_GRID 1e-6 /* how far times may be from whole multiples of the sample time, in samples ... */
#define ROUNDING 1e-15 /* ... and beyond that relative to the time, whose sums and differences are rounded */

static const preshape_shaper SHAPER = {DELAYS, WEIGHTS, PRESHAPE_TABLE_TAPS};

static double size_of(double value) {
    return (value < 0.0) ? -value : value;
}

static void start(preshape_instance *instance) {
    preshape_memory *const memory = &instance->memory;
    memory->time = memory->command = memory->shaped = memory->initial = memory->held = 0.0;
    memory->mode = PRESHAPE_INSTANTIATED;
    memory->pass = 0u;
    memory->at = 0u;
    instance->gather.at = 0u;
    (void)preshape_gather_reset(&instance->gather, (preshape_real)0.0);
}

FMI3_API const char *FMI3(GetVersion)(void) {
    return "3.0";
}

FMI3_API fmi3Status FMI3(SetDebugLogging)(fmi3Instance instance, fmi3Boolean logging, size_t count,
                                          const fmi3String categories[]) {
    (void)count;
    (void)categories;
    ((preshape_instance *)instance)->memory.logging = logging ? 1u : 0u;
    return fmi3OK; /* the few messages there are say why a call was refused, and are always given */
}

FMI3_API fmi3Instance FMI3(InstantiateCoSimulation)(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3Boolean event_mode, fmi3Boolean early_return, const fmi3ValueReference intermediate[], size_t intermediates,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update) {
    preshape_instance *instance;
    (void)name;
    (void)resources;
    (void)visible;
    (void)early_return;
    (void)intermediate;
    (void)update;
    instance = (preshape_instance *)calloc(1u, sizeof(preshape_instance));
    if (instance == NULL) {
        return NULL;
    }
    instance->log = log;
    instance->environment = environment;
    instance->memory.logging = logging ? 1u : 0u;
    if ((token == NULL) || (strcmp(token, PRESHAPE_TABLE_TOKEN) != 0)) {
        (void)preshape_say(instance, fmi3Error, "the instantiation token is not that of this FMU: its binary and its "
                                                "modelDescription.xml are from different exports.");
    } else if (event_mode || (intermediates > 0u)) {
        (void)preshape_say(instance, fmi3Error, "event mode and intermediate variables are not supported.");
    } else if (preshape_gather_configure(&instance->gather, &SHAPER, instance->memory.ring, PRESHAPE_ENTRIES) !=
               PRESHAPE_OK) {
        (void)preshape_say(instance, fmi3Error, "the table of this FMU is no shaper: export it again.");
    } else {
        start(instance);
        return instance;
    }
    free(instance);
    return NULL;
}

FMI3_API void FMI3(FreeInstance)(fmi3Instance instance) {
    free(instance);
}

FMI3_API fmi3Status FMI3(Reset)(fmi3Instance instance) {
    start((preshape_instance *)instance);
    return fmi3OK;
}

FMI3_API fmi3Status FMI3(EnterInitializationMode)(fmi3Instance instance, fmi3Boolean tolerance_defined,
                                                  fmi3Float64 tolerance, fmi3Float64 start_time,
                                                  fmi3Boolean stop_defined, fmi3Float64 stop_time) {
    preshape_instance *const self = (preshape_instance *)instance;
    (void)tolerance_defined;
    (void)tolerance;
    (void)stop_defined;
    (void)stop_time;
    if (self->memory.mode != PRESHAPE_INSTANTIATED) {
        return preshape_say(self, fmi3Error, "initialisation is only possible after instantiation or reset.");
    }
    self->memory.time = start_time;
    self->memory.mode = PRESHAPE_INITIALISING;
    return fmi3OK;
}

FMI3_API fmi3Status FMI3(ExitInitializationMode)(fmi3Instance instance) {
    preshape_instance *const self = (preshape_instance *)instance;
    preshape_memory *const memory = &self->memory;
    if (memory->mode != PRESHAPE_INITIALISING) {
        return preshape_say(self, fmi3Error, "this instance is not being initialised.");
    }
    (void)preshape_gather_reset(&self->gather, (preshape_real)memory->initial);
    memory->held = memory->initial;
    memory->shaped = (double)(preshape_real)memory->initial;
    memory->mode = PRESHAPE_STEPPING;
    return fmi3OK;
}

FMI3_API fmi3Status FMI3(Terminate)(fmi3Instance instance) {
    preshape_instance *const self = (preshape_instance *)instance;
    if (self->memory.mode != PRESHAPE_STEPPING) {
        return preshape_say(self, fmi3Error, "this instance is not running.");
    }
    self->memory.mode = PRESHAPE_TERMINATED;
    return fmi3OK;
}

FMI3_API fmi3Status FMI3(GetFloat64)(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                                     fmi3Float64 values[], size_t size) {
    preshape_instance *const self = (preshape_instance *)instance;
    const preshape_memory *const memory = &self->memory;
    size_t i;
    if (size != count) {
        return preshape_say(self, fmi3Error, "every variable is a scalar: as many values as references are needed.");
    }
    for (i = 0u; i < count; ++i) {
        switch (references[i]) {
        case TIME:
            values[i] = memory->time;
            break;
        case COMMAND:
            values[i] = memory->command;
            break;
        case SHAPED: /* until the start, what it will be then */
            values[i] = (memory->mode < PRESHAPE_STEPPING) ? (double)(preshape_real)memory->initial : memory->shaped;
            break;
        case INITIAL:
            values[i] = memory->initial;
            break;
        default:
            return preshape_say(self, fmi3Error, "there is no Float64 variable of this value reference.");
        }
    }
    return fmi3OK;
}

FMI3_API fmi3Status FMI3(SetFloat64)(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                                     const fmi3Float64 values[], size_t size) {
    preshape_instance *const self = (preshape_instance *)instance;
    preshape_memory *const memory = &self->memory;
    size_t i;
    if (size != count) {
        return preshape_say(self, fmi3Error, "every variable is a scalar: as many values as references are needed.");
    }
    for (i = 0u; i < count; ++i) { /* all of them, or none */
        if ((references[i] != COMMAND) && (references[i] != INITIAL)) {
            return preshape_say(self, fmi3Error, "only command and initial can be set.");
        }
        if ((references[i] == INITIAL) && (memory->mode >= PRESHAPE_STEPPING)) {
            return preshape_say(self, fmi3Error, "initial can be set before the start only.");
        }
        if ((references[i] == INITIAL) && !preshape_usable(values[i])) {
            return preshape_say(self, fmi3Discard, "initial is NaN, infinite or too large: nothing was set.");
        }
    }
    for (i = 0u; i < count; ++i) {
        if (references[i] == COMMAND) {
            memory->command = values[i]; /* what is not finite is refused by the step, or passed */
        } else {
            memory->initial = values[i];
        }
    }
    return fmi3OK;
}

FMI3_API fmi3Status FMI3(GetBoolean)(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                                     fmi3Boolean values[], size_t size) {
    preshape_instance *const self = (preshape_instance *)instance;
    size_t i;
    for (i = 0u; i < count; ++i) {
        if ((size != count) || (references[i] != PASS)) {
            return preshape_say(self, fmi3Error, "the only Boolean variable is pass_not_finite.");
        }
        values[i] = self->memory.pass != 0u;
    }
    return fmi3OK;
}

FMI3_API fmi3Status FMI3(SetBoolean)(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                                     const fmi3Boolean values[], size_t size) {
    preshape_instance *const self = (preshape_instance *)instance;
    size_t i;
    for (i = 0u; i < count; ++i) {
        if ((size != count) || (references[i] != PASS) || (self->memory.mode >= PRESHAPE_STEPPING)) {
            return preshape_say(self, fmi3Error, "the only Boolean variable is pass_not_finite, set before the start.");
        }
        self->memory.pass = values[i] ? 1u : 0u;
    }
    return fmi3OK;
}

/* How many samples a communication step is, or 0 when it is not a whole number of them. More samples than the ring
 * has entries change nothing further while the command is held. */
static uint32_t samples_of(double step, double now) {
    const double ratio = step / PRESHAPE_TABLE_DT;
    double whole;
    if (!(ratio >= 0.5) || !(ratio <= 4e15)) {
        return 0u;
    }
    whole = (double)(uint64_t)(ratio + 0.5);
    if (size_of(ratio - whole) > ON_GRID + ROUNDING * size_of(now) / PRESHAPE_TABLE_DT) {
        return 0u;
    }
    return (whole < (double)PRESHAPE_ENTRIES) ? (uint32_t)whole : PRESHAPE_ENTRIES;
}

FMI3_API fmi3Status FMI3(DoStep)(fmi3Instance instance, fmi3Float64 now, fmi3Float64 step, fmi3Boolean no_way_back,
                                 fmi3Boolean *event_needed, fmi3Boolean *terminate, fmi3Boolean *early,
                                 fmi3Float64 *reached) {
    preshape_instance *const self = (preshape_instance *)instance;
    preshape_memory *const memory = &self->memory;
    const uint32_t samples = samples_of(step, now);
    const int usable = preshape_usable(memory->command);
    char message[200];
    preshape_real shaped = (preshape_real)0.0;
    uint32_t i;
    (void)no_way_back;
    *event_needed = *terminate = *early = false;
    *reached = memory->time;
    if (memory->mode != PRESHAPE_STEPPING) {
        return preshape_say(self, fmi3Error, "this instance is not running.");
    }
    if (!(size_of(now - memory->time) <= ON_GRID * PRESHAPE_TABLE_DT + ROUNDING * size_of(now))) {
        (void)snprintf(message, sizeof message, "the step starts at %.17g s and this instance is at %.17g s.", now,
                       memory->time);
        return preshape_say(self, fmi3Error, message);
    }
    if (samples == 0u) {
        (void)snprintf(message, sizeof message,
                       "the communication step is %.17g s: it must be a whole multiple of the sample time %.17g s.", step,
                       (double)PRESHAPE_TABLE_DT);
        return preshape_say(self, fmi3Discard, message);
    }
    if (!usable && (memory->pass == 0u)) {
        (void)snprintf(message, sizeof message,
                       "command is %g: it must be finite and within +-%g, or set pass_not_finite; nothing was changed.",
                       memory->command, (double)PRESHAPE_LIMIT);
        return preshape_say(self, fmi3Discard, message);
    }
    if (usable) {
        memory->held = memory->command;
    }
    for (i = 0u; i < samples; ++i) {
        (void)preshape_gather_push(&self->gather, (preshape_real)memory->held, &shaped);
    }
    memory->shaped = usable ? (double)shaped : memory->command;
    memory->time = now + step;
    *reached = memory->time;
    return fmi3OK;
}
