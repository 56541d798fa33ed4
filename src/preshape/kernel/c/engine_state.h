/* What changes an Engine between samples: at rest again, another shaper, its memory as bytes and back.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef PRESHAPE_ENGINE_STATE_H
#define PRESHAPE_ENGINE_STATE_H

#include "engine_shaping.h"

static PyObject *engine_reset(Engine *self, PyObject *values) {
    Py_buffer v;
    if (refuse_busy(self) || (buffer_of(values, &v, 0, 8, "the values") < 0)) {
        return NULL;
    }
    const double *const value = v.buf;
    const int fits = v.len == self->axes * 8;
    const size_t good = fits ? preshape_acceptable(value, (size_t)self->axes) : 0u;
    if (!fits) {
        PyErr_SetString(PyExc_ValueError, "one value for each axis is needed");
    } else if (good < (size_t)self->axes) {
        (void)refuse(value[good], 0, -1);
    } else {
        for (Py_ssize_t axis = 0; axis < self->axes; ++axis) {
            for (Py_ssize_t j = 0; j < self->stages; ++j) {
                Unit *const unit = unit_of(self, axis, j);
                if (self->stage[j].scattering && (gather_room(unit, &self->stage[j].shaper) < 0)) {
                    break;
                }
                (void)preshape_gather_reset(&unit->gather, value[axis]);
            }
            self->held[axis] = value[axis];
        }
        for (Py_ssize_t j = 0; (j < self->stages) && (PyErr_Occurred() == NULL); ++j) {
            self->stage[j].scattering = 0; /* one shaper is in force again */
        }
    }
    PyBuffer_Release(&v);
    if (PyErr_Occurred() != NULL) {
        return NULL;
    }
    Py_RETURN_NONE;
}

static Stage *stage_at(Engine *self, Py_ssize_t index) {
    if ((index < 0) || (index >= self->stages)) {
        PyErr_SetString(PyExc_IndexError, "there is no such stage");
        return NULL;
    }
    return &self->stage[index];
}

static PyObject *engine_retune(Engine *self, PyObject *args) {
    Py_ssize_t index;
    PyObject *delays, *weights;
    Stage fresh = {{NULL, NULL, 0u}, NULL, NULL, 1}, *stage;
    if (!PyArg_ParseTuple(args, "nOO", &index, &delays, &weights) || refuse_busy(self) ||
        ((stage = stage_at(self, index)) == NULL) || (stage_read(&fresh, delays, weights) < 0)) {
        return NULL;
    }
    const uint32_t ahead = longest_of(&fresh.shaper);
    for (Py_ssize_t axis = 0; axis < self->axes; ++axis) { /* all the memory first: nothing is changed without it */
        if (scatter_room(unit_of(self, axis, index), &stage->shaper, ahead) < 0) {
            stage_clear(&fresh);
            return NULL;
        }
    }
    for (Py_ssize_t axis = 0; (axis < self->axes) && !stage->scattering; ++axis) {
        Unit *const unit = unit_of(self, axis, index);
        (void)preshape_scatter_take_over(&unit->scatter, &unit->gather);
    }
    stage_clear(stage);
    *stage = fresh;
    for (Py_ssize_t axis = 0; axis < self->axes; ++axis) {
        (void)preshape_scatter_retune(&unit_of(self, axis, index)->scatter, &stage->shaper);
    }
    Py_RETURN_NONE;
}

static PyObject *engine_scattering(Engine *self, PyObject *args) {
    Py_ssize_t index;
    Stage *stage;
    if (!PyArg_ParseTuple(args, "n", &index) || ((stage = stage_at(self, index)) == NULL)) {
        return NULL;
    }
    return PyBool_FromLong(stage->scattering);
}

/* What one ring remembers, as float64: the past commands from the oldest on, or the last command, the pending pair, the
 * number of samples until all has arrived, and the pairs that arrive until then. */
