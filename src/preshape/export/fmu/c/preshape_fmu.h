/* An instance of the FMU, and what its source files share.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef PRESHAPE_FMU_H
#define PRESHAPE_FMU_H

#include "preshape_fmi3.h"
#include "preshape_kernel.h"
#include "preshape_table.h"

#define PRESHAPE_ENTRIES PRESHAPE_RING(PRESHAPE_TABLE_LONGEST)

typedef enum { PRESHAPE_INSTANTIATED, PRESHAPE_INITIALISING, PRESHAPE_STEPPING, PRESHAPE_TERMINATED } preshape_mode;

/* Everything that changes: what fmi3GetFMUState copies. */
typedef struct {
    double time;    /* [s] */
    double command; /* the input */
    double shaped;  /* the output */
    double initial; /* where the machine is at rest before the start */
    double held;    /* the last command that was taken */
    uint32_t at;    /* the ring's next slot */
    uint32_t mode;
    uint32_t pass; /* 1: let commands that are not finite through */
    uint32_t logging;
    preshape_real ring[PRESHAPE_ENTRIES];
} preshape_memory;

typedef struct {
    preshape_memory memory;
    preshape_gather gather; /* on memory.ring */
    fmi3LogMessageCallback log;
    fmi3InstanceEnvironment environment;
} preshape_instance;

/* Tell the importer, and return the status. */
static inline fmi3Status preshape_say(const preshape_instance *instance, fmi3Status status,
                                      const char *message) {
    if (instance->log != NULL) {
        instance->log(instance->environment, status, (status == fmi3Discard) ? "logStatusDiscard" : "logStatusError",
                      message);
    }
    return status;
}

/* Whether a command is finite and within the kernel's limit. */
static inline int preshape_usable(double value) {
    return (value >= -(double)PRESHAPE_LIMIT) && (value <= (double)PRESHAPE_LIMIT);
}

#endif
