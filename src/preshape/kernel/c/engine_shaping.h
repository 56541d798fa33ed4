/* What an Engine does in a loop: one sample or a block of them, refused or passed where they are not finite.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef PRESHAPE_ENGINE_SHAPING_H
#define PRESHAPE_ENGINE_SHAPING_H

#include "engine_memory.h"

static double step(Engine *self, Py_ssize_t axis, double u) {
    Unit *unit = unit_of(self, axis, 0);
    for (Py_ssize_t j = 0; j < self->stages; ++j, ++unit) {
        u = self->stage[j].scattering ? scatter_step(&unit->scatter, u) : gather_step(&unit->gather, u);
    }
    return u;
}

/* One axis, samples known to be acceptable. */
static void shape_axis(Engine *self, Py_ssize_t axis, const double *u, double *y, size_t count) {
    for (size_t done = 0u; done < count; done += BLOCK) {
        const size_t run = least(count - done, BLOCK);
        Unit *unit = unit_of(self, axis, 0);
        for (Py_ssize_t j = 0; j < self->stages; ++j, ++unit) {
            const double *const from = (j == 0) ? u + done : y + done;
            if (self->stage[j].scattering) {
                for (size_t i = 0u; i < run; ++i) {
                    y[done + i] = scatter_step(&unit->scatter, from[i]);
                }
            } else {
                gather_runs(&unit->gather, from, y + done, run);
            }
        }
    }
}

/* One axis, what is not acceptable passed through while the last acceptable sample is held. */
static void pass_axis(Engine *self, Py_ssize_t axis, const double *u, double *y, size_t count) {
    for (size_t i = 0u; i < count; ++i) {
        if (acceptable(u[i])) {
            self->held[axis] = u[i];
            y[i] = step(self, axis, u[i]);
        } else {
            (void)step(self, axis, self->held[axis]);
            y[i] = u[i];
        }
    }
}

/* All axes; -1 when done, else the place of the first sample that is refused: then nothing has changed but y. */
static Py_ssize_t shape_all(Engine *self, const double *u, double *y, size_t count, double *spare) {
    if (spare != NULL) { /* one axis, one gather */
        preshape_gather *const g = &self->unit->gather;
        const size_t bytes = ((size_t)g->mask + 1u) * sizeof(double);
        const uint32_t at = g->at;
        memcpy(spare, g->ring, bytes);
        const size_t good = preshape_gather_block(g, u, y, count);
        if (good == count) {
            self->held[0] = u[count - 1u];
            return -1;
        }
        memcpy(g->ring, spare, bytes);
        g->at = at;
        if (!self->pass_bad) {
            return (Py_ssize_t)good;
        }
    }
    const size_t total = (size_t)self->axes * count;
    const size_t good = preshape_acceptable(u, total);
    if ((good < total) && !self->pass_bad) {
        return (Py_ssize_t)good;
    }
    for (Py_ssize_t axis = 0; (axis < self->axes) && (count > 0u); ++axis) {
        const size_t first = (size_t)axis * count;
        if (good < total) {
            pass_axis(self, axis, u + first, y + first, count);
        } else {
            shape_axis(self, axis, u + first, y + first, count);
            self->held[axis] = u[first + count - 1u];
        }
    }
    return -1;
}

static int refuse_busy(Engine *self) {
    if (self->busy) {
        PyErr_SetString(PyExc_RuntimeError, "this stream is shaping a block in another thread: samples of one stream "
                                            "have an order; use a lock, or a stream for each thread.");
    }
    return self->busy;
}

static PyObject *refuse(double value, Py_ssize_t axis, Py_ssize_t sample) {
    PyObject *const number = PyFloat_FromDouble(value);
    if ((number != NULL) && (sample < 0)) {
        PyErr_Format(InputError, "the sample is %R: give finite commands within +-1e250, or let such samples through "
                                 "with not_finite=\"pass\".", number);
    } else if (number != NULL) {
        PyErr_Format(InputError, "sample %zd of axis %zd is %R, and nothing of this block was taken: give finite commands "
                                 "within +-1e250, or let such samples through with not_finite=\"pass\".",
                     sample, axis, number);
    }
    Py_XDECREF(number);
    return NULL;
}

/* ---- methods ----------------------------------------------------------------------------------------------------- */

static PyObject *engine_push(Engine *self, PyObject *sample) {
    const double u = PyFloat_AsDouble(sample);
    if (((u == -1.0) && (PyErr_Occurred() != NULL)) || refuse_busy(self)) {
        return NULL;
    }
    if (self->axes != 1) {
        PyErr_SetString(PyExc_ValueError, "push is for one axis");
        return NULL;
    }
    if (acceptable(u)) {
        self->held[0] = u;
        return PyFloat_FromDouble(step(self, 0, u));
    }
    if (!self->pass_bad) {
        return refuse(u, 0, -1);
    }
    (void)step(self, 0, self->held[0]);
    return PyFloat_FromDouble(u);
}

static PyObject *engine_block(Engine *self, PyObject *args) {
    PyObject *command, *shaped;
    Py_buffer u, y;
    if (!PyArg_ParseTuple(args, "OO", &command, &shaped) || refuse_busy(self) ||
        (buffer_of(command, &u, 0, 8, "the command") < 0)) {
        return NULL;
    }
    if (buffer_of(shaped, &y, 1, 8, "the output") < 0) {
        PyBuffer_Release(&u);
        return NULL;
    }
    const size_t count = (size_t)u.len / 8u / (size_t)self->axes;
    const double *const from = u.buf;
    double *const to = y.buf, *spare = NULL;
    Py_ssize_t refused = -1;
    if ((u.len != y.len) || (count * (size_t)self->axes * 8u != (size_t)u.len)) {
        PyErr_SetString(PyExc_ValueError, "command and output must have the same number of samples for each axis");
    } else {
        if ((self->axes == 1) && (self->stages == 1) && !self->stage->scattering && (count >= LARGE) && (from != to)) {
            spare = PyMem_RawMalloc(((size_t)self->unit->gather.mask + 1u) * sizeof(double)); /* NULL: the other way */
        }
        self->busy = 1;
        Py_BEGIN_ALLOW_THREADS
        refused = shape_all(self, from, to, count, spare);
        Py_END_ALLOW_THREADS
        self->busy = 0;
        if (refused >= 0) {
            (void)refuse(from[refused], refused / (Py_ssize_t)count, refused % (Py_ssize_t)count);
        }
    }
    PyMem_RawFree(spare);
    PyBuffer_Release(&u);
    PyBuffer_Release(&y);
    if (PyErr_Occurred() != NULL) {
        return NULL;
    }
    Py_RETURN_NONE;
}

#endif
