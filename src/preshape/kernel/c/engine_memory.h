/* What an Engine is made of: its stages, the rings of each axis, and the memory they lie in.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef PRESHAPE_ENGINE_MEMORY_H
#define PRESHAPE_ENGINE_MEMORY_H

#define PY_SSIZE_T_CLEAN
#include <Python.h>

/* Variants of the hot loops for wider vectors, chosen when the module is loaded (glibc's ifunc); same bits. */
#if defined(__GNUC__) && !defined(__clang__) && (__GNUC__ >= 11) && defined(__x86_64__) && defined(__GLIBC__)
#define PRESHAPE_CLONES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#endif
#include "preshape_kernel.c"

#define LARGE ((size_t)8192) /* samples from which on checking while shaping pays, and keeping the old ring is nothing */
#define LONGEST_DELAY ((uint32_t)1 << 26)

static PyObject *InputError;

typedef struct {
    preshape_gather gather;
    preshape_scatter scatter;
} Unit;

typedef struct {
    preshape_shaper shaper;
    uint32_t *delays;
    double *weights;
    int scattering;
} Stage;

typedef struct {
    PyObject_HEAD
    Py_ssize_t axes, stages;
    int pass_bad, busy;
    Stage *stage; /* [stages] */
    Unit *unit;   /* [axes][stages] */
    double *held; /* [axes], the last acceptable sample */
} Engine;

/* ---- arrays ------------------------------------------------------------------------------------------------------ */

/* A contiguous buffer of items of this size; the Python side has made sure of the type. */
static int buffer_of(PyObject *object, Py_buffer *view, int writable, Py_ssize_t itemsize, const char *what) {
    if (PyObject_GetBuffer(object, view, PyBUF_C_CONTIGUOUS | (writable ? PyBUF_WRITABLE : 0)) < 0) {
        return -1;
    }
    if ((view->itemsize != itemsize) && (view->itemsize != 1)) {
        PyBuffer_Release(view);
        PyErr_Format(PyExc_TypeError, "%s must have items of %zd bytes", what, itemsize);
        return -1;
    }
    return 0;
}

static uint32_t ring_size(size_t needed) {
    size_t size = 1u;
    while (size < needed) {
        size *= 2u;
    }
    return (uint32_t)size;
}

/* ---- stages and their memory ------------------------------------------------------------------------------------- */

static void stage_clear(Stage *stage) {
    PyMem_RawFree(stage->delays);
    PyMem_RawFree(stage->weights);
    stage->delays = NULL;
    stage->weights = NULL;
}

/* Copy taps from (delays, weights), uint32 and float64 arrays, and check them. */
static int stage_read(Stage *stage, PyObject *delays, PyObject *weights) {
    Py_buffer d, w;
    int result = -1;
    if (buffer_of(delays, &d, 0, 4, "delays") < 0) {
        return -1;
    }
    if (buffer_of(weights, &w, 0, 8, "weights") == 0) {
        const size_t taps = (size_t)d.len / 4u;
        stage->delays = PyMem_RawMalloc((taps + 1u) * sizeof(uint32_t));
        stage->weights = PyMem_RawMalloc((taps + 1u) * sizeof(double));
        if ((stage->delays == NULL) || (stage->weights == NULL)) {
            PyErr_NoMemory();
        } else if (((size_t)w.len / 8u != taps) || (taps > MOST_TAPS)) {
            PyErr_SetString(InputError, "a shaper on the grid needs one weight for each delay.");
        } else {
            memcpy(stage->delays, d.buf, taps * 4u);
            memcpy(stage->weights, w.buf, taps * 8u);
            stage->shaper.delays = stage->delays;
            stage->shaper.weights = stage->weights;
            stage->shaper.taps = (uint32_t)taps;
            const preshape_status status = preshape_check(&stage->shaper, LONGEST_DELAY);
            if (status == PRESHAPE_OK) {
                result = 0;
            } else if (status == PRESHAPE_RING_TOO_SMALL) {
                PyErr_SetString(InputError, "the shaper is longer than 2**26 samples: sample less often.");
            } else {
                PyErr_SetString(InputError, "the taps are no shaper on the grid: delays must increase from 0, weights "
                                            "must be finite and sum to 1.");
            }
        }
        PyBuffer_Release(&w);
    }
    PyBuffer_Release(&d);
    if (result < 0) {
        stage_clear(stage);
    }
    return result;
}

static Unit *unit_of(Engine *self, Py_ssize_t axis, Py_ssize_t stage) {
    return &self->unit[axis * self->stages + stage];
}

static int gather_room(Unit *unit, const preshape_shaper *shaper) {
    const uint32_t size = ring_size(2u * (size_t)longest_of(shaper) + 64u); /* runs of a block need room */
    double *const ring = PyMem_RawMalloc((size_t)size * sizeof(double));
    if (ring == NULL) {
        PyErr_NoMemory();
        return -1;
    }
    PyMem_RawFree(unit->gather.ring);
    (void)preshape_gather_configure(&unit->gather, shaper, ring, size);
    return 0;
}

/* A ring for what is to arrive, with what is in the old one. */
static int scatter_room(Unit *unit, const preshape_shaper *shaper, size_t ahead) {
    preshape_scatter *const s = &unit->scatter;
    const size_t needed = ((size_t)longest_of(shaper) > ahead) ? longest_of(shaper) : ahead;
    const uint32_t size = ring_size(needed + 1u);
    preshape_pair *ring;
    if ((s->ring != NULL) && (s->mask >= size - 1u)) {
        return 0;
    }
    ring = PyMem_RawCalloc(size, sizeof(preshape_pair));
    if (ring == NULL) {
        PyErr_NoMemory();
        return -1;
    }
    if (s->ring == NULL) {
        (void)preshape_scatter_configure(s, shaper, ring, size);
        return 0;
    }
    for (uint32_t i = 0u; i <= s->mask; ++i) {
        ring[i] = s->ring[(s->at + i) & s->mask];
    }
    PyMem_RawFree(s->ring);
    s->ring = ring;
    s->mask = size - 1u;
    s->at = 0u;
    return 0;
}

#endif