static PyObject *engine_save(Engine *self, PyObject *args) {
    Py_ssize_t axis, index;
    Stage *stage;
    if (!PyArg_ParseTuple(args, "nn", &axis, &index) || refuse_busy(self) || ((stage = stage_at(self, index)) == NULL)) {
        return NULL;
    }
    if ((axis < 0) || (axis >= self->axes)) {
        PyErr_SetString(PyExc_IndexError, "there is no such axis");
        return NULL;
    }
    const preshape_gather *const g = &unit_of(self, axis, index)->gather;
    const preshape_scatter *const s = &unit_of(self, axis, index)->scatter;
    const size_t count =
        stage->scattering ? 4u + 2u * ((size_t)s->remaining + 1u) : (size_t)longest_of(&stage->shaper) + 1u;
    PyObject *const bytes = PyBytes_FromStringAndSize(NULL, (Py_ssize_t)(count * sizeof(double)));
    if (bytes == NULL) {
        return NULL;
    }
    double value[4] = {0.0, 0.0, 0.0, 0.0};
    char *to = PyBytes_AS_STRING(bytes);
    if (stage->scattering) {
        value[0] = s->command;
        value[1] = s->pending.high;
        value[2] = s->pending.low;
        value[3] = (double)s->remaining;
        memcpy(to, value, sizeof value);
        for (uint32_t i = 0u; i <= s->remaining; ++i) {
            memcpy(to + 32u + 16u * (size_t)i, &s->ring[(s->at + i) & s->mask], 16u);
        }
    } else {
        for (uint32_t i = 0u; i < count; ++i) {
            memcpy(to + 8u * (size_t)i, &g->ring[(g->at - (uint32_t)count + i) & g->mask], 8u);
        }
    }
    return bytes;
}

/* Put back what engine_save gave. */
static PyObject *engine_load(Engine *self, PyObject *args) {
    Py_ssize_t axis, index;
    int scattering;
    Py_buffer v;
    Stage *stage;
    if (!PyArg_ParseTuple(args, "nnpy*", &axis, &index, &scattering, &v)) {
        return NULL;
    }
    const size_t count = (size_t)v.len / sizeof(double);
    double *const value = PyMem_RawMalloc((count + 1u) * sizeof(double)); /* the buffer need not be aligned */
    if (value == NULL) {
        PyErr_NoMemory();
    } else if (!refuse_busy(self) && ((stage = stage_at(self, index)) != NULL)) {
        const size_t needed = (size_t)longest_of(&stage->shaper) + 1u;
        memcpy(value, v.buf, count * sizeof(double));
        int right = (axis >= 0) && (axis < self->axes) && (preshape_acceptable(value, count) == count);
        if (scattering) {
            right = right && (count >= 6u) && (value[3] >= 0.0) && (value[3] < (double)LONGEST_DELAY) &&
                    (count == 4u + 2u * ((size_t)value[3] + 1u));
        } else {
            right = right && (count == needed);
        }
        if (!right) {
            PyErr_SetString(InputError, "the state does not fit this stream: give bytes that Stream.state returned.");
        } else if (scattering && (scatter_room(unit_of(self, axis, index), &stage->shaper, (size_t)value[3]) == 0)) {
            preshape_scatter *const s = &unit_of(self, axis, index)->scatter;
            (void)preshape_scatter_reset(s, value[0]);
            s->pending.high = value[1];
            s->pending.low = value[2];
            s->remaining = (uint32_t)value[3];
            for (uint32_t i = 0u; i <= s->remaining; ++i) {
                s->ring[(s->at + i) & s->mask].high = value[4u + 2u * (size_t)i];
                s->ring[(s->at + i) & s->mask].low = value[5u + 2u * (size_t)i];
            }
            stage->scattering = 1;
            self->held[axis] = (index == 0) ? value[0] : self->held[axis];
        } else if (!scattering) {
            gather_remember(&unit_of(self, axis, index)->gather, value, count);
            stage->scattering = 0;
            self->held[axis] = (index == 0) ? value[count - 1u] : self->held[axis];
        }
    }
    PyMem_RawFree(value);
    PyBuffer_Release(&v);
    if (PyErr_Occurred() != NULL) {
        return NULL;
    }
    Py_RETURN_NONE;
}

#endif
